"""`cosimulate`: models of ours and units of others side by side, coupled at communication points."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from types import MappingProxyType

from codegen.cosimulation.asked import (
    Participant,
    asked_of,
    by_part,
    check_sources,
    inputs_of,
    turns_of,
)
from codegen.cosimulation.described import UnitDescription, check_steps
from codegen.cosimulation.instants import instants, seconds
from codegen.cosimulation.library import opened
from codegen.cosimulation.master import Master
from codegen.cosimulation.model import ModelPart, checked_initial
from codegen.cosimulation.part import Part, named
from codegen.cosimulation.record import CoSimulation
from codegen.cosimulation.results import result_of
from codegen.cosimulation.unit import UnitPart
from codegen.cosimulation.wires import Wire, open_inputs, wires_of
from codegen.inputs.signals import as_signal
from codegen.numbers.arrays import Array
from codegen.runs.arguments import settings_of, signals_for
from codegen.runs.track import Event, Settings
from codegen.simulator import Simulator
from codegen.switched.simulator import SwitchedSimulator
from codegen.tuning import TUNING


def cosimulate(
    participants: Mapping[str, Participant],
    connections: Mapping[str, str | Iterable[str]],
    end: float | str,
    every: float | str,
    *,
    start: float | str = 0.0,
    inputs: Mapping[str, object] | None = None,
    initial: Mapping[str, Mapping[str, float]] | None = None,
    order: Sequence[str] | None = None,
    linear: Iterable[str] = (),
    initially_on: Mapping[str, Iterable[Hashable]] | None = None,
    method: str = "auto",
    rtol: float = TUNING.rtol,
    atol: float = TUNING.atol,
) -> CoSimulation:
    """Run models and units of others together, exchanging signals at the instants ``start + k*every`` [s].

    ``participants``: simulators, and paths of units for co-simulation of FMI 2 and 3, by names of your own.
    ``connections``: from a signal to the input it goes to, or to several:
    ``{"plant.omega": "controller.omega"}``. ``inputs``: signals or numbers of inputs that are not connected,
    ``{"controller.ref": 30}``; of units, whose inputs have starts of their own, they may be left out.
    ``initial``: by participants states of a model, or starts of a unit's variables, parameters among them;
    of a connected input what it is taken for (else 0) until signals are exchanged for the first time.

    At each instant all signals are exchanged, then all go on, their inputs held (Jacobi). ``order``: names
    of all participants; each then goes on in turn, with what those before it have come to already
    (Gauss-Seidel). ``linear``: connected inputs that go on along the line through the last two
    values instead of being held. ``initially_on``, ``method``, ``rtol``, ``atol``: of models, as `run` has
    them. ``end`` [s] is an instant itself; times may be texts, ``"1/3"``.

    Raises `SignalError` for unusable arguments, `AlgebraicLoopError` where signals of models tell one another
    at one instant, `UnitError` for a unit that cannot take part or returns an error, `SimulationError`
    where a model cannot go on, `MissingExtraError` without the extra ``fmu`` where there are units.

    >>> import bondgraph as bg
    >>> from codegen import cosimulate, simulator
    >>> cart = bg.derive(bg.graph(
    ...     [bg.Se("push", "F"), bg.One("cart"), bg.I("m", 1, flow="v")], "push > cart > m"))
    >>> brake = bg.derive(bg.graph(
    ...     [bg.Sf("road", "v"), bg.R("pad", "c", effort="f")], "road > pad"), outputs=["pad"])
    >>> run = cosimulate(
    ...     {"cart": simulator(cart, {}), "brake": simulator(brake, {"c": -1})},
    ...     {"cart.v": "brake.v", "brake.f": "cart.F"}, end=0.2, every=0.1, initial={"cart": {"v": 1}})
    >>> run["cart.v"].round(9).tolist()
    [1.0, 0.9, 0.81]
    """
    times = instants(start, end, every)
    settings = settings_of(method, rtol, atol)
    asked = asked_of(participants)
    inlets = {name: inputs_of(one) for name, one in asked.items()}
    wires = wires_of(connections, inlets, linear)
    check_sources(wires, asked)
    given = open_inputs(inputs, inlets, wires)
    turns = turns_of(order, asked)
    begun, on = by_part(initial, asked, "initial"), by_part(initially_on, asked, "initially_on")
    parts = dict[str, Part]()
    with ExitStack() as stack:
        for name, one in asked.items():
            told = checked_initial(begun.get(name, {}), name)
            if isinstance(one, UnitDescription):
                unit = _unit(name, one, given[name], told, wires)
                check_steps(one, seconds(every, "every"), f"participant {name!r}")
                unit.connect(stack.enter_context(opened(one, name)), float(seconds(every, "every")))
                parts[name] = unit
            else:
                model = _model(name, one, given[name], told, on.get(name, ()), wires, settings)
                model.pace(seconds(start, "start"), seconds(every, "every"))
                parts[name] = model
        Master(parts, wires, turns).run(times)
    return _recorded(parts, wires, times)


def _model(
    name: str, one: Simulator | SwitchedSimulator, given: Mapping[str, object],
    initial: Mapping[str, float], on: Iterable[Hashable], wires: Iterable[Wire], settings: Settings,
) -> ModelPart:  # fmt: skip
    """A model; refuses inputs that nobody gives."""
    ready = one.simulator if isinstance(one, SwitchedSimulator) else one
    wired = [wire.target.signal for wire in wires if wire.target.part == name]
    with named(name):
        signals_for({**given, **dict.fromkeys(wired, 0.0)}, one.inputs, ready.whence)
    return ModelPart(name, one, given, initial, on, settings)


def _unit(
    name: str, about: UnitDescription, given: Mapping[str, object], initial: Mapping[str, float],
    wires: Iterable[Wire],
) -> UnitPart:  # fmt: skip
    signals = {key: as_signal(value, f"{name}.{key}") for key, value in given.items()}
    shown = [wire.source.signal for wire in wires if wire.source.part == name]
    return UnitPart(name, about, signals, initial, shown)


def _recorded(parts: Mapping[str, Part], wires: Iterable[Wire], times: Array) -> CoSimulation:
    columns, units, events = dict[str, Array](), dict[str, str](), list[Event]()
    for name, part in parts.items():
        columns |= {f"{name}.{signal}": values for signal, values in part.columns.items()}
        units |= {f"{name}.{signal}": unit for signal, unit in part.units.items()}
        events += [one._replace(port=f"{name}.{one.port}") for one in part.events]
    models = {name: part for name, part in parts.items() if isinstance(part, ModelPart)}
    return CoSimulation(
        times,
        tuple(parts),
        MappingProxyType(columns),
        MappingProxyType(units),
        tuple(sorted(events, key=lambda event: event.time)),
        MappingProxyType({str(wire.target): str(wire.source) for wire in wires}),
        MappingProxyType({name: result_of(part, times) for name, part in models.items()}),
        frozenset(str(wire.target) for wire in wires if wire.linear),
    )

"""`cosimulate`: models of ours and units of others side by side, coupled at communication points."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from os import PathLike
from types import MappingProxyType
from typing import Any

from bondgraph.errors import SignalError, nearest
from codegen.cosimulation.described import UnitDescription, check_steps, described
from codegen.cosimulation.ends import known_signal
from codegen.cosimulation.instants import instants, seconds
from codegen.cosimulation.library import opened
from codegen.cosimulation.master import Master
from codegen.cosimulation.model import ModelPart, checked_initial
from codegen.cosimulation.part import Part, named
from codegen.cosimulation.record import CoSimulation
from codegen.cosimulation.results import result_of
from codegen.cosimulation.unit import UnitPart, readable
from codegen.cosimulation.wires import Wire, open_inputs, wires_of
from codegen.inputs.signals import as_signal
from codegen.numbers.arrays import Array
from codegen.runs.arguments import settings_of, signals_for
from codegen.runs.track import Event, Settings
from codegen.simulator import Simulator
from codegen.switched.simulator import SwitchedSimulator
from codegen.tuning import TUNING

Participant = Simulator | SwitchedSimulator | str | PathLike[str]
"""A model of ours, or the path of a unit for co-simulation."""

Asked = Simulator | SwitchedSimulator | UnitDescription


def cosimulate(
    participants: Mapping[str, Participant],
    connections: Mapping[str, str | Iterable[str]],
    end: float,
    every: float,
    *,
    start: float = 0.0,
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
    them. ``end`` [s] is an instant itself.

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
    asked = _asked(participants)
    inlets = {name: _inputs_of(one) for name, one in asked.items()}
    wires = wires_of(connections, inlets, linear)
    _check_sources(wires, asked)
    given = open_inputs(inputs, inlets, wires)
    turns = _turns(order, asked)
    begun, on = _by_part(initial, asked, "initial"), _by_part(initially_on, asked, "initially_on")
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


def _asked(participants: Mapping[str, Participant]) -> dict[str, Asked]:
    """Participants by name, units as they describe themselves."""
    if not isinstance(participants, Mapping) or not participants:
        raise SignalError(
            f"participants must map names to simulators and units, not be {participants!r}"
        )
    found = dict[str, Asked]()
    for name, one in participants.items():
        if not isinstance(name, str) or not name or "." in name:
            raise SignalError(f"a participant's name is a text without a dot, not {name!r}")
        if isinstance(one, Simulator | SwitchedSimulator):
            found[name] = one
        elif isinstance(one, str | PathLike):
            found[name] = described(one)
        else:
            raise SignalError(
                f"participant {name!r} must be a simulator or the path of a unit, not {type(one).__name__}; "
                "codegen.simulator makes one of equations"
            )
    return found


def _inputs_of(one: Asked) -> tuple[str, ...]:
    return one.names("input") if isinstance(one, UnitDescription) else one.inputs


def _check_sources(wires: Iterable[Wire], asked: Mapping[str, Asked]) -> None:
    """Refuse what no unit gives, and lines into units that cannot follow them."""
    for wire in wires:
        origin, target = asked[wire.source.part], asked[wire.target.part]
        if isinstance(origin, UnitDescription):
            variable = origin.variables.get(wire.source.signal)
            if variable is not None and variable.name not in readable(origin):
                raise SignalError(
                    f"connection from {str(wire.source)!r}: the unit's variable is "
                    f"{_article(variable.causality)}, which gives nothing; connect an output"
                )
            known_signal(wire.source, readable(origin), "connection from", "output of one number")
        if wire.linear and isinstance(target, UnitDescription) and not target.interpolates:
            raise SignalError(
                f"linear {str(wire.target)!r}: the unit holds its inputs over a step; leave it out"
            )


def _article(causality: str) -> str:
    return f"{'an' if causality[0] in 'aeiou' else 'a'} {causality}"


def _turns(order: Sequence[str] | None, asked: Mapping[str, Asked]) -> tuple[str, ...] | None:
    if order is None:
        return None
    names = (order,) if isinstance(order, str) else tuple(order)
    if sorted(names) != sorted(asked):
        raise SignalError(
            f"order must name each participant once, {', '.join(asked)}, not be {', '.join(map(str, names))}"
        )
    return names


def _by_part(told: Any, asked: Mapping[str, Asked], what: str) -> Mapping[str, Any]:
    if told is None:
        return {}
    if not isinstance(told, Mapping):
        raise SignalError(f"{what} must map participants to what holds of them, not be {told!r}")
    for name in told:
        if name not in asked:
            raise SignalError(
                f"{what}: there is no participant {name!r}{nearest(str(name), asked)}; there are "
                f"{', '.join(asked)}"
            )
    return told


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

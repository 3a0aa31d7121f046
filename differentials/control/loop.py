"""Closed loops ready to run: car, differential, actuators and controller as one graph."""

from __future__ import annotations

from collections.abc import Hashable, Mapping

import bondgraph as bg
import codegen
from bondgraph.errors import nearest
from bondgraph.nodes.laws import law as law_of
from differentials.control.car import contact, single_track
from differentials.control.controllers import actuators, controller, demands, law
from differentials.control.manoeuvres import Manoeuvre, manoeuvres
from differentials.control.numbers import numbers
from differentials.laws import coulomb_clutch
from differentials.parameters import Parameter, checked
from differentials.parts import Part
from differentials.prepared import Prepared, samples
from differentials.topologies import Differential, differential, graph

PERIOD = "1/100"
"""Of the controllers [s]."""


def loop_graph(
    name: str, control: str | None = None, backlash: bool = False, error: str | None = None
) -> Part:
    """An active differential with halfshafts in a single-track car, its clutches led by actuators.

    ``control``: "yaw_rate" or "slip", a controller of that every 10 ms; without one the demands ``demand`` or
    ``demand_1``, ``demand_2`` [N m] are inputs. ``error``: what the controller goes by instead of its own.

    Raises `StructureError` for a differential without such clutches, and for another control.

    >>> import bondgraph as bg
    >>> bg.derive(loop_graph("alsd", "yaw_rate")).tasks[0].instants
    'every 1/100 s'
    """
    chosen = differential(name)
    law(name, control or "yaw_rate")
    wheels = range(1, chosen.wheels + 1)
    driveline = graph(name, halfshafts=True, backlash=backlash)
    driveline.remove_nodes_from([f"tire_{wheel}" for wheel in wheels])
    for clutch, level in chosen.clutches.items():
        driveline.nodes[clutch]["law"] = coulomb_clutch(level)
    parts = [driveline, single_track(), *map(contact, wheels), actuators(name)]
    if control is not None:
        parts.append(controller(name, control, PERIOD, error))
    return bg.assemble(*parts)


def closed_loop(
    name: str,
    manoeuvre: str | Manoeuvre,
    parameters: Mapping[str, float] | None = None,
    laws: Mapping[str, object] | None = None,
    backlash: bool = False,
) -> Prepared:
    """An active differential in a car, with its controller, ready to run, to sweep or to export.

    The rest is as of `simulate`. ``laws``: of clutches ``clutch``.. and of tires ``tire_1``.., which read the
    slip speed ``s_x1``.. [m/s] and give the force ``F_x1``.. [N].

    Raises `BondGraphError` for names and numbers that do not fit the differential.

    >>> loop = closed_loop("alsd", "step_steer")
    >>> [str(state) for state in loop.equations.further_states]
    ['tau_h', 'integral', 'asked', 'demand', 'omega_ref']
    """
    case, chosen = called(manoeuvre), differential(name)
    declared = loop_graph(name, case.control if case.closed else None, backlash)
    equations = bg.derive(declared, outputs=_shown(chosen))
    own = _checked(equations, laws or {})
    values = _values(name, case, equations, own, parameters or {})
    speed = values["v"] / values["r"]
    states = {str(state) for state in equations.states}
    initial = {f"omega_{side}{j}": speed for j in range(1, chosen.wheels + 1) for side in ("", "t")}
    initial = {state: speed for state, speed in initial.items() if state in states}
    times = samples(case.duration)
    return Prepared(equations, values, own, initial, _inputs(name, case), times)


def called(manoeuvre: str | Manoeuvre) -> Manoeuvre:
    """A manoeuvre as it is, or the one of that name; `SignalError` with the names there are."""
    if isinstance(manoeuvre, Manoeuvre):
        return manoeuvre
    if manoeuvre not in manoeuvres:
        raise bg.SignalError(
            f"no manoeuvre is called {manoeuvre!r}{nearest(manoeuvre, manoeuvres)}; there is "
            f"{', '.join(manoeuvres)}"
        )
    return manoeuvres[manoeuvre]


def _shown(chosen: Differential) -> list[str]:
    """Nodes whose signals a run records: slips, speeds and torques of the driveline, the car's angle."""
    tires = [f"tire_{wheel}" for wheel in range(1, chosen.wheels + 1)]
    return [*chosen.clutches, *chosen.observed, *tires, "beta", "dw"]


def _checked(equations: bg.StateEquations, laws: Mapping[str, object]) -> dict[Hashable, object]:
    """Laws of clutches and tires, over those declared; another node is refused."""
    known = [str(node) for node in equations.laws if str(node).startswith(("clutch", "tire"))]
    for node in laws:
        if node not in known:
            raise bg.StructureError(
                f"there is no clutch or tire {node!r}{nearest(node, known)}; there are {', '.join(known)}"
            )
    return {node: value for node, value in laws.items()}  # noqa: C416


def _values(
    name: str, case: Manoeuvre, equations: bg.StateEquations, laws: Mapping[Hashable, object],
    changed: Mapping[str, float],
) -> dict[str, float]:  # fmt: skip
    """Defaults, then the manoeuvre's, then the caller's."""
    found = parameters_of(name, case, equations, laws)
    values = {symbol: parameter.value for symbol, parameter in found.items()}
    for more in (case.parameters, case.own.get(name, {}), changed):
        values |= checked(name, more, values)
    return values


def parameters_of(
    name: str, case: Manoeuvre, equations: bg.StateEquations, laws: Mapping[Hashable, object]
) -> dict[str, Parameter]:
    """Every number that the loop reads and has a default."""
    read = set(equations.parameters)
    for node, value in {**equations.laws, **laws}.items():
        read |= law_of(value, f"law at {node!r}").free_symbols
    read |= {
        symbol
        for task in equations.tasks
        for one in task.resets
        for symbol in one.value.free_symbols
    }
    return numbers(name, case.control, sorted({symbol.name for symbol in read}))


def _inputs(name: str, case: Manoeuvre) -> dict[str, codegen.Signal]:
    def lagged(demand: float, lag: float) -> codegen.Signal:
        return codegen.Lag(codegen.Step(case.step, demand), lag)

    inputs = {
        "tau_e": lagged(case.engine_torque, case.lag),
        "delta": lagged(case.steering, case.steering_lag),
    }
    return inputs if case.closed else inputs | dict.fromkeys(demands(name), codegen.Constant(0.0))

"""Small deviations of a closed loop, from one instant of its controller to the next."""

from collections.abc import Mapping
from dataclasses import replace

import bondgraph as bg
import codegen
from bondgraph.sampling.space import SampledSpace
from differentials.control.controllers import law
from differentials.control.loop import PERIOD, called, closed_loop, loop_graph
from differentials.control.manoeuvres import Manoeuvre
from differentials.parts import part
from differentials.prepared import Prepared

CUT, BACK = "cut", "back"
"""What the controller of an open loop goes by, and what comes back of it."""

AT_BOUND, AT_REST = 1e-6, 1e-9
"""Part of the bound, and slip [rad/s], by which a loop is beside what opens it."""


def sampled_loop(
    name: str, manoeuvre: str | Manoeuvre, parameters: Mapping[str, float] | None = None
) -> SampledSpace:
    """A closed loop about where a manoeuvre ends, from one instant to the next; outputs ``omega_z``, ``dw``.

    Its poles lie inside the unit circle where the loop is stable.

    Raises `SignalError` for a manoeuvre without a controller, and where it ends at a bound or with a clutch
    that sticks, as nothing is controlled there; else what `closed_loop` raises.

    >>> poles = sampled_loop("alsd", "step_steer").poles()
    >>> len(poles), bool(abs(poles[0]) < 1)
    (13, True)
    """
    ready, at = _settled(name, manoeuvre, parameters)
    model = bg.linearize(
        ready.equations, at, ready.laws, ["delta"], outputs=["omega_z", "dw"], period=PERIOD
    )
    return model.numeric(ready.parameters)


def open_loop(
    name: str, manoeuvre: str | Manoeuvre, parameters: Mapping[str, float] | None = None
) -> SampledSpace:
    """The loop of `sampled_loop` cut at its error: what comes back to it, with the sign of a loop gain.

    Closed it is negative feedback, so that its frequency response over gain 1 and phase -180 degrees has the
    margins, as python-control's ``margin`` takes it.

    Raises what `sampled_loop` raises.

    >>> loop = open_loop("alsd", "step_steer")
    >>> loop.inputs, loop.outputs, abs(loop.frequency_response(1.0)).round(1).item()
    (('cut',), ('back',), 1.7)
    """
    case = called(manoeuvre)
    ready, at = _settled(name, case, parameters)
    cut = bg.assemble(
        loop_graph(name, case.control, error=CUT),
        part([bg.Function(BACK, f"-({law(name, case.control).error})")]),
    )
    equations = bg.derive(cut, outputs=[BACK])
    model = bg.linearize(equations, {**at, CUT: 0.0}, ready.laws, [CUT], period=PERIOD)
    space = model.numeric(ready.parameters)
    own = [space.inputs.index(CUT)]
    return replace(space, inputs=(CUT,), Q=space.Q[:, own], D=space.D[:, own])


def _settled(
    name: str, manoeuvre: str | Manoeuvre, parameters: Mapping[str, float] | None
) -> tuple[Prepared, dict[str, float]]:
    """What runs, and what slopes read where it ends: states, slips, and the numbers of the controller."""
    case = called(manoeuvre)
    if not case.closed:
        raise bg.SignalError("there is no controller in this manoeuvre; take one that is closed")
    ready = closed_loop(name, case, parameters)
    simulator = codegen.simulator(ready.equations, ready.parameters, ready.laws)
    run = simulator.run(ready.times, ready.initial, ready.inputs)
    shown = [*simulator.states, "delta", "dw"]
    shown += [one for one in run.columns if one.startswith("omega_f")]
    at = {one: float(run[one][-1]) for one in shown}
    _refuse_open(name, at, law(name, case.control).both, ready.parameters["tau_max"])
    task = ready.equations.tasks[0]
    read = {one.name for reset in task.resets for one in reset.value.free_symbols}
    return ready, at | {one: value for one, value in ready.parameters.items() if one in read}


def _refuse_open(name: str, at: Mapping[str, float], both: bool, bound: float) -> None:
    """Where the demand is at a bound, or a clutch sticks, the loop is open."""
    asked = at["asked"]
    if abs(asked) > bound * (1 - AT_BOUND) or (not both and asked < bound * AT_BOUND):
        raise bg.SignalError(
            f"{name}: the manoeuvre ends where the controller asks for {asked:g} N m, at a bound; there the "
            "loop is open"
        )
    stuck = [one for one in at if one.startswith("omega_f") and abs(at[one]) < AT_REST]
    if stuck:
        raise bg.SignalError(
            f"{name}: the manoeuvre ends where a clutch sticks, {stuck[0]} = 0; there the loop is open"
        )

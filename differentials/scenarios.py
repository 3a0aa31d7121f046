"""The paper's simulations as data, and `simulate`, which runs a differential through one."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass, field

import bondgraph as bg
import codegen
from bondgraph.named import Named
from differentials.control.loop import closed_loop
from differentials.control.manoeuvres import Manoeuvre, manoeuvres
from differentials.model import Model, model
from differentials.parameters import checked
from differentials.prepared import Prepared, samples


@dataclass(frozen=True)
class Scenario:
    """A start in steady motion, and steps of the torque demands through first-order lags.

    ``wheel_speed``: of wheel 1 [rad/s]; the other wheels start at ``wheel_speed - speed_difference``.
    ``engine_torque``, ``clutch_torques``: demands [N m], stepped at ``engine_step`` and ``clutch_step``
    [s]. ``lag``: time constant [s]. ``parameters``: what differs from the defaults.
    """

    wheel_speed: float
    speed_difference: float
    engine_torque: float
    clutch_torques: tuple[float, ...]
    engine_step: float
    clutch_step: float
    duration: float
    lag: float = 0.04
    parameters: Mapping[str, float] = field(default_factory=dict)


STIFFNESSES = (0.5, 1, 2, 5)
"""Fig. 12: halfshaft stiffness over the nominal one."""


def _figure_12(speed: float, factor: float) -> Scenario:
    return Scenario(speed, -0.5, 0.0, (1000.0,), 0.0, 0.0, 0.5, parameters={"k": 8600 * factor})


# The paper prints no torques: those of Fig. 11 are read off its axes, the others are assumed.
scenarios: Mapping[str, Scenario] = Named(
    {
        "fig11": Scenario(80.0, -2.0, 350.0, (1000.0,), 0.1, 0.5, 1.0),
        **{
            f"fig12_{speed:g}_{factor:g}": _figure_12(speed, factor)
            for speed in (20.0, 80.0)
            for factor in STIFFNESSES
        },
        "fig13": Scenario(80.0, 0.5, 150.0, (100.0, 0.0), 0.1, 0.5, 1.0),
        "fig13_superposition": Scenario(80.0, 0.5, 150.0, (1000.0, 0.0), 0.1, 0.5, 1.0),
        "fig14": Scenario(80.0, 0.5, 150.0, (250.0, 0.0), 0.1, 0.5, 1.0),
        "engine_step": Scenario(80.0, -0.5, 350.0, (), 0.1, 0.0, 1.0),
        "input_clutch": Scenario(80.0, -0.5, 50.0, (300.0,), 0.1, 0.4, 1.0),
    }
)
"""Named scenarios: the paper's figures, and two for the passive differentials, which have no figure."""


def simulate(
    name: str,
    scenario: str | Scenario | Manoeuvre,
    parameters: Mapping[str, float] | None = None,
    backend: str = "numpy",
    laws: Mapping[str, object] | None = None,
    backlash: bool = False,
) -> codegen.Result:
    """Run a differential's full model through a scenario, sampled every millisecond.

    ``parameters``: what differs from the scenario's and the defaults. ``laws``: other laws for clutches
    and tires, by node, such as ``{"tire_1": magic_formula_tire(1)}``. ``backlash``: with play in the shafts.

    A manoeuvre, such as "step_steer", is driven in a car, with the differential's controller: see
    `closed_loop`.

    The result has the equations' states, inputs and slips, the torques of the halfshafts ``tau_hs1``..,
    the speeds of input ``omega_e`` and case ``omega_c``, and the hydraulic torques. A passive variant that
    the paper does not extend by halfshafts is run as it is.

    Raises `BondGraphError` for names and numbers that don't fit the differential.

    >>> run = simulate("alsd", "fig11")
    >>> [event.kind for event in run.events]
    ['stick', 'slip']
    """
    ready = prepared(name, scenario, parameters, laws, backlash)
    simulator = codegen.simulator(ready.equations, ready.parameters, ready.laws, backend)
    return simulator.run(ready.times, ready.initial, ready.inputs)


def prepared(
    name: str,
    scenario: str | Scenario | Manoeuvre,
    parameters: Mapping[str, float] | None = None,
    laws: Mapping[str, object] | None = None,
    backlash: bool = False,
) -> Prepared:
    """What `simulate` runs, with the same arguments; to be exported, or swept."""
    case = named(scenario)
    if isinstance(case, Manoeuvre):
        return closed_loop(name, case, parameters, laws, backlash)
    full = model(name, laws, backlash)
    clutches = full.differential.clutches
    if len(case.clutch_torques) != len(clutches):
        raise bg.SignalError(
            f"{name} has {len(clutches)} clutch(es); the scenario gives "
            f"{len(case.clutch_torques)} clutch torques; {full.differential.scenario!r} suits it"
        )
    values = _parameters(full, case, parameters or {})
    times = samples(case.duration)
    states = {state.name for state in full.equations.states}
    return Prepared(
        full.equations,
        values,
        full.laws,
        _initial(full, case, values, states),
        _inputs(full, case),
        times,
    )


def named(scenario: str | Scenario | Manoeuvre) -> Scenario | Manoeuvre:
    """A scenario as it is, or the one of that name; `SignalError` with the names there are."""
    if not isinstance(scenario, str):
        return scenario
    known = named_cases()
    if scenario not in known:
        raise bg.SignalError(f"no scenario is called {scenario!r}; there is {', '.join(known)}")
    return known[scenario]


def named_cases() -> dict[str, Scenario | Manoeuvre]:
    """Everything that a differential can be run through by name: the paper's scenarios, then manoeuvres."""
    return {**scenarios, **manoeuvres}


def _speeds(full: Model, case: Scenario) -> list[float]:
    """The speed each wheel starts at."""
    others = [case.wheel_speed - case.speed_difference] * (full.differential.wheels - 1)
    return [case.wheel_speed, *others]


def _parameters(full: Model, case: Scenario, changed: Mapping[str, float]) -> dict[str, float]:
    """Defaults, then the scenario's, then the caller's; each wheel's tire is linearised at its start."""
    values = {symbol: parameter.value for symbol, parameter in full.parameters.items()}
    for wheel, (start, speed) in enumerate(zip(full.starts, _speeds(full, case), strict=True), 1):
        if not speed > 0:
            raise bg.SignalError(
                f"wheel {wheel} starts at {speed} rad/s; the tire law needs a speed > 0"
            )
        values[start] = speed
    name = full.differential.name
    for more in (case.parameters, changed):
        values |= checked(name, more, values)
    return values


def _initial(
    full: Model, case: Scenario, values: Mapping[str, float], states: Container[str]
) -> dict[str, float]:
    """Steady motion: shafts without torque, the input turning with the case."""
    speeds = dict(enumerate(_speeds(full, case), start=1))
    initial = {f"omega_{j}": w for j, w in speeds.items()}
    initial |= {f"omega_t{j}": w for j, w in speeds.items()}
    if "omega_e" in states:
        initial["omega_e"] = values["i"] * (speeds[1] + speeds[2]) / 2
    return {name: speed for name, speed in initial.items() if name in states}


def _inputs(full: Model, case: Scenario) -> dict[str, codegen.Signal]:
    def lagged(time: float, demand: float) -> codegen.Signal:
        return codegen.Lag(codegen.Step(time, demand), case.lag)

    levels = full.differential.clutches.values()
    inputs = {"tau_e": lagged(case.engine_step, case.engine_torque)}
    return inputs | {
        level: lagged(case.clutch_step, demand)
        for level, demand in zip(levels, case.clutch_torques, strict=True)
    }

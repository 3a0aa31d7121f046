"""The paper's simulations as data, and `simulate`, which runs a differential through one."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

import bondgraph as bg
import codegen
from differentials.laws import coulomb_clutch, linear_tire
from differentials.parameters import PARAMETERS
from differentials.topologies import Differential, differential, graph

SAMPLE = 1e-3
"""Sampling interval of a simulation [s]."""


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


scenarios: Mapping[str, Scenario] = MappingProxyType(
    {
        # The torques are read off the axes of Fig. 11: the paper does not print them.
        "fig11": Scenario(
            wheel_speed=80.0,
            speed_difference=-2.0,
            engine_torque=350.0,
            clutch_torques=(1000.0,),
            engine_step=0.1,
            clutch_step=0.5,
            duration=1.0,
        ),
    }
)
"""Named scenarios, by the paper's figures."""


def simulate(
    name: str,
    scenario: str | Scenario,
    parameters: Mapping[str, float] | None = None,
    backend: str = "numpy",
) -> codegen.Result:
    """Run a differential's full model through a scenario, sampled every millisecond.

    The result has the equations' states, inputs and slips, and the torques of the halfshafts
    ``tau_hs1``.., the speeds of input ``omega_e`` and case ``omega_c``, and the hydraulic torques.

    Raises `BondGraphError` for names and numbers that don't fit the differential.
    """
    chosen = differential(name)
    case = _scenario(scenario)
    if len(case.clutch_torques) != len(chosen.clutches):
        raise bg.SignalError(
            f"{name} has {len(chosen.clutches)} clutch(es); the scenario gives "
            f"{len(case.clutch_torques)} clutch torques"
        )
    model = codegen.simulator(
        _observed(chosen),
        _parameters(chosen, case, parameters or {}),
        laws=_laws(chosen),
        backend=backend,
    )
    times = np.linspace(0.0, case.duration, round(case.duration / SAMPLE) + 1)
    return model.run(times, _initial(chosen, case), _inputs(chosen, case))


def _scenario(scenario: str | Scenario) -> Scenario:
    if isinstance(scenario, Scenario):
        return scenario
    if scenario not in scenarios:
        raise bg.SignalError(f"no scenario is called {scenario!r}; there is {', '.join(scenarios)}")
    return scenarios[scenario]


def _observed(chosen: Differential) -> bg.StateEquations:
    full = graph(chosen.name, halfshafts=True)
    return bg.derive(full, outputs=[*chosen.clutches, *chosen.observed])


def _laws(chosen: Differential) -> dict[str, object]:
    laws: dict[str, object] = {
        node: coulomb_clutch(level) for node, level in chosen.clutches.items()
    }
    return laws | {f"tire_{j}": linear_tire(j) for j in range(1, chosen.wheels + 1)}


def _speeds(chosen: Differential, case: Scenario) -> list[float]:
    """The speed each wheel starts at."""
    others = [case.wheel_speed - case.speed_difference] * (chosen.wheels - 1)
    return [case.wheel_speed, *others]


def _parameters(
    chosen: Differential, case: Scenario, changed: Mapping[str, float]
) -> dict[str, float]:
    """Defaults, then the scenario's, then the caller's; each wheel's tire is linearised at its start."""
    values = {name: parameter.value for name, parameter in PARAMETERS.items()}
    for wheel, speed in enumerate(_speeds(chosen, case), start=1):
        if not speed > 0:
            raise bg.SignalError(
                f"wheel {wheel} starts at {speed} rad/s; the tire law needs a speed > 0"
            )
        values[f"omega_t{wheel}_0"] = speed
    for name, value in {**case.parameters, **changed}.items():
        if name not in values:
            raise bg.ParameterError(
                f"{chosen.name} has no parameter {name!r}; there are {', '.join(values)}"
            )
        values[name] = value
    return values


def _initial(chosen: Differential, case: Scenario) -> dict[str, float]:
    speeds = dict(enumerate(_speeds(chosen, case), start=1))
    return {f"omega_{j}": w for j, w in speeds.items()} | {
        f"omega_t{j}": w for j, w in speeds.items()
    }


def _inputs(chosen: Differential, case: Scenario) -> dict[str, codegen.Signal]:
    def lagged(time: float, demand: float) -> codegen.Signal:
        return codegen.Lag(codegen.Step(time, demand), case.lag)

    levels = chosen.clutches.values()
    inputs = {"tau_e": lagged(case.engine_step, case.engine_torque)}
    return inputs | {
        level: lagged(case.clutch_step, demand)
        for level, demand in zip(levels, case.clutch_torques, strict=True)
    }

"""How far runs of the paper's figures are from the exact integrations that the tests check by."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from references import paper_runs  # noqa: E402
from references.fig11 import fig11  # noqa: E402

import differentials  # noqa: E402

FIGURES = {
    "fig11": "alsd",
    "fig12_20_1": "alsd",
    "fig12_80_1": "alsd",
    "fig13": "stationary_tvd",
    "fig13_superposition": "superposition_tvd",
    "fig14": "four_wheel_drive_tvd",
}
"""Scenario to the differential it is for."""

ASSUMED = dict.fromkeys(("I_1", "I_2", "I_3", "I_4"), 0.008)
ASSUMED |= {"I_c1": 0.026, "I_c2": 0.026, "I_s1": 0.0094, "I_s2": 0.0094}


@dataclass(frozen=True)
class Outcome:
    """The states of a run, each a column by its name, and when events were; None where none are located."""

    states: Mapping[str, NDArray[np.float64]]
    events: tuple[float, ...] | None


def reference(figure: str) -> Outcome:
    """The exact run of a figure."""
    if figure == "fig11":
        found = fig11()
        events = tuple(time for time, _ in found.events)
    else:
        case = differentials.scenarios[figure]
        exact = paper_runs.run(
            FIGURES[figure], {**ASSUMED, **case.parameters}, case.wheel_speed, case.speed_difference,
            case.engine_torque, case.clutch_torques, case.engine_step, case.clutch_step,
            case.duration, case.lag,
        )  # fmt: skip
        found, events = exact, tuple(time for time, *_ in exact.events)
    wheels = range(1, found.states.shape[1] // 3 + 1)
    names = [f"{state}{j}" for state in ("omega_", "tau_k", "omega_t") for j in wheels]
    return Outcome(dict(zip(names, found.states.T, strict=True)), events)


def errors(found: Outcome, expected: Outcome) -> tuple[float, float | None]:
    """The largest error of a state over its range, and the largest of an event [s]; None without events."""
    worst = max(
        float(np.abs(found.states[name] - column).max() / np.ptp(column))
        for name, column in expected.states.items()
    )
    if found.events is None or expected.events is None:
        return worst, None
    late = [abs(a - b) for a, b in zip(found.events, expected.events, strict=True)]
    return worst, max(late, default=None)

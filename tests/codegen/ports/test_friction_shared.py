"""Clutches side by side lock one relative speed: the load is shared by level, and they let go together."""

from functools import cache

import numpy as np
import pytest
from oracles.models import clutches

import bondgraph as bg
from codegen import Ramp, Result, Sampled, Sine, Step, simulator

TIMES = np.linspace(0, 4, 161)
SHAFTS = {"I_1": 0.5, "I_2": 0.25}


def _laws(breakaways) -> list[bg.DryFriction]:
    return [bg.DryFriction(f"L_{i}", 1, ratio) for i, ratio in enumerate(breakaways)]


def _run(levels, breakaways, torque, start=None, times=TIMES) -> Result:
    """T on shaft 1, and on shaft 2 what keeps the sum of momenta at rest: the clutches carry all of T."""
    run = simulator(_equations(breakaways), SHAFTS | _levels(levels))
    return run.run(times, start, {"T_1": torque, "T_2": _negative(torque)})


@cache
def _equations(breakaways) -> bg.StateEquations:
    return bg.derive(clutches(*_laws(breakaways)))


@cache
def _rising(levels, breakaways, slope: float) -> Result:
    """A run under a torque that rises from zero, of which several tests look at one side each."""
    return _run(levels, breakaways, Ramp(0.0, slope))


def _levels(levels) -> dict[str, float]:
    return {f"L_{i}": level for i, level in enumerate(levels)}


def _negative(signal):
    if isinstance(signal, Ramp):
        return Ramp(signal.time, -signal.slope, -signal.initial)
    if isinstance(signal, Sine):
        return Sine(-signal.amplitude, signal.frequency, signal.phase)
    return -signal


CASES = [
    ((10.0, 10.0), (1, 1)), ((10.0, 25.0), (1, 1)), ((10.0, 25.0), (1.5, 1.2)), ((8.0, 0.0), (1, 1)),
    ((0.0, 8.0), (1.3, 1.3)),
]  # fmt: skip
THREE = ((4.0, 0.0, 6.0), (1.5, 1, 1.1))


@pytest.mark.parametrize(("levels", "breakaways"), CASES)
@pytest.mark.parametrize("slope", [12.0, -12.0])
def test_shares_are_proportional_to_what_each_can_hold(levels, breakaways, slope: float) -> None:
    caps = np.array(levels) * np.array(breakaways)
    result = _rising(levels, breakaways, slope)
    locked = np.abs(slope) * result.time < caps.sum() - 1e-9
    assert locked.sum() > 20
    for i, cap in enumerate(caps):
        expected = slope * result.time[locked] * cap / caps.sum()
        assert result[f"f_{i}"][locked] == pytest.approx(expected, abs=1e-8)
    assert np.abs(result["slip"][locked]).max() < 1e-12


@pytest.mark.parametrize(("levels", "breakaways"), [*CASES, THREE])
def test_they_let_go_together_when_all_have_reached_their_breakaway(levels, breakaways) -> None:
    """Then w_1 - w_2 gathers from T - sum L, on the inertias 1/I_1 + 1/I_2."""
    release = (np.array(levels) * np.array(breakaways)).sum() / 12.0
    result = _rising(levels, breakaways, 12.0)
    assert {event.kind for event in result.events} == {"slip"}
    assert [event.time for event in result.events] == pytest.approx(
        [release] * len(result.events), abs=1e-9
    )
    half = int(release / 2 / TIMES[1])
    assert [result[f"f_{i}"][half] for i in range(len(levels))] == pytest.approx(
        [
            12.0 * TIMES[half] * level * ratio / (12.0 * release)
            for level, ratio in zip(levels, breakaways, strict=True)
        ],
        abs=1e-8,
    )
    carrying = {f"c{i}" for i, level in enumerate(levels) if level > 0}
    assert carrying <= {event.port for event in result.events}
    after = np.maximum(result.time - release, 0.0)
    excess = 12.0 * release - sum(levels)
    expected = (6.0 * after**2 + excess * after) * (1 / 0.5 + 1 / 0.25)
    assert result["slip"] == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize(("levels", "breakaways"), CASES)
def test_they_lock_together_and_stay_locked(levels, breakaways) -> None:
    """From a slip of 30 with no torque: |slip|' = -sum L (1/I_1 + 1/I_2)."""
    result = _run(levels, breakaways, 0.0, {"w_1": 30.0})
    locks = 30.0 / (sum(levels) * 6.0)
    assert {event.kind for event in result.events} == {"stick"}
    assert len(result.events) == len(levels)
    assert [e.time for e in result.events] == pytest.approx([locks] * len(levels), rel=1e-9)
    expected = 30.0 * np.maximum(1 - result.time / locks, 0.0)
    assert result["slip"] == pytest.approx(expected, abs=1e-9)
    # Momentum is kept: both run at I_1 w_1/(I_1 + I_2).
    assert result["w_2"][-1] == pytest.approx(30.0 * 0.5 / 0.75, rel=1e-9)
    assert np.abs([result[f"f_{i}"][-1] for i in range(len(levels))]).max() < 1e-9


def test_shares_follow_a_level_that_changes_under_load() -> None:
    """Load 6; clutch 1's level falls from 20 to nothing: it gives up its share to clutch 0 in time."""
    run = simulator(_equations((1, 1)), SHAFTS | {"L_0": 10.0})
    level = Sampled([0.0, 1.0, 3.0], [20.0, 20.0, 0.0])
    result = run.run(TIMES, inputs={"T_1": 6.0, "T_2": -6.0, "L_1": level})
    assert result.events == ()
    share = result["L_1"] / (10.0 + result["L_1"])
    assert result["f_1"] == pytest.approx(6.0 * share, abs=1e-9)
    assert result["f_0"] == pytest.approx(6.0 * (1 - share), abs=1e-9)


def test_they_let_go_when_the_sum_of_falling_levels_meets_the_load() -> None:
    run = simulator(_equations((1, 1)), SHAFTS)
    fall = Ramp(0.5, -4.0, 10.0, end=2.9)
    result = run.run(TIMES, inputs={"T_1": 12.0, "T_2": -12.0, "L_0": fall, "L_1": fall})
    # 2 (10 - 4 (t - 1/2)) = 12 at t = 1.5; then slip'' = 8 (1/I_1 + 1/I_2) for as long as they fall.
    assert {(e.port, e.kind) for e in result.events} == {("c0", "slip"), ("c1", "slip")}
    assert [e.time for e in result.events] == pytest.approx([1.5, 1.5], abs=1e-8)
    t = result.time
    expected = np.where(
        t < 2.9, 24.0 * np.maximum(t - 1.5, 0.0) ** 2, 24.0 * 1.96 + 67.2 * (t - 2.9)
    )
    assert result["slip"] == pytest.approx(expected, abs=1e-6)


def test_an_alternating_load_within_the_sum_of_levels_moves_nothing() -> None:
    result = _run((5.0, 3.0), (1, 1), Sine(7.99, 1.5))
    assert result.events == ()
    assert np.abs(result["slip"]).max() < 1e-12
    assert result["f_0"] == pytest.approx(result["T_1"] * 5 / 8, abs=1e-9)


def test_one_of_two_clutches_that_is_opened_by_a_step_leaves_the_load_to_the_other() -> None:
    run = simulator(_equations((1, 1)), SHAFTS | {"L_0": 10.0})
    for torque, slips in ((6.0, False), (11.0, True)):
        opened = Step(2.0, 0.0, 20.0)
        result = run.run(TIMES, inputs={"T_1": torque, "T_2": -torque, "L_1": opened})
        expected = 6.0 * (torque - 10.0) * np.maximum(TIMES - 2.0, 0.0) if slips else 0 * TIMES
        assert result["slip"] == pytest.approx(expected, abs=1e-9)
        assert {event.time for event in result.events} == ({2.0} if slips else set())

"""The judge of bodies with stops: motions known in closed form, and what impacts must keep."""

import numpy as np
import pytest
from references.stops.impact import JammedError, complementary, strikes
from references.stops.line import Bound, Line, Wave
from references.stops.motion import Machine

WEIGHT = Wave(-10.0)


def _floor(bounce: float, at: float = 0.0) -> tuple[Bound, ...]:
    return (Bound("floor", (0, None), at, 1, bounce),)


def _cradle(speeds: tuple[float, ...], bounce: float = 1.0) -> Line:
    n = len(speeds)
    stops = tuple(Bound(f"s{i}", (i + 1, i), 1.0, 1, bounce) for i in range(n - 1))
    return Line((1.0,) * n, tuple(map(float, range(n))), speeds, stops)


def test_a_ball_bounces_in_geometric_steps_and_rests() -> None:
    """From h: impacts at t_0 (1 + 2 e + 2 e^2 + ...), t_0 = sqrt(2 h / g); rest at t_0 (1 + e) / (1 - e)."""
    course = Machine(Line((2.0,), (5.0,), (0.0,), _floor(0.8), (Wave(-20.0),))).run(
        np.array([0.0, 9.5])
    )
    hits = [one for one in course.events if one[2] == "hit"]
    steps = 0.8 ** np.arange(len(hits))
    times = 1 + 2 * np.concatenate([[0], np.cumsum(steps[1:])])
    assert [one[0] for one in hits] == pytest.approx(times.tolist(), abs=1e-12)
    assert [one[3] for one in hits] == pytest.approx((2 * 10 * 1.8 * steps).tolist(), abs=1e-11)
    assert course.events[-1][:3] == (pytest.approx(9.0, abs=1e-5), "floor", "touch")
    assert course.states[-1] == pytest.approx([0, 0], abs=1e-15)


@pytest.mark.parametrize(
    ("speeds", "after"),
    [
        ((1.0, 0.0, 0.0), (0, 0, 1)), ((1.0, 0.0, 0.0, 0.0, 0.0), (0, 0, 0, 0, 1)),
        ((1.0, 1.0, 0.0, 0.0, 0.0), (0, 0, 0, 1, 1)), ((1.0, 0.0, -1.0), (-1, 0, 1)),
    ],
)  # fmt: skip
def test_balls_in_a_row_that_touch(speeds: tuple[float, ...], after: tuple[int, ...]) -> None:
    course = Machine(_cradle(speeds)).run(np.array([0.0, 0.5]))
    assert course.states[-1][len(speeds) :] == pytest.approx(after, abs=1e-13)


def test_a_mass_is_pulled_off_a_stop_when_the_force_turns() -> None:
    """Held by 3 sin(t + 3): let go at pi - 3, then x = 3 sin(t + 3) integrated twice."""
    line = Line((1.0,), (0.0,), (0.0,), _floor(0.0), (Wave(0.0, -3.0, 1.0, 3.0),))
    course = Machine(line).run(np.array([0.0, 0.1, 2.0]))
    go = np.pi - 3.0
    (event,) = course.events
    assert event == (pytest.approx(go, abs=1e-12), "floor", "apart", 0.0)
    assert course.forces[1][0] == pytest.approx(3 * np.sin(3.1), abs=1e-13)
    assert course.states[-1][1] == pytest.approx(3 * (1 - np.cos(2.0 - go)), abs=1e-12)


def test_no_root_is_missed_where_a_gap_dips_by_little() -> None:
    """x = 1 + d - cos(40 t)... of a spring: it dips below the bound by 1e-9 once a period."""
    line = Line(
        (1.0,), (2.0,), (0.0,), _floor(0.0, at=-2.0 + 1e-9), springs={(0, None): (1600.0, 2.0)}
    )
    course = Machine(line).run(np.array([0.0, 0.1]))
    (event, *_) = course.events
    assert event[0] == pytest.approx((np.pi - np.arccos(1 - 5e-10)) / 40, abs=1e-9)


@pytest.mark.parametrize("seed", range(200))
def test_impacts_lose_energy_and_end_with_nothing_closing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, k = int(rng.integers(2, 6)), int(rng.integers(1, 6))
    W, M = rng.normal(size=(k, n)), np.diag(rng.uniform(0.2, 3, n))
    v, bounce = rng.normal(size=n), np.round(rng.uniform(0, 1, k), 1)
    D = W @ np.linalg.inv(M) @ W.T
    if np.linalg.cond(D) > 1e6:
        return
    for strike in strikes(D, W @ v, bounce, range(k), 1e-12):
        assert (strike.impulse >= 0).all()
        later = v + np.linalg.solve(M, W.T @ strike.impulse)
        assert later @ M @ later <= v @ M @ v + 1e-11
        v = later
    assert (W @ v >= -1e-11).all()


def test_a_set_that_cannot_be_is_told() -> None:
    with pytest.raises(JammedError):
        complementary(np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([-1.0, -1.0]), 1e-12)

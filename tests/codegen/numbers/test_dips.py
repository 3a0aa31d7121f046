"""Dips between points: found where there are some, given up soon where there are none."""

import math
from collections.abc import Callable

import pytest

from codegen.numbers.dips import dip, may_dip

TIMES = (-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0)
"""Points at equal distances, as of a step; the shapes are those of the distance to a place between two."""

SHAPES: dict[str, Callable[[float], float]] = {
    "parabola": lambda s: s**2,
    "quartic": lambda s: s**4,
    "cosine": lambda s: 1 - math.cos(0.6 * s),
    "bell": lambda s: 1 - math.exp(-(s**2)),
    "skew": lambda s: math.exp(s) - 1 - s,
    "corner": abs,
    "skew corner": lambda s: max(s, -20 * s),
    "bent corner": lambda s: abs(s - 0.08 * s**2),
    "trough": lambda s: max(abs(s) - 0.2, 0),
}
"""All are zero at 0 and above beside it."""


def _found(
    shape: str, place: float, least: float, points: tuple[float, ...] = TIMES
) -> tuple[float | None, int]:
    """What is found of a shape whose least value is at a place, and after how many looks."""
    looks = []

    def above(t: float) -> float:
        looks.append(t)
        return SHAPES[shape](t - place) + least

    values = [SHAPES[shape](t - place) + least for t in points]
    k = max(k for k, t in enumerate(points) if t < place)
    found = dip(above, points, values, k) if may_dip(values) else None
    assert all(points[k] < t < points[k + 1] for t in looks)
    return found, len(looks)


@pytest.mark.parametrize("least", [-1e-2, -1e-5, -1e-7, -1e-9])
@pytest.mark.parametrize("place", [-2.3, -1.7, 0.45, 0.9, 2.5])
@pytest.mark.parametrize("shape", [name for name in SHAPES if name != "bell"])
def test_a_dip_is_found_however_shallow(shape: str, place: float, least: float) -> None:
    found, looks = _found(shape, place, least)
    assert found is not None
    assert SHAPES[shape](found - place) + least <= 0
    assert looks <= 30


@pytest.mark.parametrize("least", [-1e-2, -1e-5])
@pytest.mark.parametrize("place", [-2.6, 3.4])
@pytest.mark.parametrize("shape", ["parabola", "skew", "corner", "skew corner", "trough"])
def test_a_dip_beside_the_first_or_the_last_point_is_found(
    shape: str, place: float, least: float
) -> None:
    """There is a chord on one side only."""
    found, looks = _found(shape, place, least)
    assert found is not None
    assert SHAPES[shape](found - place) + least <= 0
    assert looks <= 30


@pytest.mark.parametrize("least", [1e-9, 1e-6, 1e-3, 0.03, 0.3])
@pytest.mark.parametrize("place", [-2.9, -0.3, 0.05, 0.4, 3.7])
@pytest.mark.parametrize("shape", SHAPES)
def test_what_stays_above_is_no_dip(shape: str, place: float, least: float) -> None:
    found, looks = _found(shape, place, least)
    assert found is None
    corners = 2 if shape == "trough" else 1
    assert looks <= corners * (15 if least >= 1e-3 else 30)


BEND = -1.6 * 0.14**2
"""What a corner's two sides bend downwards, in points of 0.14: as sin t does where it is 0.8."""


@pytest.mark.parametrize("place", [-1.8, -0.5, 0.3, 1.55])
def test_sides_that_bend_downwards_go_on_to(place: float) -> None:
    """The chords' straight lines would meet above zero."""

    def above(t: float) -> float:
        return 0.14 * abs(t - place) + BEND * (t - place) ** 2 / 2 - 2e-3

    values = [above(t) for t in TIMES]
    k = max(k for k, t in enumerate(TIMES) if t < place)
    assert min(values) > 0
    before, after = values[k] - values[k - 1], values[k + 2] - values[k + 1]
    meet = (values[k + 1] - values[k] - after) / (before - after)
    assert values[k] + before * meet > 0
    found = dip(above, TIMES, values, k)
    assert found is not None
    assert above(found) <= 0


@pytest.mark.parametrize(
    "values", [[4.0, 3.0, 2.0, 1.0], [1.0, 2.0, 2.0, 1.0], [2.0, 1.0, 1.0, 2.0], [9.0, 4.0, 1.0, 0.1]]
)  # fmt: skip
def test_points_that_leave_no_dip_are_not_looked_between(values: list[float]) -> None:
    """Straight, bent downwards, or no steeper than they are high."""
    for k in range(2):
        assert dip(lambda t: pytest.fail(f"looked at {t}"), TIMES[:4], values, k) is None


@pytest.mark.parametrize("values", [[math.inf] * 4, [5.0, 4.9, 4.8, 4.7], [1.0, 1.0, 1.3, 1.0]])
def test_points_far_above_zero_need_no_chords(values: list[float]) -> None:
    assert not may_dip(values)
    assert all(dip(lambda t: -1.0, TIMES[:4], values, k) is None for k in range(3))


def test_points_that_fall_together_tell_of_no_dip() -> None:
    """A stretch of one rounding of the time, whose points are its begin or its end."""
    one = math.nextafter(1.0, 2.0)
    assert dip(lambda t: 1e-3, (1.0, 1.0, one, one), (1e-3, 1e-3, 1e-3, 1e-3), 1) is None

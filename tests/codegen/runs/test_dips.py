"""Dips between points: found where there are some, given up soon where there are none."""

import math
from collections.abc import Callable

import pytest

from codegen.runs.dips import dip

TIMES = (-1.0, 0.0, 1.0)

SHAPES: dict[str, Callable[[float], float]] = {
    "parabola": lambda s: s**2,
    "quartic": lambda s: s**4,
    "cosine": lambda s: 1 - math.cos(1.5 * s),
    "bell": lambda s: 1 - math.exp(-3 * s**2),
    "skew": lambda s: math.exp(2 * s) - 1 - 2 * s,
}
"""All are zero at 0 and above beside it."""


def _found(shape: str, place: float, least: float) -> tuple[float | None, int]:
    """What is found of a shape whose least value is at a place, and after how many looks."""
    looks = []

    def above(t: float) -> float:
        looks.append(t)
        return SHAPES[shape](t - place) + least

    found = dip(above, TIMES, [SHAPES[shape](t - place) + least for t in TIMES])
    assert all(TIMES[0] < t < TIMES[2] for t in looks)
    return found, len(looks)


@pytest.mark.parametrize("least", [-1e-5, -1e-7, -1e-9])
@pytest.mark.parametrize("place", [-0.3, 0.1])
@pytest.mark.parametrize("shape", ["parabola", "quartic", "skew"])
def test_a_dip_is_found_however_shallow(shape: str, place: float, least: float) -> None:
    found, looks = _found(shape, place, least)
    assert found is not None
    assert SHAPES[shape](found - place) + least <= 0
    assert looks <= 25


@pytest.mark.parametrize("least", [1e-9, 1e-6, 1e-3, 0.03, 0.3])
@pytest.mark.parametrize("place", [-0.9, -0.3, 0.05, 0.4])
@pytest.mark.parametrize("shape", SHAPES)
def test_what_stays_above_is_no_dip(shape: str, place: float, least: float) -> None:
    found, looks = _found(shape, place, least)
    assert found is None
    assert looks <= (8 if least >= 1e-3 else 30)


def test_points_that_are_no_dip_are_not_looked_between() -> None:
    for values in ([3.0, 2.0, 1.0], [1.0, 2.0, 1.0], [1.0, 0.9, 1.0], [1.0, 0.0, 1.0]):
        assert dip(lambda t: pytest.fail(f"looked at {t}"), TIMES, values) is None

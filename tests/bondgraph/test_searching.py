"""Searches against scipy's brentq."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from bondgraph.searching import MOST, place_where

LAWS: dict[str, tuple[Callable, tuple[float, float]]] = {
    "cubic": (lambda x: (x + x**3, 1 + 3 * x**2), (-1e5, 1e5)),
    "falling": (lambda x: (-1e-9 * x - math.sinh(x), -1e-9 - math.cosh(x)), (-400.0, 400.0)),
    "small": (lambda x: (1e9 * x + 1e30 * x**3, 1e9 + 3e30 * x**2), (-1e-3, 1e-3)),
    "hardly": (lambda x: (1e-12 * x + x**7, 1e-12 + 7 * x**6), (-50.0, 50.0)),
    "logarithm": (lambda x: (x + math.log(1 + x), 1 + 1 / (1 + x), 1 + x), (-1 + 1e-15, 1e6)),
    "pole": (lambda x: (x + 1 / (1 - x), 1 + (1 - x) ** -2, 1 - x), (-1e6, 1 - 1e-12)),
    "begins far off": (lambda x: (math.log(x - 5.5), 1 / (x - 5.5), x - 5.5), (5.5 + 1e-12, 1e9)),
    "exponential": (lambda x: (1e-9 * x + math.exp(x), 1e-9 + math.exp(x)), (-1e12, 700.0)),
    "root": (lambda x: (1e-9 * x + math.asinh(x), 1e-9 + 1 / math.hypot(1, x)), (-1e14, 1e14)),
    "steep": (lambda x: (x + 1e8 * math.tanh(1e6 * x), 1 + 1e14 / math.cosh(min(1e6 * abs(x), 300)) ** 2),
              (-1e9, 1e9)),
}  # fmt: skip


@pytest.mark.parametrize("name", LAWS)
def test_the_place_is_brentqs(name: str) -> None:
    """To what rounding of the law leaves, at values all over its range."""
    law, (low, high) = LAWS[name]
    generator = np.random.default_rng(5)
    inside = np.concatenate(
        [generator.uniform(low, high, 100), [0.0 if low < 0 < high else high / 3]]
    )
    for place in inside.tolist():
        value = law(place)[0]
        found = place_where(law, value)
        right = brentq(lambda x, v=value: law(x)[0] - v, low, high, xtol=1e-300, rtol=1e-15)
        slope = abs(law(right)[1])
        assert abs(found - right) <= 1e-14 * abs(right) + 4e-16 * abs(value) / slope + 1e-300


@pytest.mark.parametrize("value", [2.0, -2.0, math.inf, math.nan])
def test_a_value_that_the_law_has_nowhere_is_no_number(value: float) -> None:
    assert math.isnan(
        place_where(lambda x: (math.tanh(x), 1 / math.cosh(min(x, 300.0)) ** 2), value)
    )


@pytest.mark.parametrize("name", LAWS)
def test_it_ends_long_before_its_last_step(name: str) -> None:
    """At values of all sizes, as powers of ten of either sign."""
    law, _ = LAWS[name]
    calls = []

    def counting(x: float) -> tuple[float, ...]:
        calls.append(x)
        return law(x)

    for size in range(-300, 301, 12):
        for value in (10.0**size, -(10.0**size)):
            calls.clear()
            place_where(counting, value)
            assert len(calls) < 0.75 * MOST


def test_steps_are_few() -> None:
    """Some thirty calls at the most for a cubic, whatever the size."""
    calls = []

    def law(x: float) -> tuple[float, float]:
        calls.append(x)
        return x + x**3, 1 + 3 * x**2

    for value in np.logspace(-12, 12, 49).tolist():
        calls.clear()
        place_where(law, value)
        assert len(calls) < 40

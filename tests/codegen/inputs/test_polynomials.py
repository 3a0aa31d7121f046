"""First falls of polynomials against roots known by construction."""

import numpy as np
import pytest
from numpy.polynomial import polynomial as npp

from codegen.inputs.polynomials import first_fall, to_bernstein, value
from codegen.numbers.arrays import Array


def _with_roots(rng: np.random.Generator) -> tuple[Array, list[float]]:
    """A polynomial that is positive at 0, with known real roots, in and out of [0, 1], and complex pairs."""
    inside = sorted(rng.uniform(0.01, 0.99, rng.integers(0, 4)).tolist())
    outside = rng.uniform(1.1, 3.0, rng.integers(0, 3)).tolist()
    powers = np.array([1.0])
    for root in (*inside, *outside):
        powers = npp.polymul(powers, [1.0, -1.0 / root])
    for _ in range(rng.integers(0, 3)):
        a, b = rng.uniform(-0.5, 1.5), rng.uniform(0.05, 1.0)
        powers = npp.polymul(powers, [1.0, -2 * a / (a * a + b * b), 1 / (a * a + b * b)])
    return powers, inside


@pytest.mark.parametrize("seed", range(200))
def test_the_first_root_is_found(seed: int) -> None:
    powers, inside = _with_roots(np.random.default_rng(seed))
    found = first_fall(powers)
    if not inside:
        assert found is None
    else:
        assert found is not None
        slope = abs(npp.polyval(inside[0], npp.polyder(powers)))
        size = np.abs(powers).sum()
        assert abs(found - inside[0]) <= 1e-12 * size / slope + 1e-15


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_two_roots_close_together_are_not_missed(gap: float) -> None:
    powers = npp.polymul([1.0, -1 / 0.3], [1.0, -1 / (0.3 + gap)])
    found = first_fall(powers)
    assert found is not None
    assert abs(found - 0.3) <= 1e-9


def test_a_dip_that_stays_above_is_none() -> None:
    assert first_fall(np.array([0.09 + 1e-9, -0.6, 1.0])) is None


def test_a_start_at_zero_that_rises_does_not_count() -> None:
    assert first_fall(np.array([0.0, 1.0])) is None
    found = first_fall(np.array([0.0, 1.0, -2.0]))
    assert found == pytest.approx(0.5, abs=1e-12)


def test_a_start_at_zero_that_falls_ends_there() -> None:
    assert first_fall(np.array([0.0, -1.0])) == 0.0


def test_only_what_lies_behind_the_beginning_counts() -> None:
    powers = npp.polymul(npp.polymul([1.0, -5.0], [1.0, -2.0]), [1.0, -1 / 0.8])
    assert first_fall(powers) == pytest.approx(0.2, abs=1e-13)
    assert first_fall(powers, 0.6) == pytest.approx(0.8, abs=1e-13)


def test_bernstein_coefficients_bound_the_polynomial() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        powers = rng.normal(size=9)
        shape = to_bernstein(8) @ powers
        seen = [value(powers, tau) for tau in np.linspace(0, 1, 101)]
        assert shape.min() <= min(seen) + 1e-12
        assert shape.max() >= max(seen) - 1e-12

"""Where polynomials first fall to zero, in C, beside their values on a fine grid."""

import ctypes
from collections.abc import Callable

import numpy as np
import pytest

from codegen.engine.build import compiled
from codegen.engine.sizes import Sizes, sources
from codegen.tuning import TUNING

GRID = np.linspace(0.0, 1.0, 40_001)
NEAR = 1e-7
"""Least values nearer to zero than this are not told on the grid."""


class Powers(ctypes.Structure):
    """``ex_powers``."""

    _fields_ = [("degree", ctypes.c_int), ("at", ctypes.c_double * (TUNING.powers + 1))]


@pytest.fixture(scope="module")
def first_fall() -> Callable[[np.ndarray], float | None]:
    """The first fall of a polynomial in (0, 1], lowest power first; None without one."""
    wanted = Sizes(N=3, X=2, U=1, W=1, K=1, G=1)
    library = ctypes.CDLL(str(compiled({**sources(), "config.h": wanted.config})))

    def found(coefficients: np.ndarray) -> float | None:
        powers, root = Powers(len(coefficients) - 1), ctypes.c_double(-1.0)
        powers.at[: len(coefficients)] = coefficients.tolist()
        falls = library.ex_first_fall(
            ctypes.byref(powers), ctypes.c_double(0.0), ctypes.byref(root)
        )
        assert falls in (0, 1)
        return root.value if falls else None

    return found


def bent_up(rng: np.random.Generator) -> np.ndarray:
    """A parabola with its least value near zero, inside or outside of the interval."""
    low, height = rng.uniform(-0.3, 1.3), 10.0 ** rng.uniform(-6, 0) * rng.choice([-1, 1])
    return np.array([low * low + height, -2 * low, 1.0])


def bent_down(rng: np.random.Generator) -> np.ndarray:
    """One that is largest inside, or falls all along."""
    top = rng.uniform(-0.5, 1.0)
    return np.array([rng.uniform(0.0, 1.0), 2 * top, -1.0])


def straight(rng: np.random.Generator) -> np.ndarray:
    """One that rises or falls."""
    return np.array([rng.uniform(0.0, 1.0), rng.uniform(-2.0, 2.0)])


def wavy(rng: np.random.Generator) -> np.ndarray:
    """One with several turns: a cosine's powers."""
    rate, k = rng.uniform(4.0, 9.0), np.arange(0, 27)
    terms = np.cumprod(np.concatenate([[1.0], rate / np.arange(1, 27)]))
    return rng.uniform(0.3, 0.99) * (k == 0) + terms * np.cos(k * np.pi / 2 + rng.uniform(-1, 1))


@pytest.mark.parametrize("make", [bent_up, bent_down, straight, wavy])
def test_falls_are_where_values_change_sign(
    make: Callable[[np.random.Generator], np.ndarray],
    first_fall: Callable[[np.ndarray], float | None],
) -> None:
    """With higher powers that count little, and some that count."""
    rng, told = np.random.default_rng(7), 0
    for _ in range(400):
        base = make(rng)
        p = np.zeros(max(len(base), 20))
        p[: len(base)] = base
        p[3:20] += rng.normal(size=17) * 10.0 ** rng.uniform(-6, -1) / np.cumprod(np.arange(1, 18))
        values = np.polynomial.polynomial.polyval(GRID, p)
        inner = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
        if values[0] <= NEAR or abs(values[-1]) <= NEAR or (np.abs(values[inner]) <= NEAR).any():
            continue
        told += 1
        below = np.flatnonzero(values <= 0.0)
        root = first_fall(p)
        if not below.size:
            assert root is None
        else:
            assert root is not None
            assert GRID[below[0] - 1] - 1e-12 <= root <= GRID[below[0]] + 1e-12
            assert abs(np.polynomial.polynomial.polyval(root, p)) <= 1e-12
    assert told > 150

"""The longest step with which Runge's and Kutta's classical method of fourth order stays stable on a model.

A rate l is stable under a step h while ``|R(h l)| <= 1``, ``R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24``: up to
``h l = -2.7853`` on the real axis and ``2.8284i`` on the imaginary one (Hairer and Wanner, Solving Ordinary
Differential Equations II, section IV.2).
"""

import math
from collections.abc import Callable, Iterable, Iterator
from itertools import product

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import RATE
from codegen.tuning import TUNING

REAL_LIMIT, IMAGINARY_LIMIT = 2.785293563405282, 2.0 * math.sqrt(2.0)
"""How far the stable part of the negative real axis and of the imaginary one reaches."""

NEAREST, FARTHEST = 2.6156, 2.9603
"""The least and the largest distance of the boundary in the left half plane."""

ALL_SIGNS = 3
"""Up to so many friction ports every mode is looked at; of more, every set that sticks."""


def stable_step(rate: complex) -> float:
    """The longest stable step [s] for one rate of the linearised model [1/s].

    What grows by itself, at a rate of positive real part, is no fault of the step; it must not turn too far.

    >>> round(stable_step(-10), 5), round(stable_step(10j), 5), stable_step(3)
    (0.27853, 0.28284, inf)
    """
    if rate.real >= 0:
        return IMAGINARY_LIMIT / abs(rate.imag) if rate.imag else math.inf
    ray = rate / abs(rate)
    low, high = NEAREST - TUNING.bracket, FARTHEST + TUNING.bracket
    for _ in range(50):
        middle = (low + high) / 2
        z = middle * ray
        if abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) > 1:
            high = middle
        else:
            low = middle
    return low / abs(rate)


def longest_stable_step(
    model: ClosedModel, t: float, s: Array, given: Array, slopes: Array
) -> float:
    """The longest step [s] that is stable in every friction mode at an instant; inf without a bound.

    ``given``, ``slopes``: the external inputs and their rates. Modes that cannot be evaluated there, and
    slopes that a jump of the rates makes infinite, bound nothing.
    """
    found = (
        _slopes(model, t, s, given, slopes, mode) for mode in _modes(len(model.friction_inputs))
    )
    return min((step for J in found for step in _steps(J)), default=math.inf)


def _modes(ports: int) -> Iterator[Mode]:
    return product((0, 1, -1) if ports <= ALL_SIGNS else (0, 1), repeat=ports)


def _steps(jacobian: Array | None) -> Iterable[float]:
    """The bounds by the eigenvalues; real parts that are rounding of imaginary ones count as none."""
    if jacobian is None:
        return ()
    found = np.linalg.eigvals(jacobian)
    rounding = TUNING.rate_rounding * np.abs(found).max(initial=0.0)
    return [
        stable_step(complex(0.0 if abs(rate.real) <= rounding else rate.real, rate.imag))
        for rate in found.tolist()
    ]


def _slopes(
    model: ClosedModel, t: float, s: Array, given: Array, slopes: Array, mode: Mode
) -> Array | None:
    """How the rates of s change with s in a mode; None where it has no values."""

    def rates(point: Array) -> Array:
        return model.evaluate(t, point, given, slopes, mode, checked=False).rate

    try:
        affine = model.affine_map(mode, len(given))
        if affine is not None:
            return affine.rows(RATE)[:, : len(s)]
        with np.errstate(all="ignore"):
            base = rates(s)
            jacobian = np.column_stack([_slope(rates, s, base, j) for j in range(len(s))])
    except SimulationError:
        return None
    return jacobian if np.isfinite(jacobian).all() else None


def _slope(rates: Callable[[Array], Array], s: Array, base: Array, j: int) -> Array:
    """One column, the mean of both sides where both have values; zero where rates jump."""

    def at(step: float) -> Array:
        sides = []
        for d in (step, -step):
            point = s.copy()
            point[j] += d
            sides.append((rates(point) - base) / d)
        finite = [side for side in sides if np.isfinite(side).all()] or sides
        return np.asarray(np.mean(finite, axis=0), dtype=float)

    step = TUNING.difference * (1 + abs(float(s[j])))
    near, far = at(step), at(TUNING.farther * step)
    return np.zeros_like(near) if np.abs(far).max() < 0.5 * np.abs(near).max() else near

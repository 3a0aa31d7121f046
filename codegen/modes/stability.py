"""The longest step with which the classical Runge-Kutta method stays stable on a model."""

import math
from collections.abc import Callable, Iterable, Iterator
from itertools import product

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import RATE
from codegen.standalone.fastest import stable_step
from codegen.tuning import TUNING

ALL_SIGNS = 3
"""Up to so many friction ports every mode is looked at; of more, every set that sticks .."""

ALL_SETS = 8
""".. and of more than these the sets of all and none, and those with one port more or less."""


def longest_stable_step(
    model: ClosedModel, t: float, s: Array, given: Array, slopes: Array
) -> float:
    """The longest step [s] that is stable in every friction mode at an instant; inf without a bound.

    Of more than eight ports in those modes in which at most one or all but one at least are held.

    ``given``, ``slopes``: the external inputs and their rates. Modes that cannot be evaluated there, and
    slopes that a jump of the rates makes infinite, bound nothing.
    """
    found = (
        _slopes(model, t, s, given, slopes, mode) for mode in _modes(len(model.friction_inputs))
    )
    return min((step for J in found for step in _steps(J)), default=math.inf)


def modes_told(ports: int) -> str:
    """In which modes `longest_stable_step` looks, of so many ports."""
    if ports <= ALL_SETS:
        return "every friction mode"
    return "friction modes in which at most one port or all but one are held"


def _modes(ports: int) -> Iterator[Mode]:
    if ports <= ALL_SETS:
        yield from product((0, 1, -1) if ports <= ALL_SIGNS else (0, 1), repeat=ports)
        return
    for most in (1, 0):
        yield (most,) * ports
        for other in range(ports):
            yield tuple(1 - most if i == other else most for i in range(ports))


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
        if model.program.affine and len(mode) > ALL_SETS:
            return None  # redundant ports share, which moves nothing: fewer of them bound as much
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

"""Analytic expressions of time as polynomials, segment by segment, exact to rounding.

Over a segment of half-width h a polynomial of degree n through Chebyshev's points differs from a function
that is at most M in magnitude over the disc of radius 10 h by at most ``4 M rho^-n/(rho - 1)``,
rho = 10 + sqrt(99) (Trefethen, Approximation Theory and Approximation Practice, theorem 8.2). Segments are
halved until that is rounding; so they are as short as what the expression does, and nothing that it does is
missed. Their ends are multiples of powers of two, so they are the same however long a run is.
"""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from bondgraph.errors import SimulationError
from codegen.inputs.discs import disc_of
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

Flags = NDArray[np.bool_]

DEGREE = 13
"""Of the polynomials: exact steps take power series of degree 18, and states integrate."""

BEYOND = 10.0
"""The disc's radius in half-widths of the segment."""

MOST = 2_000_000
"""So many segments are more than a run can have."""

EDGE = 2.0**14
"""So many of the narrowest segments at an end need have no value."""


@dataclass(frozen=True)
class Segments:
    """Where each segment is centred, its half-width, and coefficients in ``(t - centre)/half``."""

    centres: Array
    halves: Array
    powers: Array


def polynomial_segments(expr: sp.Expr, begin: float, end: float) -> Segments:
    """Segments that cover ``begin`` to ``end`` [s]; the outer ones may reach beyond.

    Raises `SimulationError` naming the time where the expression has no finite real value.
    """
    width = 2.0 ** math.ceil(math.log2(max(end - begin, TUNING.least_span)))
    first, last = math.floor(begin / width), math.ceil(end / width)
    centres = np.asarray((np.arange(first, max(last, first + 1)) + 0.5) * width, dtype=np.float64)
    rounding = float(np.spacing(max(abs(begin), abs(end))))
    narrowest, half = max(width * TUNING.narrowest, 2.0**12 * rounding), width / 2
    kept: list[Segments] = []
    total, about = 0, np.zeros(len(centres))
    with np.errstate(all="ignore"):
        while len(centres):
            powers, exact, known, about = _fitted(expr, centres, half, about)
            inside = (centres - half >= begin) & (centres + half <= end)
            if half > EDGE * narrowest:
                _check(expr, known[inside], centres[inside])
            if half <= narrowest:
                powers[~exact], exact[:] = _levels(expr, centres[~exact], half), True
                # A corner is known to a rounding: beyond it there need be no value.
                at_edge = np.minimum(abs(centres - begin), abs(centres - end)) <= EDGE * narrowest
                exact &= np.isfinite(powers[:, 0]) | ~at_edge
                centres, powers, about = centres[exact], powers[exact], about[exact]
                exact = exact[exact]
            kept.append(Segments(centres[exact], np.full(exact.sum(), half), powers[exact]))
            total += len(centres)
            if total > MOST:
                raise SimulationError(
                    f"{expr} does more than {MOST} polynomials can tell between t = {begin:g} and {end:g}"
                )
            half /= 2
            halved = (centres[~exact][:, None] + half * np.array([-1.0, 1.0])).ravel()
            needed = (halved + half > begin) & (halved - half < max(end, begin + narrowest))
            centres, about = halved[needed], np.repeat(about[~exact] / 2, 2)[needed]
    return _checked(expr, _sorted(kept))


def _fitted(
    expr: sp.Expr, centres: Array, half: float, about: Array
) -> tuple[Array, Flags, Flags, Array]:
    """The polynomials over segments of one width; which are exact to rounding, and which have values.

    ``about``: the size of the expression round each segment, which comes back with the segment's own.
    """
    nodes = chebyshev_points()
    times = centres[:, None] + half * nodes
    values = disc_of(expr, times, np.zeros_like(times))[0]
    centre, off = disc_of(expr, centres, np.full_like(centres, BEYOND * half))
    rho = BEYOND + math.sqrt(BEYOND**2 - 1)
    error = 4 * (np.abs(centre) + off) * rho**-DEGREE / (rho - 1)
    size = _size(expr, times).max(axis=1)
    about = np.fmax(about, size)
    enough = TUNING.segment_rounding * np.fmax(size, TUNING.flat * about) + TUNING.nothing_there
    shares, basis = chebyshev_powers()
    # One after the other: their product would have entries of 1e6 that cancel.
    exact = np.asarray(np.isfinite(error) & (error <= enough), dtype=np.bool_)
    known = np.asarray(np.isfinite(values).any(axis=1))
    return values @ shares.T @ basis, exact, known, about


def _levels(expr: sp.Expr, centres: Array, half: float) -> Array:
    """Constants, the means of what values there are."""
    values = disc_of(
        expr, centres[:, None] + half * chebyshev_points(), np.zeros((len(centres), DEGREE + 1))
    )[0]
    finite = np.isfinite(values)
    means = np.where(finite, values, 0.0).sum(axis=1) / finite.sum(axis=1)
    return np.pad(means[:, None], ((0, 0), (0, DEGREE)))


def _size(expr: sp.Expr, times: Array) -> Array:
    """The magnitude of the terms that are summed: where they cancel, their rounding remains."""
    if isinstance(expr, sp.Add):
        total: Array = sum((_size(part, times) for part in expr.args), np.zeros_like(times))
        return total
    if isinstance(expr, sp.Mul):
        return np.asarray(math.prod((_size(part, times) for part in expr.args), start=1.0))
    return np.abs(disc_of(expr, times, np.zeros_like(times))[0])


def _sorted(kept: list[Segments]) -> Segments:
    centres = np.concatenate([one.centres for one in kept])
    order = np.argsort(centres, kind="stable")
    halves = np.concatenate([one.halves for one in kept])[order]
    return Segments(centres[order], halves, np.concatenate([one.powers for one in kept])[order])


def _checked(expr: sp.Expr, found: Segments) -> Segments:
    _check(expr, np.asarray(np.isfinite(found.powers).all(axis=1)), found.centres)
    return found


def _check(expr: sp.Expr, known: Flags, centres: Array) -> None:
    wrong = np.flatnonzero(~known)
    if len(wrong):
        raise SimulationError(
            f"at t = {centres[wrong[0]]:.9g} the known source {expr} has no finite real value"
        )


@cache
def chebyshev_points() -> Array:
    """Chebyshev's points of the first kind on [-1, 1], one more than the degree."""
    nodes: Array = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    nodes.flags.writeable = False
    return nodes


@cache
def chebyshev_powers() -> tuple[Array, Array]:
    """From values at the points to Chebyshev coefficients, and from those, by rows, to powers."""
    count = DEGREE + 1
    angles = np.outer(np.arange(count), np.pi * (np.arange(count) + 0.5) / count)
    shares = 2 / count * np.cos(angles)
    shares[0] /= 2
    basis = [np.polynomial.chebyshev.cheb2poly(row) for row in np.eye(count)]
    padded = np.array([np.pad(row, (0, count - len(row))) for row in basis])
    shares.flags.writeable = padded.flags.writeable = False
    return shares, padded

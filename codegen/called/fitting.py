"""A function of time as polynomials, halved until they meet it at points that were not used to make them.

Of a function that can only be called no bound is known, so what it does between the points at which it is
called stays unseen. These are the Chebyshev points of every segment, as many others between them, and the
samples of the run. Where it jumps or has a corner that nobody told, segments are halved until one is as short
as the rounding of time; the segment before then goes on over it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SignalError
from codegen.inputs.segments import DEGREE, chebyshev_points, chebyshev_powers
from codegen.numbers.arrays import Array, Flags
from codegen.tuning import TUNING

COARSEST = 16
"""No segment is longer than the span over this."""

MOST = 100_000
"""Segments beyond which a function is noise, or data."""

SINGULAR = 16.0
"""So many of the narrowest segments side by side may have no polynomial: at a jump, or where a root begins."""

BETWEEN = np.cos(np.pi * np.arange(1, DEGREE + 1) / (DEGREE + 1))
"""Points between Chebyshev's, at which polynomials are compared with the function."""
BETWEEN.flags.writeable = False

Called = Callable[[Array], Array]
"""A function of many times [s], in turn."""


@dataclass(frozen=True)
class Fits:
    """Segments in turn: where each begins, its centre, half-width, and coefficients in ``(t - centre)/half``.

    ``smooth``: whether it goes on where the one before it ends.
    """

    begins: Array
    centres: Array
    halves: Array
    powers: Array
    smooth: Flags


class _Kept(NamedTuple):
    """Segments that meet the function, and what they may miss it by."""

    centres: Array
    halves: Array
    powers: Array
    allowed: Array


class _Cells(NamedTuple):
    """Segments of one width in each stretch that are still to be fitted, and the size round each."""

    centres: Array
    halves: Array
    about: Array


def fits(
    called: Called, ends: Sequence[float], samples: Array, tolerance: float
) -> Fits:
    """Segments from the first to the last of ``ends`` [s], none of which goes over one of these.

    ``samples``: times at which polynomials are compared with the function, too. ``tolerance``: of the function's
    size where they are. Raises `SignalError` where no polynomials keep to it.
    """
    span = ends[-1] - ends[0]
    rounding = float(np.spacing(np.abs(ends).max()))
    narrowest = max(span * TUNING.narrowest, 2.0**12 * rounding)
    told = _Seen(samples, called(samples), ends)
    cells, kept, total = _first(ends), list[_Kept](), 0
    while len(cells.centres):
        powers, good, about, allowed = _fitted(called, cells, tolerance)
        good &= told.met(cells, powers, allowed, good)
        kept.append(_Kept(cells.centres[good], cells.halves[good], powers[good], allowed[good]))
        left = ~good & (cells.halves > narrowest)
        total += int(good.sum())
        if total + 2 * left.sum() > MOST:
            raise SignalError(_refusal(float(cells.centres[left][0]), ends))
        cells = _halved(cells, about, left)
    return _in_turn(_with_levels(_sorted(kept), called, samples, ends, narrowest), ends)


def _first(ends: Sequence[float]) -> _Cells:
    """The stretches between ends, each in as many equal parts as it needs."""
    longest = (ends[-1] - ends[0]) / COARSEST
    parts = [
        np.linspace(a, b, max(int(np.ceil((b - a) / longest * (1 - TUNING.together))), 1) + 1)
        for a, b in zip(ends, ends[1:], strict=False)
    ]
    begins = np.concatenate([part[:-1] for part in parts])
    afters = np.concatenate([part[1:] for part in parts])
    return _Cells((begins + afters) / 2, (afters - begins) / 2, np.zeros(len(begins)))


def _fitted(
    called: Called, cells: _Cells, tolerance: float
) -> tuple[Array, Flags, Array, Array]:
    """The polynomials over cells, which meet the function between their points, its size, and what they may miss.

    What the rounding of time does to the function is no miss of theirs.
    """
    places = np.concatenate([chebyshev_points(), BETWEEN])
    times = cells.centres[:, None] + cells.halves[:, None] * places
    values = called(times.ravel()).reshape(times.shape)
    shares, basis = chebyshev_powers()
    # One after the other: their product would have entries of 1e6 that cancel.
    powers = values[:, : DEGREE + 1] @ shares.T @ basis
    missed = np.abs(powers @ np.vander(BETWEEN, DEGREE + 1, increasing=True).T - values[:, DEGREE + 1 :])
    about = np.maximum(np.abs(values).max(axis=1), cells.about)
    slope = np.ptp(values, axis=1) / cells.halves
    late = TUNING.late * np.spacing(np.abs(cells.centres) + cells.halves)
    allowed = tolerance * about + late * slope + TUNING.nothing_there
    good = missed.max(axis=1) <= allowed
    return powers, np.asarray(good, dtype=np.bool_), about, allowed


class _Seen:
    """What the function gives at the samples of a run, but for those at ends of stretches."""

    def __init__(self, samples: Array, values: Array, ends: Sequence[float]) -> None:
        inside = ~np.isin(samples, ends)
        self._times, self._values = samples[inside], values[inside]

    def met(self, cells: _Cells, powers: Array, allowed: Array, good: Flags) -> Flags:
        """Which cells meet it at all samples within; those that are not good are not looked at."""
        where = np.flatnonzero(good)
        found: Flags = np.ones(len(good), dtype=np.bool_)
        if not len(where) or not len(self._times):
            return found
        own = np.searchsorted((cells.centres - cells.halves)[where], self._times, side="right") - 1
        own = where[np.maximum(own, 0)]
        tau = (self._times - cells.centres[own]) / cells.halves[own]
        inside = (tau >= -1) & (tau < 1)
        own, tau, values = own[inside], tau[inside], self._values[inside]
        total = np.zeros(len(tau))
        for column in powers.T[::-1]:
            total = total * tau + column[own]
        off = np.abs(total - values) > allowed[own]
        found[own[off]] = False
        return found


def _halved(cells: _Cells, about: Array, left: Flags) -> _Cells:
    half = np.repeat(cells.halves[left] / 2, 2)
    signs = np.tile([-1.0, 1.0], int(left.sum()))
    return _Cells(np.repeat(cells.centres[left], 2) + signs * half, half, np.repeat(about[left] / 2, 2))


def _sorted(kept: Sequence[_Kept]) -> _Kept:
    every = _Kept(*map(np.concatenate, zip(*kept, strict=True)))
    order = np.argsort(every.centres, kind="stable")
    return _Kept(*(part[order] for part in every))


def _with_levels(
    kept: _Kept, called: Called, samples: Array, ends: Sequence[float], narrowest: float
) -> _Kept:
    """The same with levels where none meets it: what it is where such a moment begins, and at samples within."""
    begins = np.append(kept.centres - kept.halves, ends[-1])
    afters = np.append(ends[0], kept.centres + kept.halves)
    gaps = begins - afters
    if not len(kept.centres) or gaps.max() > SINGULAR * narrowest:
        raise SignalError(_refusal(float(afters[np.argmax(gaps)]), ends))
    found = [kept]
    before, after = _at_ends(kept.powers)
    gained = np.append(np.append(0.0, np.abs(after - before) / (2 * kept.halves)), 0.0)
    for k in np.flatnonzero(gaps > narrowest / 2).tolist():
        a, b = float(afters[k]), float(begins[k])
        parts = np.array([a, *samples[(samples > a) & (samples < b)], b])
        levels = np.pad(called(parts[:-1])[:, None], ((0, 0), (0, DEGREE)))
        # A level misses what the function gains over it, by what it gains before and after.
        room = np.full(len(levels), 2 * (b - a) * gained[k : k + 2].max())
        found.append(_Kept((parts[:-1] + parts[1:]) / 2, np.diff(parts) / 2, levels, room))
    return _sorted(found)


def _at_ends(powers: Array) -> tuple[Array, Array]:
    """What polynomials are where their segments begin and end."""
    signs = (-1.0) ** np.arange(powers.shape[1])
    return powers @ signs, powers.sum(axis=1)


def _in_turn(kept: _Kept, ends: Sequence[float]) -> Fits:
    """The segments from where the one before ends, or from an end of stretches."""
    centres, halves, powers, allowed = kept
    begins = centres - halves
    first, last = _at_ends(powers)
    apart = np.abs(first[1:] - last[:-1])
    smooth = np.append(False, apart <= SINGULAR * (allowed[1:] + allowed[:-1]))
    for end in ends[:-1]:
        own = np.searchsorted(centres, end)
        begins[own], smooth[own] = end, False
    return Fits(begins, centres, halves, powers, np.asarray(smooth, dtype=np.bool_))


def _refusal(near: float, ends: Sequence[float]) -> str:
    return (
        f"does more than {MOST} polynomials can tell between t = {ends[0]:g} and {ends[-1]:g}, first near t = "
        f"{near:.9g}; tell corners and jumps as breakpoints, give a larger tolerance, or, of noise and data, "
        "codegen.Sampled(times, values)"
    )

"""A function of time as polynomials, halved until they meet it at points that were not used to make them.

Of a function that can only be called no bound is known, so what it does between the points at which it is
called stays unseen. These are the Chebyshev points of every segment, as many others between them, and the
samples of the run. Where it jumps or has a corner that nobody told, segments are halved until one is as short
as the rounding of time; the segment before then goes on over it.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SignalError
from codegen.called.turns import MOST, Called, Fits, Kept, in_turn, refusal
from codegen.inputs.segments import DEGREE, chebyshev_points, chebyshev_powers
from codegen.numbers.arrays import Array, Flags
from codegen.tuning import TUNING

COARSEST = 16
"""No segment is longer than the span over this."""

BETWEEN = np.cos(np.pi * np.arange(1, DEGREE + 1) / (DEGREE + 1))
"""Points between Chebyshev's, at which polynomials are compared with the function."""
BETWEEN.flags.writeable = False


class _Cells(NamedTuple):
    """Segments of one width in each stretch that are still to be fitted, and the size round each."""

    centres: Array
    halves: Array
    about: Array


def fits(called: Called, ends: Sequence[float], samples: Array, tolerance: float) -> Fits:
    """Segments from the first to the last of ``ends`` [s], none of which goes over one of these.

    ``samples``: times at which polynomials are compared with the function, too. ``tolerance``: of the
    function's size where they are. Raises `SignalError` where no polynomials keep to it.
    """
    span = ends[-1] - ends[0]
    rounding = float(np.spacing(np.abs(ends).max()))
    narrowest = max(span * TUNING.narrowest, 2.0**12 * rounding)
    told = _Seen(samples, called(samples), ends)
    cells, kept, total = _first(ends), list[Kept](), 0
    while len(cells.centres):
        powers, good, about, allowed = _fitted(called, cells, tolerance)
        good &= told.met(cells, powers, allowed, good)
        kept.append(Kept(cells.centres[good], cells.halves[good], powers[good], allowed[good]))
        left = ~good & (cells.halves > narrowest)
        total += int(good.sum())
        if total + 2 * left.sum() > MOST:
            raise SignalError(refusal(float(cells.centres[left][0]), ends))
        cells = _halved(cells, about, left)
    return in_turn(kept, called, samples, ends, narrowest)


def _first(ends: Sequence[float]) -> _Cells:
    """The stretches between ends, each in as many equal parts as it needs."""
    longest = (ends[-1] - ends[0]) / COARSEST
    parts = [
        np.linspace(a, b, max(int(np.ceil((b - a) / longest * (1 - TUNING.together))), 1) + 1)
        for a, b in pairwise(ends)
    ]
    begins = np.concatenate([part[:-1] for part in parts])
    afters = np.concatenate([part[1:] for part in parts])
    return _Cells((begins + afters) / 2, (afters - begins) / 2, np.zeros(len(begins)))


def _fitted(called: Called, cells: _Cells, tolerance: float) -> tuple[Array, Flags, Array, Array]:
    """The polynomials over cells, which of them meet the function, its size, and what they may miss it by.

    What the rounding of time does to the function is no miss of theirs.
    """
    places = np.concatenate([chebyshev_points(), BETWEEN])
    times = cells.centres[:, None] + cells.halves[:, None] * places
    values = called(times.ravel()).reshape(times.shape)
    shares, basis = chebyshev_powers()
    # One after the other: their product would have entries of 1e6 that cancel.
    powers = values[:, : DEGREE + 1] @ shares.T @ basis
    missed = np.abs(
        powers @ np.vander(BETWEEN, DEGREE + 1, increasing=True).T - values[:, DEGREE + 1 :]
    )
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
    return _Cells(
        np.repeat(cells.centres[left], 2) + signs * half, half, np.repeat(about[left] / 2, 2)
    )

"""Stretches of a linear model in which nothing is watched: one exponential for each distance of samples."""

import math
from collections.abc import Sequence

import numpy as np

from codegen.inputs.generators import generator
from codegen.inputs.pieces import Piece
from codegen.numbers.arrays import Array
from codegen.numbers.ladder import Ladder, rows_by_doubling
from codegen.numbers.pairs import Pair, matmul, pair, stacked
from codegen.program.affine import balanced_norm
from codegen.runs.track import Ended, Track
from codegen.tuning import TUNING

FEW = 3
"""Samples at equal distances from so many on are worth an exponential for the distance."""


class FreeLeg:
    """A stretch from t with the integrated vector s; ``rates``: the rate of s over [s, w, dw, 1].

    It takes no steps, so any stretch takes the same time; the digits are those of `Ladder`.
    """

    def __init__(self, rates: Pair, pieces: Sequence[Piece], t: float, s: Array) -> None:
        made = generator(pieces, t)
        n, m, size = len(s), len(made.C), len(made.G)
        one, slopes = pair(np.eye(1, size)), matmul(pair(made.C), pair(made.G))
        inputs = matmul(rates[:, n : n + 2 * m + 1], stacked([pair(made.C), slopes, one]))
        own = pair(np.hstack([np.zeros((size, n)), made.G]))
        M = stacked([stacked([rates[:, :n], inputs], axis=1), own])
        self._n, self._t = n, t
        self._z = np.concatenate([s, made.start])
        self._ladder = Ladder(M, balanced_norm(M.hi))

    def run(self, stop: float, times: Array, track: Track) -> Ended:
        """Record the samples before ``stop``, and go on to there."""
        first = track.recorded
        last = first + int(np.searchsorted(times[first:], stop, side="left"))
        # An event may lie a rounding behind a sample that shows the instant after it.
        points = np.maximum(np.append(times[first:last], stop), self._t)
        self._ladder.check(self._t, stop - self._t)
        shrink = math.ldexp(1.0, min(0, TUNING.large - math.frexp(float(np.abs(self._z).max()))[1]))
        rows = self._at(pair(self._z[None] * shrink), points)[:, : self._n] / shrink
        track.see(rows)
        track.take(rows[:-1], ())
        return stop, rows[-1], frozenset()

    def _at(self, z: Pair, points: Array) -> Array:
        """The states at these points, as rows."""
        ladder, inside = self._ladder, points[:-1]
        if len(inside) < FEW or not _even(inside):
            each = Pair(*(np.repeat(part, len(points), axis=0) for part in z))
            return ladder.after(each, points - self._t).hi
        begin = ladder.after(z, points[:1] - self._t)
        leap = ladder.leap(float(inside[-1] - inside[0]) / (len(inside) - 1))
        rows = rows_by_doubling(leap, begin, len(inside) - 1)
        return np.vstack([rows.hi, ladder.after(rows[-1:], points[-1:] - inside[-1]).hi])


def _even(times: Array) -> bool:
    """Whether times have one distance, but for their own rounding."""
    step = float(times[-1] - times[0]) / (len(times) - 1)
    even = times[0] + step * np.arange(len(times))
    return bool(np.abs(times - even).max() <= 2 * np.spacing(np.abs(times).max()))

"""What a delay has read so far, as a signal of what it gives: polynomials between breakpoints."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.inputs.signal import Pieced
from codegen.model.sources import Lag
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

NODES = 12
"""So many points of a part make its polynomial."""

CHECKS = (0.07, 0.39, 0.83)
"""Where in a part it is compared with what there is."""


@dataclass(frozen=True)
class Past:
    """What one delay gives: its start, and ``late`` [s] after the begin what was read so much earlier.

    Between the ``points`` hold the ``parts``, of which the first goes back without end; ``smooth``: the
    points at which it goes on smoothly. Beyond the last of them nothing is known.
    """

    late: float
    points: tuple[float, ...]
    parts: tuple[Piece, ...]
    smooth: frozenset[float] = frozenset()

    def taken(self, begin: float, end: float, values: Array, turns: bool, size: float) -> "Past":
        """With what was read at the nodes of a part.

        ``turns``: whether it may not go on smoothly from the part before; ``size``: the largest so far.
        """
        half = 0.5 * (end - begin)
        powers = from_nodes() @ (values - values[0]) / half ** np.arange(NODES)
        powers[0] += values[0]  # what stays the same does so exactly
        part = Piece(begin + half + self.late, ((0.0, tuple(powers.tolist())),), 0.5 / half)
        broken = turns and breaks_off(self.parts[-1], part, self.points[-1], self.late, size)
        smoothly = self.smooth if broken else self.smooth | {self.points[-1]}
        return replace(
            self, points=(*self.points, end + self.late), parts=(*self.parts, part), smooth=smoothly
        )

    def since(self, t: float) -> "Past":
        """Without what is given before t [s]."""
        over = bisect_right(self.points, t)
        if not 0 < over < len(self.points):
            return self
        points = self.points[over:]
        return replace(self, points=points, parts=self.parts[over:], smooth=self.smooth & {*points})

    def signal(self) -> Pieced:
        """What it gives as far as it is known; the last piece goes on beyond."""
        return Pieced(self.points[:-1], self.parts, self.smooth)

    def following(self, t: float) -> float:
        """The next point after t that is known, and at which it does not go on smoothly."""
        ahead = self.points[bisect_right(self.points, t) : -1]
        return next((point for point in ahead if point not in self.smooth), np.inf)


def begun(lag: Lag, begin: float) -> Past:
    """A delay of which nothing is known but its start, at the begin [s] of a run."""
    return Past(lag.late, (begin + lag.late,), (Piece(0.0, ((0.0, (lag.start,)),)),))


def breaks_off(before: Piece, after: Piece, seam: float, late: float, size: float) -> bool:
    """Whether steps over a seam [s] would err there by more than is nothing of what is read.

    Values and slopes up to the third are compared, over steps as long as the parts, or a good part of the
    delay; where parts are short, slopes of high order are rounding (Markov's bound).
    """
    lengths = [1 / one.pace for one in (before, after) if one.pace]
    h = max(*lengths, TUNING.seam_reach * late)
    jumps = np.abs(_rises(after, seam, h) - _rises(before, seam, h))
    magnified = (h / min(lengths)) ** np.arange(4) * MARKOV
    return bool((jumps > TUNING.delayed * magnified * size).any())


MARKOV = np.array([1.0, NODES**2, NODES**4 / 3, NODES**6 / 15])
"""So much larger than a polynomial's error its slopes' errors may be, at the ends of a part."""


def _rises(piece: Piece, t: float, h: float) -> Array:
    """A polynomial's value and slopes at a time as it would rise over steps of h."""
    powers = np.array(piece.terms[0][1])
    tau, k = t - piece.start, np.arange(len(powers))
    rows = [np.array([math.comb(n, order) for n in k.tolist()]) * tau ** np.maximum(k - order, 0) * h**order
            for order in range(4)]  # fmt: skip
    return np.array([row @ powers for row in rows])


def nodes() -> Array:
    """Chebyshev's points of the interval from 0 to 1, its ends not among them."""
    return 0.5 - 0.5 * np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))


def from_nodes() -> Array:
    """From values at the nodes to powers of the place, from -1 to 1."""
    return np.asarray(np.linalg.inv(np.vander(2 * nodes() - 1, increasing=True)))


def missed(values: Array, checks: Sequence[float]) -> float:
    """How far the polynomial of these values is off at the points between."""
    powers = from_nodes() @ values
    places = 2 * np.array(CHECKS) - 1
    return float(np.abs(np.vander(places, NODES, increasing=True) @ powers - checks).max())

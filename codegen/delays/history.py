"""What a delay has read so far, as a signal of what it gives: polynomials between breakpoints."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.inputs.signal import Pieced
from codegen.model.lags import Lag
from codegen.numbers.arrays import Array

NODES = 12
"""So many points of a part make its polynomial."""

CHECKS = (0.07, 0.39, 0.83)
"""Where in a part it is compared with what there is."""


@dataclass(frozen=True)
class Past:
    """What one delay gives: its start, and from its ``late`` [s] after the begin on what was read so much earlier.

    Between the ``points`` hold the ``parts``, of which the first goes back without end; ``smooth``: the points
    at which it goes on smoothly. Beyond the last of them nothing is known.
    """

    late: float
    points: tuple[float, ...]
    parts: tuple[Piece, ...]
    smooth: frozenset[float] = frozenset()

    def taken(self, begin: float, end: float, values: Array, smooth: bool) -> "Past":
        """With what was read at the nodes of a part; ``smooth``: whether it goes on from the part before."""
        half = 0.5 * (end - begin)
        powers = from_nodes() @ values / half ** np.arange(NODES)
        part = Piece(begin + half + self.late, ((0.0, tuple(powers.tolist())),), 0.5 / half)
        smoothly = self.smooth | {self.points[-1]} if smooth else self.smooth
        return replace(
            self, points=(*self.points, end + self.late), parts=(*self.parts, part), smooth=smoothly
        )

    def since(self, t: float) -> "Past":
        """Without what is given before t [s]."""
        over = bisect_right(self.points, t)
        if not 0 < over < len(self.points):
            return self
        points = self.points[over:]
        return replace(
            self, points=points, parts=self.parts[over:], smooth=self.smooth & {*points}
        )

    def signal(self) -> Pieced:
        """What it gives as far as it is known; the last piece goes on beyond."""
        return Pieced(self.points[:-1], self.parts, self.smooth)

    def following(self, t: float) -> float:
        """The next breakpoint after t that is known."""
        over = bisect_right(self.points, t)
        return self.points[over] if over < len(self.points) - 1 else np.inf


def begun(lag: Lag, begin: float) -> Past:
    """A delay of which nothing is known but its start, at the begin [s] of a run."""
    return Past(lag.late, (begin + lag.late,), (Piece(0.0, ((0.0, (lag.start,)),)),))


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

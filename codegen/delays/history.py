"""What a delay has read so far, as a signal of what it gives: polynomials between breakpoints."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.inputs.signal import Pieced
from codegen.numbers.arrays import Array

NODES = 12
"""So many points of a part make its polynomial."""

CHECKS = (0.07, 0.39, 0.83)
"""Where in a part it is compared with what there is."""


class History:
    """What one delay gives: ``start``, and from ``begin + late`` [s] on what was read so much earlier."""

    def __init__(self, begin: float, late: float, start: float) -> None:
        self.late = late
        self._points, self._parts = [begin + late], [Piece(0.0, ((0.0, (start,)),))]
        self._smooth = set[float]()

    def take(self, begin: float, end: float, values: Array, smooth: bool) -> None:
        """What was read at the nodes of a part; ``smooth``: whether it goes on from the part before."""
        if smooth:
            self._smooth.add(self._points[-1])
        half = 0.5 * (end - begin)
        powers = from_nodes() @ values / half ** np.arange(NODES)
        self._parts.append(
            Piece(begin + half + self.late, ((0.0, tuple(powers.tolist())),), 0.5 / half)
        )
        self._points.append(end + self.late)

    def signal(self) -> Pieced:
        """What it gives as far as it is known; the last piece goes on beyond."""
        return Pieced(tuple(self._points[:-1]), tuple(self._parts), frozenset(self._smooth))

    def following(self, t: float) -> float:
        """The next breakpoint after t that is known."""
        found = [point for point in self._points[:-1] if point > t]
        return min(found, default=np.inf)


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

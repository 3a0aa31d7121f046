"""A grid of channels between walls: where upright and level lines may run, and what crossing costs."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bondgraph.layout.boxes import Box, Point

if TYPE_CHECKING:
    import numpy as np

    Flags = np.ndarray[tuple[int, int], np.dtype[np.bool_]]
    Costs = np.ndarray[tuple[int, int], np.dtype[np.float64]]

Line = tuple[Point, Point]

_FLAT = 1e-6


@dataclass(frozen=True)
class Grid:
    """Crossings of upright and level lines. ``level``, ``upright``: edges that are blocked, by the row and
    column of their left or upper end; ``over``, ``down``: what crossing lines on them costs.
    """

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    level: "Flags"
    upright: "Flags"
    over: "Costs"
    down: "Costs"

    def at(self, point: Point) -> tuple[int, int]:
        """Row and column of one of the grid's crossings."""
        x, y = (round(value, 2) for value in point)
        return bisect_left(self.ys, y), bisect_left(self.xs, x)

    def block(self, box: Box) -> None:
        """No line runs through the rectangle."""
        self._block(box, level=True)
        self._block(box, level=False)

    def keep_off(self, line: Line, by: float, cost: float) -> None:
        """No line runs along this one, nearer than so; to cross it costs."""
        (x0, y0), (x1, y1) = line
        box = Box(min(x0, x1) - by, min(y0, y1) - by, max(x0, x1) + by, max(y0, y1) + by)
        if abs(y1 - y0) < _FLAT:
            self._block(box, level=True)
        if abs(x1 - x0) < _FLAT:
            self._block(box, level=False)
        low, high = sorted((y0, y1))
        for row in range(bisect_left(self.ys, low), bisect_right(self.ys, high)):
            if high > low:
                x = x0 + (x1 - x0) * (self.ys[row] - y0) / (y1 - y0)
                column = bisect_right(self.xs, x) - 1
                if 0 <= column < len(self.xs) - 1:
                    self.over[row, column] += cost
        low, high = sorted((x0, x1))
        for column in range(bisect_left(self.xs, low), bisect_right(self.xs, high)):
            if high > low:
                y = y0 + (y1 - y0) * (self.xs[column] - x0) / (x1 - x0)
                row = bisect_right(self.ys, y) - 1
                if 0 <= row < len(self.ys) - 1:
                    self.down[row, column] += cost

    def _block(self, box: Box, level: bool) -> None:
        """Block the edges of one kind whose inside lies in the rectangle."""
        if level:
            rows = slice(bisect_right(self.ys, box.top), bisect_left(self.ys, box.bottom))
            columns = slice(
                max(bisect_right(self.xs, box.left) - 1, 0), bisect_left(self.xs, box.right)
            )
            self.level[rows, columns] = True
        else:
            rows = slice(
                max(bisect_right(self.ys, box.top) - 1, 0), bisect_left(self.ys, box.bottom)
            )
            columns = slice(bisect_right(self.xs, box.left), bisect_left(self.xs, box.right))
            self.upright[rows, columns] = True


def grid(xs: Iterable[float], ys: Iterable[float]) -> Grid:
    """A grid without walls, with lines at these places."""
    import numpy as np

    own_xs, own_ys = _apart(xs), _apart(ys)
    rows, columns = len(own_ys), len(own_xs)
    return Grid(
        own_xs,
        own_ys,
        np.zeros((rows, columns), dtype=np.bool_),
        np.zeros((rows, columns), dtype=np.bool_),
        np.zeros((rows, columns)),
        np.zeros((rows, columns)),
    )


def _apart(values: Iterable[float]) -> tuple[float, ...]:
    """In rising order, each once, to a hundredth."""
    return tuple(sorted({round(value, 2) for value in values}))

"""Where a line can leave, or reach, a rectangle straight, with nothing in its way."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from bondgraph.layout.boxes import Box, Point, around
from bondgraph.layout.grid import Line

STUB, FREE = 12.0, 3.0
"""A line leaves and reaches a rectangle straight from so far on; so much is left free before it."""

ALONG = 5.0
"""How far a line keeps off from lines that it runs along."""

SIDES: tuple[tuple[int, int], ...] = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""The ways right, down, left and up."""

_CLOSE = 1.0
"""How far it keeps off there where lines crowd round a rectangle."""

_SPACING, _MOST = 14.0, 7
"""How far places on a side are from each other, and how many at most lie on either side of its middle."""


@dataclass(frozen=True)
class Surroundings:
    """What lines have to mind: walls, lines that they may cross, posts that they must not touch."""

    walls: Sequence[Box]
    lines: Sequence[Line]
    posts: Sequence[Line]


@dataclass(frozen=True)
class Stub:
    """Where a line can leave or reach a rectangle: near the edge, farther out, and the way out."""

    edge: Point
    outer: Point
    way: int


def stubs(
    boxes: Sequence[Box], others: Sequence[Box], near: Surroundings, lines: Sequence[Line],
    close: bool = False,
) -> Iterator[Stub]:  # fmt: skip
    """The places round the rectangles where a line can leave, or reach, them.

    ``close``: between lines that crowd round the rectangle, as near to them as not to touch.
    """
    for box in boxes:
        for edge, way in _edges(box, others):
            inner, outer = _off(edge, way, FREE), _off(edge, way, STUB)
            own = around([Box(*inner, *inner), Box(*outer, *outer)]).grown(FREE)
            wide = own.grown(_CLOSE - FREE if close else ALONG - FREE)
            if any(wall != box and own.overlaps(wall) for wall in near.walls):
                continue
            if any(wide.crossed(*line) for line in (*lines, *near.posts)):
                continue
            yield Stub(inner, outer, way)


def _off(point: Point, way: int, by: float) -> Point:
    """The point so far off a side, to a hundredth as the grid has it."""
    dx, dy = SIDES[way]
    return round(point[0] + by * dx, 2), round(point[1] + by * dy, 2)


def _edges(box: Box, others: Sequence[Box]) -> Iterator[tuple[Point, int]]:
    """Points on the sides of a rectangle, from the middle of each outwards, and the way out.

    Those first from which a straight line goes to the middle of another rectangle.
    """
    x, y = (box.left + box.right) / 2, (box.top + box.bottom) / 2
    aims = [(other.left + other.right) / 2 for other in others]
    for level in (aim for aim in aims if box.left + FREE < aim < box.right - FREE):
        yield (level, box.bottom), 1
        yield (level, box.top), 3
    yield (box.right, y), 0
    yield (box.left, y), 2
    for by in _along(box.right - box.left):
        yield (x + by, box.bottom), 1
        yield (x + by, box.top), 3
    for by in _along(box.bottom - box.top)[1:]:
        yield (box.right, y + by), 0
        yield (box.left, y + by), 2


def _along(long: float) -> list[float]:
    """Places on a side, as they are off its middle, the middle first."""
    most = min(int(long / 2 / _SPACING - 0.25), _MOST)
    return [at * _SPACING for at in sorted(range(-most, most + 1), key=abs)]

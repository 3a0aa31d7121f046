"""What a picture consists of: labels, nodes and bonds with their places, y downwards, in points."""

from collections.abc import Hashable
from dataclasses import dataclass

from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.rich import Rich

Point = tuple[float, float]

INK, QUIET, MARKED = "#000000", "#595959", "#B34700"
"""Text and bonds, names that only explain, and dependent storages (vermilion, darkened to be read)."""


@dataclass(frozen=True)
class Box:
    """A rectangle."""

    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: "Box") -> bool:
        """True where the two have an area in common."""
        across = self.left < other.right and other.left < self.right
        return across and self.top < other.bottom and other.top < self.bottom

    def crossed(self, first: Point, second: Point) -> bool:
        """True where the line from one point to the other runs through the inside (Liang, Barsky)."""
        begin, end = 0.0, 1.0
        (x, y), (dx, dy) = first, (second[0] - first[0], second[1] - first[1])
        for step, room in (
            (-dx, x - self.left), (dx, self.right - x), (-dy, y - self.top), (dy, self.bottom - y),
        ):  # fmt: skip
            if step == 0:
                if room <= 0:
                    return False
            elif step < 0:
                begin = max(begin, room / step)
            else:
                end = min(end, room / step)
        return begin < end

    def grown(self, by: float) -> "Box":
        """The rectangle with a margin."""
        return Box(self.left - by, self.top - by, self.right + by, self.bottom + by)


def around(boxes: list[Box]) -> Box:
    """The smallest rectangle that holds all of them."""
    return Box(
        min(box.left for box in boxes),
        min(box.top for box in boxes),
        max(box.right for box in boxes),
        max(box.bottom for box in boxes),
    )


@dataclass(frozen=True)
class Label:
    """A line of text: where it begins, its base line, its size and colour."""

    rich: Rich
    x: float
    y: float
    size: float
    colour: str = INK

    @property
    def width(self) -> float:
        """How much room it takes along the line."""
        return width(self.rich, self.size)

    @property
    def box(self) -> Box:
        """The rectangle that it fills."""
        up, down = ASCENT * self.size, DESCENT * self.size
        return Box(self.x, self.y - up, self.x + self.width, self.y + down)


@dataclass(frozen=True)
class NodeShape:
    """A node: its labels, and the dashed frame round a dependent storage."""

    name: Hashable
    labels: tuple[Label, ...]
    frame: Box | None = None

    @property
    def box(self) -> Box:
        """The rectangle that it fills."""
        return around([label.box for label in self.labels] + ([self.frame] if self.frame else []))


@dataclass(frozen=True)
class BondShape:
    """A bond: the line from its tail to its head, the barb of its half arrow, its stroke and names.

    ``ends``: the bond as declared. ``receiver``: the node at whose end the stroke lies, which receives
    the effort. ``tail``, ``head``: the nodes that the line runs between.
    """

    ends: tuple[Hashable, Hashable]
    tail: Hashable
    head: Hashable
    path: tuple[Point, ...]
    barb: Point
    stroke: tuple[Point, Point] | None = None
    receiver: Hashable | None = None
    labels: tuple[Label, ...] = ()


@dataclass(frozen=True)
class Scene:
    """A whole picture. ``notes``: lines under it, the first ``swatch`` beside a sample of a frame."""

    title: str
    description: str
    width: float
    height: float
    nodes: tuple[NodeShape, ...]
    bonds: tuple[BondShape, ...]
    notes: tuple[Label, ...] = ()
    swatch: Box | None = None

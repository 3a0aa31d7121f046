"""What a picture consists of: labels, nodes and bonds with their places, y downwards, in points."""

from collections.abc import Hashable
from dataclasses import dataclass

from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.rich import Rich
from bondgraph.layout.boxes import Box, Point, around

INK, QUIET, MARKED = "#000000", "#595959", "#B34700"
"""Text and bonds, names that only explain, and dependent storages (vermilion, darkened to be read)."""


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
    """A node: its labels, and the frame of a ``block`` of signals, or a dashed one of a dependent storage."""

    name: Hashable
    labels: tuple[Label, ...]
    frame: Box | None = None
    block: bool = False

    @property
    def box(self) -> Box:
        """The rectangle that it fills."""
        return around([label.box for label in self.labels] + ([self.frame] if self.frame else []))


@dataclass(frozen=True)
class BondShape:
    """A bond: the line from its tail to its head, the barb of its half arrow, its stroke and names.

    ``ends``: the bond as declared. ``receiver``: the node at whose end the stroke lies, which receives
    the effort. ``tail``, ``head``: the nodes that the line runs between. ``other``: the second barb of the
    full arrow of a bond that leads to a detector, and carries no power.
    """

    ends: tuple[Hashable, Hashable]
    tail: Hashable
    head: Hashable
    path: tuple[Point, ...]
    barb: Point
    stroke: tuple[Point, Point] | None = None
    receiver: Hashable | None = None
    labels: tuple[Label, ...] = ()
    other: Point | None = None


@dataclass(frozen=True)
class SignalShape:
    """A signal: the thin line from what has it to what reads it, and the barbs of its full arrow.

    ``branch``: whether the line begins on that of the same signal to another reader.
    """

    source: Hashable
    reader: Hashable
    path: tuple[Point, ...]
    barbs: tuple[Point, Point]
    branch: bool = False
    labels: tuple[Label, ...] = ()


Shape = NodeShape | BondShape | SignalShape


@dataclass(frozen=True)
class Scene:
    """A whole picture. ``notes``: lines under it, the first ``swatch`` beside a sample of a frame.

    ``order``: the nodes' places in `Subject.items` as one reads them, layer by layer.
    """

    title: str
    description: str
    width: float
    height: float
    nodes: tuple[NodeShape, ...]
    bonds: tuple[BondShape, ...]
    notes: tuple[Label, ...] = ()
    swatch: Box | None = None
    signals: tuple[SignalShape, ...] = ()
    order: tuple[int, ...] = ()

    @property
    def frames(self) -> tuple[Box, ...]:
        """The dashed frames, that beside the legend among them."""
        boxes = [node.frame for node in self.nodes if not node.block]
        return tuple(box for box in (*boxes, self.swatch) if box is not None)

    @property
    def blocks(self) -> tuple[Box, ...]:
        """The frames of blocks of signals."""
        return tuple(node.frame for node in self.nodes if node.block and node.frame is not None)

    @property
    def labels(self) -> tuple[Label, ...]:
        """All text of the picture."""
        drawn: tuple[Shape, ...] = (*self.nodes, *self.bonds, *self.signals)
        return (*(label for one in drawn for label in one.labels), *self.notes)

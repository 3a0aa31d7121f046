"""What is written beside bonds and signals, where it touches nothing: ports, numbers, efforts and flows."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from bondgraph.drawing.bonds import flow_side
from bondgraph.drawing.marks import SMALLER
from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.rich import Rich, Run
from bondgraph.drawing.shapes import INK, QUIET, BondShape, Label, NodeShape, Shape, SignalShape
from bondgraph.drawing.subject import Link
from bondgraph.layout.boxes import Box, Point

SIZE = SMALLER + 0.5

_SHARES = (0.5, 0.44, 0.56, 0.38, 0.62, 0.32, 0.68, 0.25, 0.75)
_NEAR_HEAD = (0.78, 0.7, 0.86, 0.62, 0.5, 0.4)
"""Where along a bond its text is tried: of its middle, and of a port at its head."""

_AWAY = (3.0, 5.0)
_BEYOND = (3.0, 5.0, 14.0, 16.0)
"""How far from the bond; numbers may stand beyond another text."""

Line = tuple[Point, Point]


@dataclass(frozen=True)
class Wish:
    """A text beside a line: on the side of the flow (1), on the other (-1), the first that is free."""

    rich: Rich
    sides: tuple[float, ...]
    shares: tuple[float, ...] = _SHARES
    away: tuple[float, ...] = _AWAY
    colour: str = QUIET


class Crowd:
    """What is drawn already: boxes and lines that a label must not touch."""

    def __init__(
        self, nodes: Sequence[NodeShape], bonds: Sequence[BondShape],
        signals: Sequence[SignalShape] = (),
    ) -> None:  # fmt: skip
        drawn: list[Shape] = [*nodes, *bonds, *signals]
        lined: list[BondShape | SignalShape] = [*bonds, *signals]
        self.boxes = [label.box for one in drawn for label in one.labels]
        self.boxes += [node.frame for node in nodes if node.frame]
        self.lines = [line for one in lined for line in lines_of(one)]
        self.clean = True

    def put(self, path: Sequence[Point], wishes: Sequence[Wish]) -> tuple[Label, ...]:
        """The texts in free places beside a line; one that finds none stands where it was tried first."""
        found = []
        for wish in wishes:
            candidates = list(_candidates(wish, path))
            chosen = next((one for one in candidates if self._free(one.box)), None)
            self.clean = self.clean and chosen is not None
            found.append(chosen or candidates[0])
            self.boxes.append(found[-1].box)
        return tuple(found)

    def _free(self, box: Box) -> bool:
        wide = box.grown(1.0)
        return not any(wide.overlaps(other) for other in self.boxes) and not any(
            wide.crossed(*line) for line in self.lines
        )


def lines_of(shape: BondShape | SignalShape) -> list[Line]:
    """All lines of a bond or a signal: its path, barbs and stroke."""
    path = list(pairwise(shape.path))
    if isinstance(shape, SignalShape):
        return [*path, *((shape.path[-1], barb) for barb in shape.barbs), shape.barbs]
    marks = [(shape.path[-1], barb) for barb in (shape.barb, shape.other) if barb]
    return [*path, *marks, *([shape.stroke] if shape.stroke else [])]


def touching(nodes: Sequence[NodeShape], bonds: Sequence[BondShape]) -> bool:
    """Whether a bond touches a node's text or frame."""
    crowd = Crowd(nodes, [])
    lines = [line for bond in bonds for line in lines_of(bond)]
    return any(box.crossed(*line) for box in crowd.boxes for line in lines)


def written(
    links: Sequence[Link], bonds: Sequence[BondShape], nodes: Sequence[NodeShape], powers: bool,
    numbers: bool,
) -> tuple[tuple[BondShape, ...], bool]:  # fmt: skip
    """The bonds with their texts, and whether all of these found a free place and no bond touches a node.

    Ports of fields stand at the field, efforts over and flows under the bond, numbers where there is room.
    """
    crowd = Crowd(nodes, bonds)
    labels: list[tuple[Label, ...]] = [() for _ in bonds]
    for wishes in (_ports, *([_powers] if powers else []), *([_number] if numbers else [])):
        for at, (link, bond) in enumerate(zip(links, bonds, strict=True)):
            labels[at] += crowd.put(bond.path, wishes(link, at))
    own = (replace(bond, labels=made) for bond, made in zip(bonds, labels, strict=True))
    return tuple(own), crowd.clean and not touching(nodes, bonds)


def _ports(link: Link, _: int) -> list[Wish]:
    tail, head = link.ports
    near_tail = tuple(1 - share for share in _NEAR_HEAD)
    wishes = [Wish(tail, (-1.0, 1.0), near_tail)] if tail else []
    return wishes + ([Wish(head, (-1.0, 1.0), _NEAR_HEAD)] if head else [])


def _powers(link: Link, _: int) -> list[Wish]:
    sided = ((link.effort, -1.0), (link.flow, 1.0))
    return [Wish(rich, (side,)) for rich, side in sided if rich]


def _number(_: Link, at: int) -> list[Wish]:
    return [Wish((Run(str(at + 1)),), (-1.0, 1.0), away=_BEYOND, colour=INK)]


def _candidates(wish: Wish, path: Sequence[Point]) -> Iterator[Label]:
    """Places of a label beside a line's longest piece, the best first."""
    first, last = max(
        pairwise(path),
        key=lambda piece: abs(piece[1][0] - piece[0][0]) + abs(piece[1][1] - piece[0][1]),
    )
    out = flow_side(first, last)
    wide, high = width(wish.rich, SIZE), (ASCENT + DESCENT) * SIZE
    reach = (abs(out[0]) * wide + abs(out[1]) * high) / 2
    for away in wish.away:
        for side in wish.sides:
            for share in wish.shares:
                x = first[0] + share * (last[0] - first[0]) + side * out[0] * (reach + away)
                y = first[1] + share * (last[1] - first[1]) + side * out[1] * (reach + away)
                left, line = x - wide / 2, y - high / 2 + ASCENT * SIZE
                yield Label(wish.rich, left, line, SIZE, wish.colour)

"""Efforts and flows beside their bonds, where they touch nothing."""

from collections.abc import Iterator, Sequence

from bondgraph.drawing.bonds import flow_side
from bondgraph.drawing.marks import SMALLER
from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.rich import Rich
from bondgraph.drawing.shapes import QUIET, BondShape, Box, Label, Point

SIZE = SMALLER + 0.5

_SHARES = (0.5, 0.44, 0.56, 0.38, 0.62, 0.32, 0.68)
_AWAY = (3.0, 5.0)

Line = tuple[Point, Point]


class _Crowd:
    """What is drawn already: boxes and lines that a label must not touch."""

    def __init__(self, boxes: Sequence[Box], bonds: Sequence[BondShape]) -> None:
        self.boxes = list(boxes)
        self.lines = [line for bond in bonds for line in lines_of(bond)]

    def free(self, box: Box) -> bool:
        """True where the box touches nothing."""
        wide = box.grown(1.0)
        return not any(wide.overlaps(other) for other in self.boxes) and not any(
            wide.crossed(*line) for line in self.lines
        )


def lines_of(bond: BondShape) -> list[Line]:
    """All lines of a bond: its path, barb and stroke."""
    path = list(zip(bond.path, bond.path[1:], strict=False))
    return [*path, (bond.path[-1], bond.barb), *([bond.stroke] if bond.stroke else [])]


def power_labels(
    names: Sequence[tuple[Rich, Rich]], bonds: Sequence[BondShape], boxes: Sequence[Box]
) -> tuple[list[tuple[Label, ...]], bool]:
    """Effort over and flow under every bond, and whether all of them found a free place."""
    crowd = _Crowd(boxes, bonds)
    labels: list[tuple[Label, ...]] = []
    clean = True
    for (effort, flow), bond in zip(names, bonds, strict=True):
        own = []
        for rich, side in ((effort, -1.0), (flow, 1.0)):
            if not rich:
                continue
            candidates = list(_candidates(rich, bond, side))
            chosen = next((one for one in candidates if crowd.free(one.box)), None)
            clean = clean and chosen is not None
            own.append(chosen or candidates[0])
            crowd.boxes.append(own[-1].box)
        labels.append(tuple(own))
    return labels, clean


def _candidates(rich: Rich, bond: BondShape, side: float) -> Iterator[Label]:
    """Places of a label on one side of a bond's longest piece, the best first."""
    pieces = zip(bond.path, bond.path[1:], strict=False)
    first, last = max(
        pieces, key=lambda piece: abs(piece[1][0] - piece[0][0]) + abs(piece[1][1] - piece[0][1])
    )
    out = flow_side(first, last)
    wide, high = width(rich, SIZE), (ASCENT + DESCENT) * SIZE
    reach = (abs(out[0]) * wide + abs(out[1]) * high) / 2
    for away in _AWAY:
        for share in _SHARES:
            x = first[0] + share * (last[0] - first[0]) + side * out[0] * (reach + away)
            y = first[1] + share * (last[1] - first[1]) + side * out[1] * (reach + away)
            yield Label(rich, x - wide / 2, y - high / 2 + ASCENT * SIZE, SIZE, QUIET)

"""The whole picture: nodes, bonds and labels in their places, with a legend and a remark under them."""

import textwrap
from dataclasses import replace

from bondgraph.drawing.bonds import BARB_BACK, bond_shapes
from bondgraph.drawing.marks import SMALLER, moved
from bondgraph.drawing.metrics import width
from bondgraph.drawing.places import places
from bondgraph.drawing.powers import SIZE, lines_of, power_labels
from bondgraph.drawing.rich import Run, plain
from bondgraph.drawing.shapes import (
    INK,
    BondShape,
    Box,
    Label,
    NodeShape,
    Point,
    Scene,
    around,
)
from bondgraph.drawing.subject import Subject

MARGIN = 12.0
LEGEND = "dependent storage (derivative causality)"

_ROOMS = (1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0)


def scene(subject: Subject, title: str, powers: bool) -> Scene:
    """The picture; with ``powers`` as much wider as the labels need to lie free."""
    reach = _reach(subject) if powers else {}
    for room in _ROOMS[1 if powers else 0 :]:
        placed = places(subject, room, reach)
        nodes = [moved(placed.shapes[at], placed.at[at]) for at in range(len(subject.items))]
        bonds = bond_shapes(subject, placed, nodes)
        if not powers:
            break
        names = [(link.effort, link.flow) for link in subject.links]
        taken = [one.box for node in nodes for one in node.labels]
        taken += [node.frame for node in nodes if node.frame]
        labels, clean = power_labels(names, bonds, taken)
        bonds = tuple(replace(bond, labels=own) for bond, own in zip(bonds, labels, strict=True))
        if clean:
            break
    return _framed(subject, title, nodes, bonds)


def _reach(subject: Subject) -> dict[int, float]:
    """How long the bond of every one-port must be for its labels to lie beside it."""
    return {
        end: max(width(rich, SIZE) for rich in (link.effort, link.flow)) + 2 * BARB_BACK + 4
        for link in subject.links
        for end in (link.tail, link.head)
        if subject.items[end].one_port
    }


def _framed(
    subject: Subject, title: str, nodes: list[NodeShape], bonds: tuple[BondShape, ...]
) -> Scene:
    """The picture with its notes, moved so that it begins at (0, 0), in whole tenths."""
    points = [point for bond in bonds for line in lines_of(bond) for point in line]
    boxes = [node.box for node in nodes] + [one.box for bond in bonds for one in bond.labels]
    inner = around(boxes + [Box(x, y, x, y) for x, y in points])
    by = (MARGIN - inner.left, MARGIN - inner.top)
    bottom, right = inner.bottom + by[1], inner.right + by[0]
    notes, swatch = _notes(subject, bottom, right)
    taken = [note.box for note in notes]
    return Scene(
        title,
        description(subject),
        round(max([right, *(box.right for box in taken)]) + MARGIN),
        round(max([bottom, *(box.bottom for box in taken)]) + MARGIN),
        tuple(moved(node, by) for node in nodes),
        tuple(_shifted(bond, by) for bond in bonds),
        notes,
        swatch,
    )


def _notes(subject: Subject, bottom: float, right: float) -> tuple[tuple[Label, ...], Box | None]:
    """The legend and the remark, line by line under the picture."""
    y, lines, swatch = bottom + 2 * MARGIN, list[Label](), None
    if any(item.dependent for item in subject.items):
        swatch = Box(MARGIN, y - 8, MARGIN + 18, y + 2)
        lines.append(Label((Run(LEGEND),), MARGIN + 24, y, SMALLER, INK))
        y += 1.5 * SMALLER
    letters = max(round((right - MARGIN) / (0.6 * SMALLER)), 40)
    for line in textwrap.wrap(subject.remark, letters):
        lines.append(Label((Run(line),), MARGIN, y, SMALLER, INK))
        y += 1.5 * SMALLER
    return tuple(lines), swatch


def _shifted(bond: BondShape, by: Point) -> BondShape:
    def to(point: Point) -> Point:
        return (point[0] + by[0], point[1] + by[1])

    return replace(
        bond,
        path=tuple(map(to, bond.path)),
        barb=to(bond.barb),
        stroke=(to(bond.stroke[0]), to(bond.stroke[1])) if bond.stroke else None,
        labels=tuple(replace(one, x=one.x + by[0], y=one.y + by[1]) for one in bond.labels),
    )


def description(subject: Subject) -> str:
    """What the picture shows, in words: how many nodes of which kinds, and the dependent storages."""
    kinds: dict[str, int] = {}
    for item in subject.items:
        kinds[item.symbol] = kinds.get(item.symbol, 0) + 1
    counted = ", ".join(f"{count} {symbol}" for symbol, count in sorted(kinds.items()))
    text = f"A bond graph of {len(subject.items)} nodes ({counted}) and {len(subject.links)} bonds."
    dependent = [plain((Run(str(item.name)),)) for item in subject.items if item.dependent]
    if dependent:
        text += f" In derivative causality: {', '.join(dependent)}."
    return f"{text} {subject.remark}".strip()

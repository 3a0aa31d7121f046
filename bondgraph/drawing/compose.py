"""The whole picture: nodes, bonds and labels in their places, with a legend and a remark under them."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from bondgraph.drawing.arrange import Arranged, arranged, lies_across
from bondgraph.drawing.arrows import signal_shapes
from bondgraph.drawing.bonds import BARB_BACK, bond_shapes
from bondgraph.drawing.marks import SMALLER, moved
from bondgraph.drawing.metrics import width
from bondgraph.drawing.places import SHORT_BOND, Room
from bondgraph.drawing.powers import SIZE, lines_of, written
from bondgraph.drawing.rich import Run, plain
from bondgraph.drawing.shapes import INK, BondShape, Label, Scene, SignalShape
from bondgraph.drawing.subject import Link, Signal, Subject
from bondgraph.layout.boxes import Box, Point, around

Layout = Literal["horizontal", "vertical"]

MARGIN = 12.0
LEGEND = "dependent storage (derivative causality)"

_ROOMS = (1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0)


@dataclass(frozen=True)
class Writing:
    """What is written beside bonds, and which way layers follow; None: as the graph is best drawn."""

    powers: bool = False
    numbers: bool = False
    layout: Layout | None = None


def scene(subject: Subject, title: str, what: Writing) -> Scene:
    """The picture, as much wider as its texts and signals need to lie free."""
    upright = Room(1.0, False, {})
    plain_one = None if what.layout == "horizontal" else arranged(subject, upright)
    across = plain_one is None or (what.layout is None and lies_across(plain_one))
    numbers = width((Run(str(len(subject.links))),), SIZE) + 4 if what.numbers else 0.0
    beside = _reach(subject, across, numbers) if what.powers else {}
    along = _along(subject) + numbers if what.powers and across else SHORT_BOND
    for wide in _ROOMS[1 if what.powers else 0 :]:
        room = Room(wide, across, beside, along)
        found = plain_one if plain_one and room == upright else arranged(subject, room)
        bonds = bond_shapes(subject, found.paths, found.nodes)
        bonds, clean = written(subject.links, bonds, found.nodes, what.powers, what.numbers)
        signals, free = signal_shapes(subject, found.nodes, bonds, what.powers)
        if clean and free:
            break
    return _framed(subject, title, found, bonds, signals)


def _reach(subject: Subject, across: bool, numbers: float) -> dict[int, float]:
    """How long the bond of every one-port must be for its labels to lie beside it; across it is upright."""
    upright = SHORT_BOND + (1.5 * SIZE if numbers else 0.0)
    return {
        end: upright if across else _long(link) + numbers
        for link in subject.links
        for end in (link.tail, link.head)
        if subject.items[end].one_port
    }


def _along(subject: Subject) -> float:
    """How long bonds that lie across must be for all labels."""
    return max([SHORT_BOND, *(_long(link) for link in subject.links)])


def _long(link: Link) -> float:
    return max(width(rich, SIZE) for rich in (link.effort, link.flow)) + 2 * BARB_BACK + 4


def _framed(
    subject: Subject, title: str, found: Arranged, bonds: tuple[BondShape, ...],
    signals: tuple[SignalShape, ...],
) -> Scene:  # fmt: skip
    """The picture with its notes, moved so that it begins at (0, 0), in whole tenths."""
    drawn: list[BondShape | SignalShape] = [*bonds, *signals]
    points = [point for one in drawn for line in lines_of(one) for point in line]
    boxes = [node.box for node in found.nodes] + [one.box for it in drawn for one in it.labels]
    inner = around(boxes + [Box(x, y, x, y) for x, y in points])
    by = (MARGIN - inner.left, MARGIN - inner.top)
    bottom, right = inner.bottom + by[1], inner.right + by[0]
    notes, swatch = _notes(subject, _remarks(subject, signals), bottom, right)
    taken = [note.box for note in notes]
    return Scene(
        title,
        description(subject),
        round(max([right, *(box.right for box in taken)]) + MARGIN),
        round(max([bottom, *(box.bottom for box in taken)]) + MARGIN),
        tuple(moved(node, by) for node in found.nodes),
        tuple(_bond(bond, by) for bond in bonds),
        notes,
        swatch,
        tuple(_signal(signal, by) for signal in signals),
        found.order,
    )


def _remarks(subject: Subject, signals: Sequence[SignalShape]) -> list[str]:
    """What is written under the picture: why there are no strokes, and signals that found no way."""
    drawn = {(one.source, one.reader) for one in signals}
    items = subject.items
    lost = [
        one
        for one in subject.signals
        if (items[one.source].name, items[one.reader].name) not in drawn
    ]
    left_out = f"Signals without a line: {_told(subject, lost)}." if lost else ""
    return [line for line in (subject.remark, left_out) if line]


def _notes(
    subject: Subject, remarks: Sequence[str], bottom: float, right: float
) -> tuple[tuple[Label, ...], Box | None]:
    """The legend and the remarks, line by line under the picture."""
    y, lines, swatch = bottom + 2 * MARGIN, list[Label](), None
    if any(item.dependent for item in subject.items):
        swatch = Box(MARGIN, y - 8, MARGIN + 18, y + 2)
        lines.append(Label((Run(LEGEND),), MARGIN + 24, y, SMALLER, INK))
        y += 1.5 * SMALLER
    letters = max(round((right - MARGIN) / (0.6 * SMALLER)), 40)
    for line in (line for one in remarks for line in textwrap.wrap(one, letters)):
        lines.append(Label((Run(line),), MARGIN, y, SMALLER, INK))
        y += 1.5 * SMALLER
    return tuple(lines), swatch


def _bond(bond: BondShape, by: Point) -> BondShape:
    return replace(
        bond,
        path=tuple(_to(point, by) for point in bond.path),
        barb=_to(bond.barb, by),
        other=_to(bond.other, by) if bond.other else None,
        stroke=(_to(bond.stroke[0], by), _to(bond.stroke[1], by)) if bond.stroke else None,
        labels=_shifted(bond.labels, by),
    )


def _signal(signal: SignalShape, by: Point) -> SignalShape:
    return replace(
        signal,
        path=tuple(_to(point, by) for point in signal.path),
        barbs=(_to(signal.barbs[0], by), _to(signal.barbs[1], by)),
        labels=_shifted(signal.labels, by),
    )


def _shifted(labels: tuple[Label, ...], by: Point) -> tuple[Label, ...]:
    return tuple(replace(one, x=one.x + by[0], y=one.y + by[1]) for one in labels)


def _to(point: Point, by: Point) -> Point:
    return point[0] + by[0], point[1] + by[1]


def description(subject: Subject) -> str:
    """What the picture shows, in words: how many nodes of which kinds, and the dependent storages."""
    kinds: dict[str, int] = {}
    for item in subject.items:
        kinds[item.symbol] = kinds.get(item.symbol, 0) + 1
    counted = ", ".join(f"{count} {symbol}" for symbol, count in sorted(kinds.items()))
    text = f"A bond graph of {len(subject.items)} nodes ({counted}) and {len(subject.links)} bonds."
    if subject.signals:
        text += f" Signals: {_told(subject, subject.signals)}."
    dependent = [plain((Run(str(item.name)),)) for item in subject.items if item.dependent]
    if dependent:
        text += f" In derivative causality: {', '.join(dependent)}."
    return f"{text} {subject.remark}".strip()


def _told(subject: Subject, signals: Sequence[Signal]) -> str:
    """What reads what of which other, in words."""
    names = [plain((Run(str(item.name)),)) for item in subject.items]
    return "; ".join(
        f"{names[one.reader]} reads {plain(one.names)} of {names[one.source]}" for one in signals
    )

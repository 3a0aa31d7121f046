"""Labels of a node round its centre: symbol, value or name, and the frame of a dependent storage."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.rich import Rich, Run
from bondgraph.drawing.shapes import MARKED, QUIET, Label, NodeShape
from bondgraph.drawing.subject import Item
from bondgraph.layout.boxes import Box, Point, around

SIZE, SMALLER = 14.0, 9.5
"""Sizes of the elements' text, and of the names that explain."""

Side = Literal["left", "right", "middle"]
"""Where an element lies from its bond, its symbol next to the bond; across, left is above, right below."""

MIDDLE = 0.35
"""From the base line up to the middle of capitals and digits, of the size."""

_FRAME = 5.0

_CORNER = 7.5
"""From a bond's line to a name that stands beside it."""


_FARTHER = (0.0, 5.0, 10.0, 16.0, 24.0)

_APART = 1.5
"""Between an element and its name above or below it."""


def node_shape(item: Item, side: Side, caption: Side = "right", across: bool = False) -> NodeShape:
    """A node with the place where its bonds aim at (0, 0): the centre, or beside its bond the near end.

    ``caption``: the side on which a junction's name, or a transformer's ratio, stands. ``across``: layers
    follow from left to right, so what lies beside a junction lies above or below it.
    """
    if item.junction:
        labels = _below(item) if across else _junction(item, caption)
    elif across:
        labels = _across(item, side)
    elif item.kind.two_port:
        labels = _two_port(item, caption)
    else:
        labels = _element(item, side)
    if not item.dependent:
        return NodeShape(item.name, labels)
    by = {"left": -_FRAME, "right": _FRAME, "middle": 0.0}[side]
    dx, dy = (0.0, by) if across else (by, 0.0)
    labels = tuple(replace(one, x=one.x + dx, y=one.y + dy, colour=MARKED) for one in labels)
    frame = around([label.box for label in labels]).grown(_FRAME)
    return NodeShape(
        item.name, labels, Box(frame.left, frame.top + 2, frame.right, frame.bottom - 1)
    )


def moved(shape: NodeShape, to: Point) -> NodeShape:
    """The node with what was at (0, 0) at another place."""
    labels = tuple(replace(one, x=one.x + to[0], y=one.y + to[1]) for one in shape.labels)
    box = shape.frame
    if box is not None:
        box = Box(box.left + to[0], box.top + to[1], box.right + to[0], box.bottom + to[1])
    return replace(shape, labels=labels, frame=box)


def _junction(item: Item, caption: Side) -> tuple[Label, ...]:
    symbol = (Run(item.symbol),)
    half = width(symbol, SIZE) / 2
    own = Label(symbol, -half, SIZE * MIDDLE, SIZE)
    x = half + 4 if caption == "right" else -half - 4 - width(item.beside, SMALLER)
    return own, Label(item.beside, x, SMALLER * MIDDLE, SMALLER, QUIET)


def _below(item: Item) -> tuple[Label, ...]:
    """A junction between bonds to its left and right: its name stands below on the right."""
    symbol = (Run(item.symbol),)
    half = width(symbol, SIZE) / 2
    own = Label(symbol, -half, SIZE * MIDDLE, SIZE)
    return own, Label(item.beside, half + 4, _CORNER + ASCENT * SMALLER, SMALLER, QUIET)


def corners(shape: NodeShape) -> Iterator[NodeShape]:
    """The same junction with its name in every corner between upright and level bonds, then farther off."""
    symbol, name = shape.labels
    x, y = (symbol.box.left + symbol.box.right) / 2, symbol.y - SIZE * MIDDLE
    right = symbol.box.right + 4
    for off in _FARTHER:
        for left in (right, 2 * x - right - name.width):
            for line in (
                y + _CORNER + off + ASCENT * SMALLER,
                y - _CORNER - off - DESCENT * SMALLER,
            ):
                yield replace(shape, labels=(symbol, replace(name, x=left, y=line)))


def _across(item: Item, side: Side) -> tuple[Label, ...]:
    """``I: J`` over or under its bond, or in the middle of a row; its name on the far side."""
    text = (Run(item.symbol + ": "), *item.beside)
    wide, up, down = width(text, SIZE), ASCENT * SIZE, DESCENT * SIZE
    y = {"left": -down, "right": up, "middle": SIZE * MIDDLE}[side]
    own = Label(text, -wide / 2, y, SIZE)
    x = -width(item.caption, SMALLER) / 2
    far = own.box.bottom + ASCENT * SMALLER + _APART
    if side == "left":
        far = own.box.top - DESCENT * SMALLER - _APART
    return _captioned(own, item, x, far)


def _captioned(own: Label, item: Item, x: float, y: float) -> tuple[Label, ...]:
    return (own, Label(item.caption, x, y, SMALLER, QUIET)) if item.caption else (own,)


def _two_port(item: Item, caption: Side) -> tuple[Label, ...]:
    """The letters stand in the middle, the ratio beside them, the name behind it."""
    symbol, y = (Run(item.symbol),), SIZE * MIDDLE
    half = width(symbol, SIZE) / 2
    text: Rich = (Run(item.symbol + ": "), *item.beside)
    x = -half
    if caption == "left":
        text = (*item.beside, Run(" :" + item.symbol))
        x = half - width(text, SIZE)
    return _beside(Label(text, x, y, SIZE), item, caption)


def _element(item: Item, side: Side) -> tuple[Label, ...]:
    """``I: J`` right of its bond or in its middle, ``J :I`` left of it; its name below, or behind."""
    y = SIZE * MIDDLE
    text: Rich = (Run(item.symbol + ": "), *item.beside)
    if side == "left":
        text = (*item.beside, Run(" :" + item.symbol))
    wide = width(text, SIZE)
    own = Label(text, {"left": -wide, "right": 0.0, "middle": -wide / 2}[side], y, SIZE)
    if side == "middle":
        return _beside(own, item, "right")
    x = -width(item.caption, SMALLER) if side == "left" else 0.0
    return _captioned(own, item, x, own.box.bottom + ASCENT * SMALLER + _APART)


def _beside(own: Label, item: Item, side: Side) -> tuple[Label, ...]:
    """A label with the name behind it, or before it."""
    x = own.box.left - 6 - width(item.caption, SMALLER) if side == "left" else own.box.right + 6
    return _captioned(own, item, x, SMALLER * MIDDLE)

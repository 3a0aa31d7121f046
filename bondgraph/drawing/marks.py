"""Labels of a node round its centre: symbol, value or name, and the frame of a dependent storage."""

from dataclasses import replace
from typing import Literal

from bondgraph.drawing.metrics import width
from bondgraph.drawing.rich import Run
from bondgraph.drawing.shapes import MARKED, QUIET, Box, Label, NodeShape, Point, around
from bondgraph.drawing.subject import Item

SIZE, SMALLER = 14.0, 9.5
"""Sizes of the elements' text, and of the names that explain."""

Side = Literal["left", "right", "middle"]
"""Where an element lies from its bond: its symbol is next to the bond."""

_MIDDLE = 0.35
"""From the base line up to the middle of capitals and digits, of the size."""

_FRAME = 5.0


def node_shape(item: Item, side: Side, caption: Side = "right") -> NodeShape:
    """A node with the place where its bonds aim at (0, 0): the centre, or beside its bond the near end.

    ``caption``: the side on which a junction's name, or a transformer's ratio, stands.
    """
    if item.junction:
        labels = _junction(item, caption)
    elif item.kind.two_port:
        labels = _two_port(item, caption)
    else:
        labels = _element(item, side)
    if not item.dependent:
        return NodeShape(item.name, labels)
    shift = {"left": -_FRAME, "right": _FRAME, "middle": 0.0}[side]
    labels = tuple(replace(label, x=label.x + shift, colour=MARKED) for label in labels)
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
    return NodeShape(shape.name, labels, box)


def _junction(item: Item, caption: Side) -> tuple[Label, ...]:
    symbol = (Run(item.symbol),)
    half = width(symbol, SIZE) / 2
    own = Label(symbol, -half, SIZE * _MIDDLE, SIZE)
    x = half + 4 if caption == "right" else -half - 4 - width(item.beside, SMALLER)
    return own, Label(item.beside, x, SMALLER * _MIDDLE, SMALLER, QUIET)


def _two_port(item: Item, caption: Side) -> tuple[Label, ...]:
    """The letters stand in the middle, the ratio beside them."""
    symbol, y = (Run(item.symbol),), SIZE * _MIDDLE
    half = width(symbol, SIZE) / 2
    if caption == "left":
        text = (*item.beside, Run(" :" + item.symbol))
        return (Label(text, half - width(text, SIZE), y, SIZE),)
    return (Label((Run(item.symbol + ": "), *item.beside), -half, y, SIZE),)


def _element(item: Item, side: Side) -> tuple[Label, ...]:
    """``I: J`` right of its bond or in its middle, ``J :I`` left of it."""
    y = SIZE * _MIDDLE
    if side == "left":
        text = (*item.beside, Run(" :" + item.symbol))
        return (Label(text, -width(text, SIZE), y, SIZE),)
    text = (Run(item.symbol + ": "), *item.beside)
    return (Label(text, 0.0 if side == "right" else -width(text, SIZE) / 2, y, SIZE),)

"""Bonds between placed nodes: half arrows and causal strokes that touch no label."""

import math
from collections.abc import Sequence

from bondgraph.drawing.ends import HALF_STROKE
from bondgraph.drawing.shapes import BondShape, NodeShape
from bondgraph.drawing.subject import Link, Subject
from bondgraph.layout.boxes import Box, Point

BARB_BACK, BARB_OUT = 9.0, 5.0
"""How far the barb of a half arrow reaches back along the bond, and aside."""

_FULL = (9.0, 3.5)
"""The same of the full arrow of a bond that carries no power."""

_STEP, _MOST, _FREE = 1.5, 30.0, 1.5
"""An end gives way to labels in such steps, so far at most, and keeps so far from them."""


def bond_shapes(
    subject: Subject, paths: Sequence[tuple[Point, ...]], nodes: Sequence[NodeShape]
) -> tuple[BondShape, ...]:
    """Every bond as it is drawn along its points."""
    shapes = []
    for link, path in zip(subject.links, paths, strict=True):
        near = [nodes[link.tail], nodes[link.head]]
        boxes = [label.box.grown(_FREE) for node in near for label in node.labels]
        boxes += [node.frame.grown(_FREE) for node in near if node.frame]
        shapes.append(_shape(subject, link, path, boxes))
    return tuple(shapes)


def barbs(head: Point, before: Point, back: float, out: float) -> tuple[Point, Point]:
    """Where the barbs of a full arrow end: on the side of the flow, and on the other."""
    along, (x, y) = _unit(head, before), flow_side(before, head)
    middle = (head[0] + back * along[0], head[1] + back * along[1])
    return (
        (middle[0] + out * x, middle[1] + out * y),
        (middle[0] - out * x, middle[1] - out * y),
    )


def flow_side(first: Point, last: Point) -> Point:
    """The unit normal on the side of the flow: below flat bonds, right of steep ones."""
    dx, dy = last[0] - first[0], last[1] - first[1]
    long = math.hypot(dx, dy) or 1.0
    normal = (-dy / long, dx / long)
    turned = normal[1] < 0 if abs(dx) >= abs(dy) else normal[0] < 0
    return (-normal[0], -normal[1]) if turned else normal


def _shape(subject: Subject, link: Link, path: tuple[Point, ...], boxes: list[Box]) -> BondShape:
    at_head = None if link.receiver is None else link.receiver == link.head
    count = 2 if link.active else 1
    head = _given_way(path[-1], path[-2], boxes, count, stroked=at_head is True)
    tail = _given_way(path[0], path[1], boxes, 0, stroked=at_head is False)
    path = (tail, *path[1:-1], head)
    names = [subject.items[end].name for end in (link.tail, link.head)]
    stroke, receiver = None, None
    if link.receiver is not None:
        stroke = _stroke(head, path[-2]) if at_head else _stroke(tail, path[1])
        receiver = subject.items[link.receiver].name
    barb, other = barbs(head, path[-2], *_FULL) if link.active else (_barb(head, path[-2]), None)
    return BondShape(link.declared, names[0], names[1], path, barb, stroke, receiver, other=other)


def _given_way(end: Point, before: Point, boxes: list[Box], count: int, stroked: bool) -> Point:
    """The end drawn back along the bond until what is drawn there touches none of the boxes.

    ``count``: of the barbs there.
    """
    back = _unit(end, before)
    room = min(_MOST, math.dist(end, before) - 3 * BARB_BACK)
    for step in range(max(int(room / _STEP), 0) + 1):
        at = (end[0] + step * _STEP * back[0], end[1] + step * _STEP * back[1])
        lines = [(at, before)]
        lines += [(at, one) for one in barbs(at, before, BARB_BACK, BARB_OUT)[:count]]
        lines += [_stroke(at, before)] if stroked else []
        if not any(box.crossed(*line) for box in boxes for line in lines):
            return at
    return end


def _barb(head: Point, before: Point) -> Point:
    """Where the half arrow's barb ends."""
    return barbs(head, before, BARB_BACK, BARB_OUT)[0]


def _stroke(end: Point, inside: Point) -> tuple[Point, Point]:
    """The causal stroke across a bond's end."""
    x, y = flow_side(inside, end)
    (left, top), by = end, HALF_STROKE
    return (left - by * x, top - by * y), (left + by * x, top + by * y)


def _unit(first: Point, last: Point) -> Point:
    long = math.dist(first, last) or 1.0
    return ((last[0] - first[0]) / long, (last[1] - first[1]) / long)

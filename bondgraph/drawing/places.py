"""Where every node lies: columns that keep long chains straight and mirror images alike, and rows."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from types import MappingProxyType

import networkx as nx

from bondgraph.drawing.columns import columns_of, leaning
from bondgraph.drawing.layers import Layers, layered
from bondgraph.drawing.marks import Side, node_shape
from bondgraph.drawing.order import Order, faced, mirrored, ordered
from bondgraph.drawing.shapes import NodeShape, Point
from bondgraph.drawing.subject import Subject

BAND = 18.0
"""A bond that passes a layer is upright so far above and below its middle."""

NODE_GAP, SIDE_BOND, LAYER_GAP, CLEAR = 26.0, 44.0, 66.0, 6.0
"""Least room between nodes of a layer, length of a bond to the side, distance of layers, room at ends."""

STEEPEST = 0.34
"""A bond falls at least this much for its width, so that it does not run into its layer."""


@dataclass(frozen=True)
class Places:
    """Every node's shape and the place it is aimed at; ``bends``: of a bond between two layers."""

    at: Mapping[int, Point]
    shapes: Mapping[int, NodeShape]
    sides: Mapping[int, Side]
    bends: Mapping[tuple[int, int], tuple[Point, ...]]


@dataclass(frozen=True)
class _Cell:
    """A vertex with what lies beside it: shapes by item and their offsets, and the whole extent."""

    shapes: Mapping[int, tuple[NodeShape, float, Side]]
    left: int
    right: int


def places(subject: Subject, room: float, reach: Mapping[int, float]) -> Places:
    """The nodes placed, ``room`` times as far apart as plain bonds need.

    ``reach``: how long the bond of a one-port beside its junction must be, at least.
    """
    found = layered(subject)
    order = faced(ordered(found.graph, found.layers))
    lengths = {
        item: max(SIDE_BOND, reach.get(item, 0.0)) for own in found.beside.values() for item in own
    }
    lean = dict.fromkeys(found.graph, 0)
    cells, bends = _cells(subject, found, lean, lengths), len(subject.items)
    columns = columns_of(found.graph, order, _extents(cells), bends, NODE_GAP * room)
    kinds = {vertex: _kind(subject, found, vertex) for vertex in found.graph}
    for _ in range(2):
        order = mirrored(found.graph, order, leaning(found.graph, order, columns), kinds)
        columns = columns_of(found.graph, order, _extents(cells), bends, NODE_GAP * room)
        lean = leaning(found.graph, order, columns)
        cells = _cells(subject, found, lean, lengths)
        columns = columns_of(found.graph, order, _extents(cells), bends, NODE_GAP * room)
    rows = _rows(found.graph, order, columns, room)
    at: dict[int, Point] = {}
    shapes: dict[int, NodeShape] = {}
    sides: dict[int, Side] = {}
    for vertex, cell in cells.items():
        for item, (shape, offset, side) in cell.shapes.items():
            at[item] = (columns[vertex] + offset, rows[vertex])
            shapes[item], sides[item] = shape, side
    turns = {
        ends: tuple((columns[bend], rows[bend] + by) for bend in path[1:-1] for by in (-BAND, BAND))
        for ends, path in found.paths.items()
    }
    return Places(
        MappingProxyType(at),
        MappingProxyType(shapes),
        MappingProxyType(sides),
        MappingProxyType(turns),
    )


def _extents(cells: Mapping[int, _Cell]) -> dict[int, tuple[int, int]]:
    return {vertex: (cell.left, cell.right) for vertex, cell in cells.items()}


def _kind(subject: Subject, found: Layers, vertex: int) -> str:
    """The symbols of a node and of what lies beside it."""
    if vertex >= len(subject.items):
        return ""
    return " ".join(subject.items[at].symbol for at in (vertex, *found.beside.get(vertex, ())))


def _cells(
    subject: Subject, found: Layers, lean: Mapping[int, int], lengths: Mapping[int, float]
) -> dict[int, _Cell]:
    cells = {}
    for vertex in found.graph:
        if vertex >= len(subject.items):
            cells[vertex] = _Cell(MappingProxyType({}), 2, 2)
        else:
            cells[vertex] = _cell(
                subject, vertex, found.beside.get(vertex, ()), lean[vertex], lengths
            )
    return cells


def _cell(
    subject: Subject, node: int, beside: tuple[int, ...], lean: int, lengths: Mapping[int, float]
) -> _Cell:
    """A node with the one-ports beside it; the first of these is on the side it leans to."""
    first: Side = "left" if lean < 0 else "right"
    second: Side = "right" if lean < 0 else "left"
    caption = second if len(beside) == 1 or (lean < 0 and not beside) else "right"
    if not beside:
        caption = first
    shape = node_shape(subject.items[node], "middle", caption)
    shapes: dict[int, tuple[NodeShape, float, Side]] = {node: (shape, 0.0, "middle")}
    left, right = shape.box.left, shape.box.right
    for item, side in zip(beside, (first, second), strict=False):
        own = node_shape(subject.items[item], side)
        if side == "right":
            offset = shape.box.right + lengths[item] + 2 * CLEAR
            right = offset + own.box.right
        else:
            offset = shape.box.left - lengths[item] - 2 * CLEAR
            left = offset + own.box.left
        shapes[item] = (own, offset, side)
    if lean == 0 and not beside:
        left, right = min(left, -right), max(right, -left)
    return _Cell(MappingProxyType(shapes), ceil(-left), ceil(right))


def _rows(
    graph: "nx.DiGraph[int]", order: Order, columns: Mapping[int, float], room: float
) -> dict[int, float]:
    rows: dict[int, float] = {}
    y = 0.0
    for layer in order:
        wide = max(
            (abs(columns[v] - columns[u]) for v in layer for u in graph.predecessors(v)), default=0
        )
        if rows:
            y += max(LAYER_GAP * room, min(STEEPEST * wide, 3 * LAYER_GAP))
        rows.update(dict.fromkeys(layer, round(y)))
    return rows

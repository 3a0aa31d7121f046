"""Where every node lies: columns that keep long chains straight and mirror images alike, and rows."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import networkx as nx

from bondgraph.drawing.layers import Layers, layered
from bondgraph.drawing.marks import Side, node_shape
from bondgraph.drawing.order import Order, faced, mirrored, ordered
from bondgraph.drawing.shapes import NodeShape, Point
from bondgraph.drawing.subject import Subject
from bondgraph.drawing.tight import extremes

BAND = 18.0
"""A bond that passes a layer is upright so far above and below its middle."""

NODE_GAP, SIDE_BOND, LAYER_GAP, CLEAR = 26.0, 44.0, 66.0, 6.0
"""Least room between nodes of a layer, length of a bond to the side, distance of layers, room at ends."""

FAN = (0.0, 30.0, 70.0, 120.0, 180.0, 250.0, 350.0, 500.0, 700.0)
"""From each of these widths on, a bond's width counts once more."""

STRAIGHT = 64.0
"""What the width of a bond counts that should be straight."""

STEEPEST = 0.34
"""A bond falls at least this much for its width, so that it does not run into its layer."""


@dataclass(frozen=True)
class Places:
    """Every node's shape and the place it is aimed at; ``bends``: of a bond between two layers."""

    at: dict[int, Point]
    shapes: dict[int, NodeShape]
    sides: dict[int, Side]
    bends: dict[tuple[int, int], tuple[Point, ...]]


@dataclass(frozen=True)
class _Cell:
    """A vertex with what lies beside it: shapes by item and their offsets, and the whole extent."""

    shapes: dict[int, tuple[NodeShape, float, Side]]
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
    cells = _cells(subject, found, lean, lengths)
    columns = _columns(found.graph, order, cells, room)
    kinds = {vertex: _kind(subject, found, vertex) for vertex in found.graph}
    for _ in range(2):
        order = mirrored(found.graph, order, _leaning(found.graph, order, columns), kinds)
        columns = _columns(found.graph, order, cells, room)
        lean = _leaning(found.graph, order, columns)
        cells = _cells(subject, found, lean, lengths)
        columns = _columns(found.graph, order, cells, room)
    rows = _rows(found.graph, order, columns, room)
    at: dict[int, Point] = {}
    shapes: dict[int, NodeShape] = {}
    sides: dict[int, Side] = {}
    for vertex, cell in cells.items():
        for item, (shape, offset, side) in cell.shapes.items():
            at[item] = (columns[vertex] + offset, rows[vertex])
            shapes[item], sides[item] = shape, side
    bends = {
        ends: tuple((columns[bend], rows[bend] + by) for bend in path[1:-1] for by in (-BAND, BAND))
        for ends, path in found.paths.items()
    }
    return Places(at, shapes, sides, bends)


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
            cells[vertex] = _Cell({}, 2, 2)
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
    return _Cell(shapes, ceil(-left), ceil(right))


def _columns(
    graph: "nx.DiGraph[int]", order: Order, cells: Mapping[int, _Cell], room: float
) -> dict[int, float]:
    """The middle of the best columns: chains straight, others as short as they can be."""
    vertices = [vertex for layer in order for vertex in layer]
    number = {vertex: at for at, vertex in enumerate(vertices)}
    bends = min((at for at, cell in cells.items() if not cell.shapes), default=max(cells) + 1)
    sizes = {
        vertex: 1 + sum(one < bends for one in nx.descendants(graph, vertex)) for vertex in graph
    }
    gap = ceil(NODE_GAP * room)
    gaps = [
        (number[one], number[two], float(cells[one].right + gap + cells[two].left))
        for layer in order
        for one, two in pairwise(layer)
    ]
    pulls = [
        (number[u], number[v], weight, free)
        for u, v in graph.edges
        for weight, free in _weights(graph, sizes, bends, u, v)
    ]
    low, high = extremes(len(vertices), gaps, pulls)
    return {vertex: (low[at] + high[at]) / 2 for vertex, at in number.items()}


def _weights(
    graph: "nx.DiGraph[int]", sizes: Mapping[int, int], bends: int, upper: int, lower: int
) -> list[tuple[float, float]]:
    """Bends, chains and what leads to most of the graph are kept straight; in a fan wide bonds weigh more.

    A small branch keeps to its place more than a large one. ``bends``: from this vertex on.
    """
    bent = (upper >= bends) + (lower >= bends)
    if bent:
        return [(STRAIGHT / 4 if bent == 2 else STRAIGHT / 16, 0.0)]
    if graph.in_degree(lower) == 1 and _leading(graph, sizes, upper) == lower:
        return [(STRAIGHT, 0.0)]
    weight = max(1.0, 8.0 // sizes[lower])
    if _leading(graph, sizes, upper) is not None:
        weight /= 2
    return [(weight, free) for free in FAN]


def _leading(graph: "nx.DiGraph[int]", sizes: Mapping[int, int], upper: int) -> int | None:
    """The vertex below that leads to much more of the graph than the others do, if there is one."""
    first, *rest = sorted(graph.successors(upper), key=lambda one: -sizes[one])
    return first if not rest or sizes[first] > 1.5 * sizes[rest[0]] else None


def _leaning(
    graph: "nx.DiGraph[int]", order: Order, columns: Mapping[int, float]
) -> dict[int, int]:
    """The side to which a vertex lies from those above it, or they from theirs: -1, 0 or 1.

    One with nothing above it leans away from those below.
    """
    lean: dict[int, int] = {}
    for layer in order:
        for vertex in layer:
            above = list(graph.predecessors(vertex))
            near = above or list(graph.successors(vertex)) or [vertex]
            off = columns[vertex] - sum(columns[one] for one in near) / len(near)
            if abs(off) > 0.5:
                lean[vertex] = 1 if off > 0 else -1
            else:
                total = sum(lean[one] for one in above)
                lean[vertex] = (total > 0) - (total < 0)
    return lean


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

"""Where every node of one connected part lies: columns that keep chains straight, and rows.

All is reckoned with layers from top to bottom. For a picture from left to right, shapes come in with
across and down exchanged, and places and paths are exchanged back.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from types import MappingProxyType

import networkx as nx

from bondgraph.drawing.layers import Layers, layered
from bondgraph.drawing.marks import Side, node_shape
from bondgraph.drawing.shapes import NodeShape
from bondgraph.drawing.subject import Subject
from bondgraph.layout.boxes import Box, Point
from bondgraph.layout.columns import columns_of, leaning
from bondgraph.layout.order import Order, faced, mirrored, ordered

BAND = 18.0
"""A bond that passes a layer is upright so far above and below its middle, at least."""

NODE_GAP, SIDE_BOND, LAYER_GAP, CLEAR = 26.0, 44.0, 66.0, 6.0
"""Least room between nodes of a layer, length of a bond to the side, distance of layers, room at ends."""

SHORT_BOND, OUTER_GAP = 40.0, 18.0
"""From left to right: the least length of bonds, and the room between what lies above nodes."""

_AT_TEXT = 2.0
"""Text ends nearer to its sides than to what is above and below it: so much more room is left there."""

_LEAN = 0.15
"""How much of its way aside a bond that is led round labels goes in its first layer."""

STEEPEST = 0.34
"""A bond falls at least this much for its width, so that it does not run into its layer."""


@dataclass(frozen=True)
class Room:
    """How much room there is: ``wide`` times as much between nodes as plain bonds need.

    ``beside``: how long the bond of a one-port beside its junction must be, at least; ``along``: the
    least length of other bonds in a picture from left to right (``across``).
    """

    wide: float
    across: bool
    beside: Mapping[int, float]
    along: float = SHORT_BOND


@dataclass(frozen=True)
class Places:
    """Every node's shape and the place it is aimed at; ``bends``: of a bond between two layers.

    ``at`` and ``bends`` have layers from top to bottom; shapes are as they are drawn, round (0, 0).
    """

    at: Mapping[int, Point]
    shapes: Mapping[int, NodeShape]
    sides: Mapping[int, Side]
    bends: Mapping[tuple[int, int], tuple[Point, ...]]
    layers: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class _Cell:
    """A vertex with what lies beside it: shapes by item and their offsets, and the whole extent.

    ``above`` and ``below``: how far the vertex reaches towards other layers; ``over`` and ``under`` with
    what lies beside it.
    """

    shapes: Mapping[int, tuple[NodeShape, float, Side]]
    left: int
    right: int
    above: float = 0.0
    below: float = 0.0
    over: float = 0.0
    under: float = 0.0


def places(subject: Subject, room: Room) -> Places:
    """The nodes of a connected graph, placed."""
    found = layered(subject)
    order = faced(ordered(found.graph, found.layers))
    lean = dict.fromkeys(found.graph, 0)
    cells = _cells(subject, found, lean, room)
    solved: dict[object, dict[int, float]] = {}

    def columns_now() -> dict[int, float]:
        """The best columns for the order and the cells as they are; what was asked before is known."""
        extents = _extents(cells)
        asked = (tuple(map(tuple, order)), tuple(extents.items()))
        if asked not in solved:
            gap = NODE_GAP * room.wide
            solved[asked] = columns_of(found.graph, order, extents, len(subject.items), gap)
        return solved[asked]

    columns = columns_now()
    kinds = {vertex: _kind(subject, found, vertex) for vertex in found.graph}
    for _ in range(2):
        order = mirrored(found.graph, order, leaning(found.graph, order, columns), kinds)
        columns = columns_now()
        lean = leaning(found.graph, order, columns)
        cells = _cells(subject, found, lean, room)
        columns = columns_now()
    rows, bands = _rows(found.graph, order, columns, cells, room)
    at: dict[int, Point] = {}
    shapes: dict[int, NodeShape] = {}
    sides: dict[int, Side] = {}
    for vertex, cell in cells.items():
        for item, (shape, offset, side) in cell.shapes.items():
            at[item] = (columns[vertex] + offset, rows[vertex])
            shapes[item], sides[item] = shape, side
    turns = {}
    for ends, path in found.paths.items():
        passed = [(columns[one], rows[one] + by) for one in path[1:-1] for by in bands[one]]
        if room.across:
            passed = _led_out(path, passed, columns, rows, bands)
        turns[ends] = tuple(passed)
    return Places(
        MappingProxyType(at),
        MappingProxyType(shapes),
        MappingProxyType(sides),
        MappingProxyType(turns),
        tuple(map(tuple, order)),
    )


def _led_out(
    path: tuple[int, ...], passed: list[Point], columns: Mapping[int, float],
    rows: Mapping[int, float], bands: Mapping[int, tuple[float, float]],
) -> list[Point]:  # fmt: skip
    """A bond's points with those at the borders of its first and last layers, past all that lies there.

    They lean to where the bond goes, so that bonds of one node stay apart.
    """
    first, last = path[0], path[-1]
    by = min(max(_LEAN * (columns[last] - columns[first]), -BAND), BAND)
    begin = (columns[first] + by, rows[first] + bands[first][1])
    return [begin, *passed, (columns[last] - by, rows[last] + bands[last][0])]


def as_reckoned(shape: NodeShape, across: bool, junction: bool) -> Box:
    """What a node fills where layers are reckoned from top to bottom.

    Across, a junction's name lies beside its bonds, and is none of what they end at.
    """
    if not across:
        return shape.box
    box = (shape.labels[0].box if junction else shape.box).turned
    return box if junction else Box(box.left, box.top - _AT_TEXT, box.right, box.bottom + _AT_TEXT)


def _extents(cells: Mapping[int, _Cell]) -> dict[int, tuple[int, int]]:
    return {vertex: (cell.left, cell.right) for vertex, cell in cells.items()}


def _kind(subject: Subject, found: Layers, vertex: int) -> str:
    """The symbols of a node and of what lies beside it."""
    if vertex >= len(subject.items):
        return ""
    return " ".join(subject.items[at].symbol for at in (vertex, *found.beside.get(vertex, ())))


def _cells(
    subject: Subject, found: Layers, lean: Mapping[int, int], room: Room
) -> dict[int, _Cell]:
    cells = {}
    for vertex in found.graph:
        if vertex >= len(subject.items):
            cells[vertex] = _Cell(MappingProxyType({}), 2, 2)
        else:
            cells[vertex] = _cell(subject, vertex, found.beside.get(vertex, ()), lean[vertex], room)
    return cells


def _cell(subject: Subject, node: int, beside: tuple[int, ...], lean: int, room: Room) -> _Cell:
    """A node with the one-ports beside it; the first of these is on the side it leans to."""
    first: Side = "left" if lean < 0 or (room.across and lean == 0) else "right"
    second: Side = "right" if first == "left" else "left"
    caption = second if len(beside) == 1 or (lean < 0 and not beside) else "right"
    if not beside:
        caption = first
    if room.across:
        caption = "right"
    item = subject.items[node]
    shape = node_shape(item, "middle", caption, room.across)
    core = as_reckoned(shape, room.across, item.junction)
    whole = shape.box.turned if room.across else shape.box
    shapes: dict[int, tuple[NodeShape, float, Side]] = {node: (shape, 0.0, "middle")}
    left, right, over, under = whole.left, whole.right, -whole.top, whole.bottom
    for one, side in zip(beside, (first, second), strict=False):
        own = node_shape(subject.items[one], side, across=room.across)
        box = own.box.turned if room.across else own.box
        reach = max(SIDE_BOND if not room.across else SHORT_BOND, room.beside.get(one, 0.0))
        if side == "right":
            offset = core.right + reach + 2 * CLEAR
            right = max(right, offset + box.right)
        else:
            offset = core.left - reach - 2 * CLEAR
            left = min(left, offset + box.left)
        over, under = max(over, -box.top), max(under, box.bottom)
        shapes[one] = (own, offset, side)
    if lean == 0 and not beside:
        left, right = min(left, -right), max(right, -left)
    return _Cell(
        MappingProxyType(shapes), ceil(-left), ceil(right), -core.top, core.bottom, over, under
    )


def _rows(
    graph: "nx.DiGraph[int]", order: Order, columns: Mapping[int, float],
    cells: Mapping[int, _Cell], room: Room,
) -> tuple[dict[int, float], dict[int, tuple[float, float]]]:  # fmt: skip
    """Every vertex's row, and from where to where a bond that passes its layer keeps upright."""
    rows: dict[int, float] = {}
    bands: dict[int, tuple[float, float]] = {}
    y, last = 0.0, list[int]()
    for layer in order:
        wide = max(
            (abs(columns[v] - columns[u]) for v in layer for u in graph.predecessors(v)), default=0
        )
        if rows:
            apart = LAYER_GAP * room.wide
            if room.across:
                apart = max(
                    apart, _apart([cells[v] for v in last], [cells[v] for v in layer], room)
                )
            y += max(apart, min(STEEPEST * wide, 3 * LAYER_GAP))
        rows.update(dict.fromkeys(layer, round(y)))
        band = (-BAND, BAND)
        if room.across:
            band = (
                min(-BAND, -CLEAR - max(cells[v].over for v in layer)),
                max(BAND, CLEAR + max(cells[v].under for v in layer)),
            )
        bands.update(dict.fromkeys(layer, band))
        last = layer
    return rows, bands


def _apart(upper: list[_Cell], lower: list[_Cell], room: Room) -> float:
    """From layer to layer across: as long as bonds must be, and so that nothing beside nodes touches."""
    core = max(cell.below for cell in upper) + max(cell.above for cell in lower)
    outer = max(cell.under for cell in upper) + max(cell.over for cell in lower)
    return max(core + 2 * CLEAR + room.along * room.wide, outer + OUTER_GAP * room.wide)

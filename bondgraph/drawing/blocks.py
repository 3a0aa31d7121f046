"""Nodes of signals as blocks: a frame with the name and what it does, in columns that follow the signals."""

from collections.abc import Sequence

import networkx as nx

from bondgraph.drawing.marks import MIDDLE, SIZE, SMALLER, moved
from bondgraph.drawing.metrics import ASCENT, DESCENT, width
from bondgraph.drawing.places import Room
from bondgraph.drawing.shapes import QUIET, Label, NodeShape
from bondgraph.drawing.subject import Item, Subject
from bondgraph.layout.boxes import Box
from bondgraph.layout.order import ordered

COLUMN_GAP, ROW_GAP = 46.0, 26.0
"""Between columns of blocks, and between blocks of one column."""

_INNER = (9.0, 5.0)
"""From a block's text to its frame, aside and up or down."""

_LINE, _APART = 1.3 * SMALLER, 1.0
"""From line to line of what a block does, and from its name to the first."""


def block_shape(item: Item) -> NodeShape:
    """The block, its middle at (0, 0): the name, and small below it what the node does."""
    high = SIZE + _LINE * len(item.lines)
    top = -high / 2
    first = top + SIZE / 2 + SIZE * MIDDLE
    labels = [Label(item.beside, -width(item.beside, SIZE) / 2, first, SIZE)]
    below = first + DESCENT * SIZE + _APART
    for at, rich in enumerate(item.lines):
        x = -width(rich, SMALLER) / 2
        labels.append(Label(rich, x, below + ASCENT * SMALLER + at * _LINE, SMALLER, QUIET))
    wide = max(label.width for label in labels) / 2 + _INNER[0]
    bottom = max(label.box.bottom for label in labels) + _INNER[1]
    box = Box(-wide, labels[0].box.top - _INNER[1], wide, bottom)
    centre = (0.0, -(box.top + box.bottom) / 2)
    return moved(NodeShape(item.name, tuple(labels), box, block=True), centre)


def placed_blocks(subject: Subject, blocks: Sequence[int], room: Room) -> list[NodeShape]:
    """The blocks in their places: each in a column after what it reads, as near to what reads it."""
    flow = _flow(subject, blocks)
    layers = _layers(flow)
    order = ordered(flow, layers)
    shapes = {at: block_shape(subject.items[at]) for at in blocks}
    boxes = {at: shape.box for at, shape in shapes.items()}
    gap = ROW_GAP * room.wide
    heights = [sum(boxes[at].bottom - boxes[at].top + gap for at in column) for column in order]
    x, found = 0.0, dict[int, NodeShape]()
    for column, high in zip(order, heights, strict=True):
        wide = max(boxes[at].right - boxes[at].left for at in column)
        y = (max(heights) - high) / 2
        for at in column:
            found[at] = moved(shapes[at], (round(x + wide / 2), round(y - boxes[at].top)))
            y += boxes[at].bottom - boxes[at].top + gap
        x += wide + COLUMN_GAP * room.wide
    return [found[at] for at in blocks]


def _flow(subject: Subject, blocks: Sequence[int]) -> "nx.DiGraph[int]":
    """The signals from block to block, those that close a cycle left out."""
    graph: nx.DiGraph[int] = nx.DiGraph()
    graph.add_nodes_from(blocks)
    graph.add_edges_from(
        (one.source, one.reader)
        for one in subject.signals
        if one.source in graph and one.reader in graph
    )
    place = {node: at for at, node in enumerate(reversed([*nx.dfs_postorder_nodes(graph)]))}
    graph.remove_edges_from([(a, b) for a, b in graph.edges if place[a] >= place[b]])
    return graph


def _layers(flow: "nx.DiGraph[int]") -> list[list[int]]:
    """Every block in the column after the last of what it reads, but next to the first that reads it."""
    ranks: dict[int, int] = {}
    order = list(nx.lexicographical_topological_sort(flow))
    for node in order:
        ranks[node] = max((ranks[one] + 1 for one in flow.predecessors(node)), default=0)
    for node in reversed(order):
        if flow.out_degree(node) and not flow.in_degree(node):
            ranks[node] = min(ranks[one] for one in flow.successors(node)) - 1
    layers: list[list[int]] = [[] for _ in range(max(ranks.values()) + 1)]
    for node in flow:
        layers[ranks[node]].append(node)
    return [layer for layer in layers if layer]

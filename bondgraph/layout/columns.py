"""Columns: chains straight, fans even, mirror images alike; and the sides to which vertices lean."""

from collections.abc import Mapping
from itertools import pairwise
from math import ceil

import networkx as nx

from bondgraph.layout.order import Order
from bondgraph.layout.tight import extremes

FAN = (0.0, 30.0, 70.0, 120.0, 180.0, 250.0, 350.0, 500.0, 700.0)
"""From each of these widths on, a bond's width counts once more."""

STRAIGHT = 64.0
"""What the width of a bond counts that should be straight."""


def columns_of(
    graph: "nx.DiGraph[int]",
    order: Order,
    extents: Mapping[int, tuple[int, int]],
    bends: int,
    gap: float,
) -> dict[int, float]:
    """The middle of the best columns: chains straight, others as short as they can be.

    ``extents``: how far every vertex reaches left and right; ``bends``: vertices from this one on are bends.
    """
    vertices = [vertex for layer in order for vertex in layer]
    number = {vertex: at for at, vertex in enumerate(vertices)}
    sizes = {
        vertex: 1 + sum(one < bends for one in nx.descendants(graph, vertex)) for vertex in graph
    }
    gaps = [
        (number[one], number[two], float(extents[one][1] + ceil(gap) + extents[two][0]))
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


def leaning(graph: "nx.DiGraph[int]", order: Order, columns: Mapping[int, float]) -> dict[int, int]:
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

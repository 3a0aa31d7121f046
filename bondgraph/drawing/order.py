"""The order of the vertices in every layer: few crossings, by barycentres and exchanges of neighbours."""

from bisect import bisect_right, insort
from collections.abc import Sequence

import networkx as nx

SWEEPS = 16

Order = list[list[int]]
"""The layers, each from left to right."""


def ordered(graph: "nx.DiGraph[int]", layers: Sequence[Sequence[int]]) -> Order:
    """The layers with their vertices in an order of few crossings, like the given one where free."""
    now = [list(layer) for layer in layers]
    best = [list(layer) for layer in now]
    least = crossings(graph, best)
    for sweep in range(SWEEPS):
        _sweep(graph, now, down=sweep % 2 == 0)
        _exchange(graph, now)
        count = crossings(graph, now)
        if count < least:
            best, least = [list(layer) for layer in now], count
        if least == 0:
            break
    return best


def crossings(graph: "nx.DiGraph[int]", order: Sequence[Sequence[int]]) -> int:
    """How many pairs of bonds cross."""
    return sum(
        _between(graph, upper, lower) for upper, lower in zip(order, order[1:], strict=False)
    )


def _between(graph: "nx.DiGraph[int]", upper: Sequence[int], lower: Sequence[int]) -> int:
    place = {vertex: at for at, vertex in enumerate(lower)}
    count, seen = 0, list[int]()
    for vertex in upper:
        ends = [place[head] for head in graph.successors(vertex) if head in place]
        count += sum(len(seen) - bisect_right(seen, end) for end in ends)
        for end in ends:
            insort(seen, end)
    return count


def _sweep(graph: "nx.DiGraph[int]", order: Order, down: bool) -> None:
    """Sort each layer by the mean place of its neighbours in the one before."""
    numbers = range(1, len(order)) if down else range(len(order) - 2, -1, -1)
    for number in numbers:
        fixed = order[number - 1 if down else number + 1]
        place = {vertex: at for at, vertex in enumerate(fixed)}
        keys: dict[int, float] = {}
        for at, vertex in enumerate(order[number]):
            near = graph.predecessors(vertex) if down else graph.successors(vertex)
            places = [place[other] for other in near]
            keys[vertex] = sum(places) / len(places) if places else at
        order[number].sort(key=keys.__getitem__)


def _exchange(graph: "nx.DiGraph[int]", order: Order) -> None:
    """Exchange neighbours in a layer as long as that saves crossings."""
    saved = True
    while saved:
        saved = False
        for number, layer in enumerate(order):
            near = order[max(number - 1, 0) : number + 2]
            for at in range(len(layer) - 1):
                before = crossings(graph, near)
                layer[at], layer[at + 1] = layer[at + 1], layer[at]
                if crossings(graph, near) < before:
                    saved = True
                else:
                    layer[at], layer[at + 1] = layer[at + 1], layer[at]

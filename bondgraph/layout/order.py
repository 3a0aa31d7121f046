"""The order of the vertices in every layer: few crossings, by barycentres and exchanges of neighbours."""

import random
from bisect import bisect_right, insort
from collections.abc import Mapping, Sequence
from itertools import pairwise

import networkx as nx

STARTS, SWEEPS = 10, 8

Order = list[list[int]]
"""The layers, each from left to right."""


def ordered(graph: "nx.DiGraph[int]", layers: Sequence[Sequence[int]]) -> Order:
    """The layers with their vertices in an order of few crossings, like the given one where free."""
    best = [list(layer) for layer in layers]
    least = crossings(graph, best)
    dice = random.Random(0)  # always the same starts
    for start in range(STARTS):
        now = [list(layer) for layer in layers]
        for layer in now if start else ():
            dice.shuffle(layer)
        for sweep in range(SWEEPS):
            if least == 0:
                return best
            _sweep(graph, now, down=sweep % 2 == 0)
            _exchange(graph, now)
            count = crossings(graph, now)
            if count < least:
                best, least = [list(layer) for layer in now], count
    return best


def faced(order: Order) -> Order:
    """The order or its mirror image, whichever has more of the lower numbers on the left."""
    rising = sum(
        (one < two) - (one > two)
        for layer in order
        for at, one in enumerate(layer)
        for two in layer[at + 1 :]
    )
    return order if rising >= 0 else [layer[::-1] for layer in order]


def crossings(graph: "nx.DiGraph[int]", order: Sequence[Sequence[int]]) -> int:
    """How many pairs of bonds cross."""
    return sum(_between(graph, upper, lower) for upper, lower in pairwise(order))


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
    place = {vertex: at for layer in order for at, vertex in enumerate(layer)}
    saved = True
    while saved:
        saved = False
        for layer in order:
            for at in range(len(layer) - 1):
                one, two = layer[at], layer[at + 1]
                if _saving(graph, place, one, two) > 0:
                    layer[at], layer[at + 1] = two, one
                    place[one], place[two] = at + 1, at
                    saved = True


def _saving(graph: "nx.DiGraph[int]", place: Mapping[int, int], one: int, two: int) -> int:
    """How many crossings fewer there are with the second of two neighbours before the first."""
    return sum(
        (place[far] > place[near]) - (place[far] < place[near])
        for sides in (graph.pred, graph.succ)
        for far in sides[one]
        for near in sides[two]
    )


def mirrored(
    graph: "nx.DiGraph[int]", order: Order, lean: Mapping[int, int], kinds: Mapping[int, str]
) -> Order:
    """The order with twigs turned to make the halves images of each other, if that crosses no more.

    A twig is a vertex whose bonds lead on to vertices of its own alone, or one that has no bond above
    and one below. ``lean``: the side on which a vertex lies; ``kinds``: what tells twigs apart.
    """
    now = [list(layer) for layer in order]
    for number, layer in enumerate(now):
        for twigs, side in _twigs(graph, now, number, lean):
            slots = [at for at, vertex in enumerate(layer) if vertex in twigs]
            twigs = [layer[at] for at in slots]
            twigs.sort(key=lambda twig: _bough(graph, twig, kinds), reverse=side < 0)
            for slot, twig in zip(slots, twigs, strict=True):
                layer[slot] = twig
    _sweep(graph, now, down=True)
    return now if crossings(graph, now) <= crossings(graph, order) else order


def _twigs(
    graph: "nx.DiGraph[int]", order: Order, number: int, lean: Mapping[int, int]
) -> list[tuple[list[int], int]]:
    """Groups of a layer's vertices that may change places with each other, and the side they are on."""
    groups: list[tuple[list[int], int]] = []
    for parent in order[number - 1] if number else []:
        own = [one for one in graph.successors(parent) if _free(graph, one)]
        groups.append((own, lean[parent]))
    for child in order[number + 1] if number + 1 < len(order) else []:
        above = list(graph.predecessors(child))
        own = [one for one in above if graph.in_degree(one) == 0 and graph.out_degree(one) == 1]
        others = [one for one in above if one not in own]
        if own and len(others) == 1 and graph.out_degree(others[0]) == 1:
            groups.append(([*own, *others], lean[others[0]]))
    return [(own, side) for own, side in groups if side and len(own) > 1]


def _free(graph: "nx.DiGraph[int]", vertex: int) -> bool:
    below = nx.descendants(graph, vertex)
    return all(graph.in_degree(one) == 1 for one in {vertex, *below})


def _bough(graph: "nx.DiGraph[int]", vertex: int, kinds: Mapping[int, str]) -> tuple[object, ...]:
    """What a twig consists of: a key that is the same for its mirror image."""
    own = sorted(kinds[one] for one in {vertex, *nx.descendants(graph, vertex)})
    return graph.in_degree(vertex) == 0, own

"""Mason's rule: loops of gain, those that touch, and the determinant of a graph of signals."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice

import networkx as nx
import sympy as sp

from bondgraph.errors import StructureError

MOST_PATHS = 200
"""Of more paths or loops a list is nothing to read."""

MOST_SETS = 20_000
"""Sets of loops that are looked at for one determinant."""


@dataclass(frozen=True)
class Way:
    """Signals in a row, each following from the one before, and the product of the gains."""

    signals: tuple[int, ...]
    gain: sp.Expr


def ways(graph: "nx.DiGraph[int]", start: int, end: int) -> tuple[Way, ...]:
    """All ways from one signal to another that come to no signal twice, short ones first."""
    if start == end:
        return (Way((start,), sp.Integer(1)),)
    useful = (nx.descendants(graph, start) | {start}) & (nx.ancestors(graph, end) | {end})
    if end not in useful:
        return ()
    found = nx.all_simple_paths(graph.subgraph(sorted(useful)), start, end)
    return _sorted([_way(graph, path, closed=False) for path in _few(found, "paths")])


def circles(graph: "nx.DiGraph[int]") -> tuple[Way, ...]:
    """All loops that come to no signal twice, each from its first signal on, short ones first."""
    found = []
    for loop in _few(nx.simple_cycles(graph), "loops"):
        at = loop.index(min(loop))
        found.append(_way(graph, [*loop[at:], *loop[:at]], closed=True))
    return _sorted(found)


def determinant(loops: Sequence[Way]) -> sp.Expr:
    """``1 - sum L + sum L L - ...`` over sets of loops of which no two have a signal in common."""
    members = [frozenset(loop.signals) for loop in loops]
    touching = [
        sum(1 << other for other, those in enumerate(members) if own & those) for own in members
    ]
    found: dict[int, sp.Expr] = {0: sp.Integer(1)}

    def over(left: int) -> sp.Expr:
        if left not in found:
            if len(found) > MOST_SETS:
                raise StructureError(
                    f"{len(loops)} loops touch each other in too many ways for Mason's rule; take "
                    "linearize(...).transfer_function()"
                )
            first = (left & -left).bit_length() - 1
            without = over(left & ~(1 << first))
            found[left] = without - loops[first].gain * over(left & ~touching[first])
        return found[left]

    return over((1 << len(loops)) - 1)


def transfer(paths: Sequence[Way], loops: Sequence[Way]) -> tuple[sp.Expr, sp.Expr]:
    """Mason's numerator and denominator: ``sum P D_P`` and D, D_P of the loops that P does not touch."""
    total = sp.Integer(0)
    for path in paths:
        on = set(path.signals)
        apart = [loop for loop in loops if not on & set(loop.signals)]
        total += path.gain * determinant(apart)
    return total, determinant(loops)


def _way(graph: "nx.DiGraph[int]", signals: list[int], closed: bool) -> Way:
    after = [*signals[1:], signals[0]] if closed else signals[1:]
    # The last signal of a path has none after it.
    gains = [graph.edges[a, b]["gain"] for a, b in zip(signals, after, strict=False)]
    return Way(tuple(signals), sp.Mul(*gains))


def _few(found: Iterable[list[int]], what: str) -> list[list[int]]:
    listed = list(islice(found, MOST_PATHS + 1))
    if len(listed) > MOST_PATHS:
        raise StructureError(
            f"there are more than {MOST_PATHS} {what}, too many for Mason's rule; merge the graph, look at a "
            "part of it, or take linearize(...).transfer_function()"
        )
    return listed


def _sorted(found: list[Way]) -> tuple[Way, ...]:
    return tuple(sorted(found, key=lambda way: (len(way.signals), way.signals)))

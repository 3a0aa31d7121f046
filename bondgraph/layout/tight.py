"""Numbers that keep their distances and lie as close together as they can."""

from collections.abc import Sequence

import networkx as nx

Gap = tuple[int, int, float]
"""The second number is at least this much more than the first."""

Pull = tuple[int, int, float, float]
"""The distance between two numbers counts this much, beyond a distance that is free."""

_SLACK = 1e-6


def extremes(count: int, gaps: Sequence[Gap], pulls: Sequence[Pull]) -> tuple[list[int], list[int]]:
    """Of all the best numbers the least and the greatest, with the first number at 0.

    The weighted sum of distances is least. The best solutions form a lattice, so both extremes are
    unique, and whole for whole gaps. The gaps must have a solution. Numbers that no pulls connect with the
    first, as of signals that rule no bond, lie as close to it as the gaps let them.
    """
    if count == 1:
        return [0], [0]
    pulls = [*pulls, *((0, apart, 1.0, 0.0) for apart in _apart(count, pulls))]
    import numpy as np
    from scipy.optimize import linprog
    from scipy.sparse import csr_array

    entries: list[tuple[int, int, float]] = []
    limits: list[float] = []

    def at_most(row: Sequence[tuple[int, float]], limit: float) -> None:
        entries.extend((len(limits), column, value) for column, value in row)
        limits.append(limit)

    for first, second, gap in gaps:
        at_most([(first, 1), (second, -1)], -gap)
    for at, (first, second, _, free) in enumerate(pulls):
        at_most([(first, 1), (second, -1), (count + at, -1)], free)
        at_most([(second, 1), (first, -1), (count + at, -1)], free)
    size = count + len(pulls)
    cost = np.zeros(size)
    cost[count:] = [weight for _, _, weight, _ in pulls]
    bounds = [(0, 0)] + [(None, None)] * (count - 1) + [(0, None)] * len(pulls)

    def least(objective: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> "list[float]":
        rows, columns, values = zip(*entries, strict=True)
        matrix = csr_array((values, (rows, columns)), shape=(len(limits), size))
        found = linprog(  # type: ignore[call-overload]  # its stubs know dense matrices only
            objective, matrix, limits, bounds=bounds, method="highs"
        )
        return [float(value) for value in found.x]

    best = float(cost @ np.array(least(cost)))
    at_most([(at, value) for at, value in enumerate(cost.tolist()) if value], best + _SLACK)
    total = np.zeros(size)
    total[:count] = 1.0
    low, high = (least(sign * total)[:count] for sign in (1.0, -1.0))
    return [round(value) for value in low], [round(value) for value in high]


def _apart(count: int, pulls: Sequence[Pull]) -> list[int]:
    """The first number of each set that pulls connect, but of the one that has the first of all."""
    joined: nx.Graph[int] = nx.Graph()
    joined.add_nodes_from(range(count))
    joined.add_edges_from((first, second) for first, second, *_ in pulls)
    return [min(numbers) for numbers in nx.connected_components(joined) if 0 not in numbers]

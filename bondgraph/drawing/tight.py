"""Numbers that keep their distances and lie as close together as they can."""

from collections.abc import Sequence

Gap = tuple[int, int, float]
"""The second number is at least this much more than the first."""

Pull = tuple[int, int, float, float]
"""The distance between two numbers counts this much, beyond a distance that is free."""

_SLACK = 1e-6


def extremes(count: int, gaps: Sequence[Gap], pulls: Sequence[Pull]) -> tuple[list[int], list[int]]:
    """Of all the best numbers the least and the greatest, with the first number at 0.

    The weighted sum of distances is least. The best solutions form a lattice, so both extremes are
    unique, and whole for whole gaps. The pulls must connect all numbers and the gaps have a solution.
    """
    if count == 1:
        return [0], [0]
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

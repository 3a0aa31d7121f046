"""Looking up in tables: polynomials between breaks, found by bisection; slopes are theirs.

A table is ``(breaks, degree, outside, coefficients)``: its breaks along each axis, and for each cell, those
along the last axis in turn, the factors of ``(x - x_i)**p * (y - y_j)**q``, highest powers first. C has the
same in model_table.c. What is turned round is looked into by `backward`.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence

Patches = tuple[tuple[tuple[float, ...], ...], int, str, tuple[float, ...]]
"""Breaks along each axis, degree, what is beyond the ends, factors."""

BACK = "⁻¹"
"""How the method and the name of a table that is turned round end, which no declared one's do."""

FREE = -1
"""In place of a region: an argument is wherever it is."""


def looked_up(
    table: Patches,
    orders: Sequence[int],
    places: Sequence[float],
    regions: Sequence[float] = (FREE, FREE),
) -> float:
    """The value at these arguments, or its derivative of these orders along them.

    ``regions``: for each argument the stretch between corners whose polynomials are taken, beyond that,
    too; `FREE` for the one in which it is.
    """
    breaks, degree, outside, coefficients = table
    cell, level = 0, False
    inside: list[float] = []
    for knots, order, x, region in zip(breaks, orders, places, regions, strict=False):
        at, u, held = placed(knots, degree, outside, x, region)
        cell = cell * (len(knots) - 1) + at
        level = level or (held and order > 0)
        inside.append(u)
    if any(math.isnan(u) for u in inside):
        return math.nan
    if level:
        return 0.0
    size = degree + 1
    first = cell * size ** len(breaks)
    if len(breaks) == 1:
        return polynomial(coefficients[first : first + size], orders[0], inside[0])
    rows = [coefficients[k : k + size] for k in range(first, first + size * size, size)]
    return polynomial([polynomial(row, orders[1], inside[1]) for row in rows], orders[0], inside[0])


def placed(
    knots: Sequence[float], degree: int, outside: str, x: float, region: float
) -> tuple[int, float, bool]:
    """The cell along one axis, the distance from its beginning, and whether the end's value is held."""
    last, ends = len(knots) - 2, outside != "extend"
    if ends:
        free, refused = region == FREE, outside == "refuse"
        nothing = math.nan if refused else 0.0 * x
        top = last + 2
        # On its end a table that refuses what is beyond still has a value, on whichever side of it.
        if (free or region < 1) and (x < knots[0] or not (free or refused)):
            return 0, nothing, True
        if (free or region >= top) and (x > knots[-1] or not (free or refused)):
            return last, knots[-1] - knots[-2] + nothing, True
    if region != FREE:
        at = min(max(int(region) - ends, 0), last)
    else:
        at = min(max(bisect_right(knots, x) - 1, 0), last)
    return at, x - knots[at], False


def polynomial(factors: Sequence[float], order: int, u: float) -> float:
    """The derivative of an order of a polynomial, its highest power first."""
    total = 0.0
    for power, factor in zip(range(len(factors) - 1, order - 1, -1), factors, strict=False):
        total = total * u + math.perm(power, order) * factor
    return total

"""Tables cell by cell: where their polynomials meet, and which one an argument is in, as an expression."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.errors import SimulationError
from bondgraph.tables.looking import FREE, placed
from bondgraph.tables.pieces import Points, pieces
from codegen.numbers.arrays import Array

ASIDE = (3 - 5**0.5) / 2
"""So far inside a stretch, of its length, nothing that is symmetric has its extremes."""


def breaks_along(look: Look, axis: int) -> list[sp.Rational]:
    """Where one polynomial takes over from another along an axis."""
    return [sp.Rational(repr(at)) for at in pieces(look.handle.table)[0][axis]]


def polynomial_at(look: Look, places: Sequence[float]) -> sp.Expr:
    """The expression that a table is about arguments of these values; nan where it has none.

    >>> from bondgraph.algebra.lookup_table import LookupTable
    >>> polynomial_at(LookupTable("map", [0, 1, 2], [0, 3, 4])("t"), [1.5])
    t + 2
    """
    breaks, degree, outside, factors = pieces(look.handle.table)
    cell, inside = 0, []
    for knots, place, value in zip(breaks, look.places, places, strict=True):
        at, u, held = placed(knots, degree, outside, value, FREE)
        if u != u:
            return sp.nan
        cell = cell * (len(knots) - 1) + at
        inside.append(sp.Rational(repr(u)) if held else place - sp.Rational(repr(knots[at])))
    count, size = len(breaks), degree + 1
    local = [sp.Dummy() for _ in breaks]
    found = sp.Integer(0)
    for k, factor in enumerate(factors[cell * size**count : (cell + 1) * size**count]):
        powers = [degree - k // size ** (count - 1 - axis) % size for axis in range(count)]
        found += sp.Rational(repr(factor)) * sp.Mul(
            *(u**p for u, p in zip(local, powers, strict=True))
        )
    for u, order in zip(local, look.handle.orders, strict=True):
        found = sp.diff(found, u, order) if order else found
    level = {u for u, part in zip(local, inside, strict=True) if part.is_Number}
    if any(u in level and order for u, order in zip(local, look.handle.orders, strict=True)):
        return sp.Integer(0)
    return sp.expand(found.xreplace(dict(zip(local, inside, strict=True))))


def polynomials_between(
    look: Look, points: Sequence[float], values: Callable[[sp.Expr, Array], Array]
) -> list[sp.Expr]:
    """The same over the time, between each two of these points [s], where no argument comes over a break.

    ``values``: those of an argument at times. Raises `SimulationError` where a table has none.
    """
    # In the middle an argument may touch a break without crossing it.
    times = np.array([a + ASIDE * (b - a) for a, b in pairwise(points)])
    places = [values(place, times).tolist() for place in look.places]
    found = [polynomial_at(look, row) for row in zip(*places, strict=True)]
    if sp.nan in found:
        at, name = points[found.index(sp.nan)], look.handle.table.name
        raise SimulationError(
            f"{look} leaves table {name!r}, which refuses what is outside, at t = {at:.9g} s"
        )
    return found


def cells(look: Look) -> list[float]:
    """The narrowest cell along each axis."""
    return [min(b - a for a, b in pairwise(axis)) for axis in pieces(look.handle.table)[0]]


def steepest(table: Points) -> float:
    """A bound on the slope of a table over one axis between its ends."""
    (knots,), degree, _, factors = pieces(table)
    if degree < 0:
        widths = [b - a for a, b in pairwise(table.values)]
        slopes = [factors[4 * at : 4 * at + 3] for at in range(len(widths))]
        return 1.0 / min(map(_flattest, slopes, widths))
    size, found = degree + 1, 0.0
    for at, (a, b) in enumerate(pairwise(knots)):
        powers = factors[at * size : (at + 1) * size]
        terms = zip(range(degree, 0, -1), powers, strict=False)
        found = max(found, sum(p * abs(factor) * (b - a) ** (p - 1) for p, factor in terms))
    return found


def _flattest(powers: Sequence[float], width: float) -> float:
    """The least slope, of either sign, that a cubic without turns has over a width from zero on."""
    c3, c2, c1 = powers
    bottom = -c2 / (3 * c3) if c3 else 0.0
    inside = [bottom] if min(0.0, width) < bottom < max(0.0, width) else []
    return min(abs((3 * c3 * u + 2 * c2) * u + c1) for u in (0.0, width, *inside))

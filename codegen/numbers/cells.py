"""Tables cell by cell: where their polynomials meet, and which one an argument is in, as an expression."""

from collections.abc import Sequence
from itertools import pairwise

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.tables.looking import FREE, placed
from bondgraph.tables.pieces import pieces
from codegen.numbers.arrays import Array


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


def polynomials_at(look: Look, values: Sequence[Array]) -> list[sp.Expr]:
    """The same at each of many values of the arguments."""
    return [polynomial_at(look, row) for row in zip(*(one.tolist() for one in values), strict=True)]


def cells(look: Look) -> list[float]:
    """The narrowest cell along each axis."""
    return [min(b - a for a, b in pairwise(axis)) for axis in pieces(look.handle.table)[0]]


def steepest(look: Look) -> float:
    """A bound on the slope of a table over one axis between its ends."""
    (knots,), degree, _, factors = pieces(look.handle.table)
    size, found = degree + 1, 0.0
    for at, (a, b) in enumerate(pairwise(knots)):
        powers = factors[at * size : (at + 1) * size]
        terms = zip(range(degree, 0, -1), powers, strict=False)
        found = max(found, sum(p * abs(factor) * (b - a) ** (p - 1) for p, factor in terms))
    return found

"""How many real roots an expression of one name has: exactly where it is rational, else by bounds."""

from dataclasses import dataclass
from itertools import pairwise

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import SimulationError
from codegen.inputs.branches import crossings, known, smooth_parts
from codegen.tuning import TUNING

DIGITS = 40
"""Of coefficients that are no rationals; roots closer than the rounding of half as many count as one."""

ENDS = (-100.0, -10.0, -1.0, 1.0, 10.0, 100.0)
"""Roots of what is no rational function are looked for in each stretch between two of these."""

NONE = (SimulationError, ArithmeticError, KeyError, NotImplementedError, TypeError, ValueError)
"""What is raised where an expression has no real value, or a function is not known: by its fourth name sympy
tells that it knows none; nothing of this module waits to be written."""


@dataclass(frozen=True)
class Roots:
    """How many real roots were found, and which; ``within``: the stretch that was looked at, if not all.

    No ``values``: there is no end of them.
    """

    count: int
    values: tuple[float, ...]
    within: tuple[float, float] | None = None


def roots_of(expr: sp.Expr, name: sp.Symbol) -> Roots | None:
    """The distinct real roots; None where nothing can be told.

    >>> x = sp.Symbol("x")
    >>> roots_of(x - x**2 + 2, x)
    Roots(count=2, values=(-1.0, 2.0), within=None)
    >>> roots_of(x - 2*sp.sin(x), x).count
    3
    """
    if expr.free_symbols != {name} or expr.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        return None
    if expr.is_rational_function(name):
        return _of_fraction(expr, name)
    expr = expr.xreplace({name: TIME})
    return _of_parts(expr) if known(expr) else None


def _of_fraction(expr: sp.Expr, name: sp.Symbol) -> Roots | None:
    """By Sturm's theorem, of the numerator when common factors are out."""
    above = sp.Poly(sp.fraction(sp.cancel(sp.together(expr)))[0], name)
    given = above.all_coeffs()
    if not all(c.is_real for c in given):
        return None
    exact = all(c.is_Rational for c in given)
    coefficients = given if exact else [sp.Rational(str(sp.N(c, DIGITS))) for c in given]
    polynomial = sp.Poly(coefficients, name, domain="QQ").sqf_part()
    places = [_middle(*pair) for pair, _ in polynomial.intervals(eps=sp.Rational(1, 10**20))]
    if not exact and any(b - a < TUNING.together * (abs(a) + abs(b)) for a, b in pairwise(places)):
        return None
    return Roots(len(places), tuple(places))


def _middle(a: sp.Rational, b: sp.Rational) -> float:
    return float((a + b) / 2)


def _of_parts(expr: sp.Expr) -> Roots:
    """Changes of sign of an analytic expression of ``t``, or of one with corners; a touch is not seen."""
    found: list[float] = []
    parts = [part for a, b in pairwise(ENDS) for part in _parts(expr, a, b)]
    if any(part == 0 for _, _, part in parts):
        return Roots(2, (), (ENDS[0], ENDS[-1]))
    for a, b, part in parts:
        found += [place for place in _crossings(part, a, b) if _changes(part, part, place)]
    for (_, end, left), (begin, _, right) in pairwise(parts):
        if begin == end and _changes(left, right, end):
            found.append(end)
    values = [b for a, b in pairwise([2 * ENDS[0], *sorted(found)]) if b - a > 10 * TUNING.beside]
    return Roots(len(values), tuple(values), (ENDS[0], ENDS[-1]))


def _parts(expr: sp.Expr, begin: float, end: float) -> list[tuple[float, float, sp.Expr]]:
    """The smooth parts in a stretch; none where the expression has no values all along it."""
    try:
        parts = smooth_parts(expr, begin, end)
    except NONE:
        return []
    ends = [*(a for a, _ in parts[1:]), end]
    return [(a, b, part) for (a, part), b in zip(parts, ends, strict=True)]


def _crossings(expr: sp.Expr, begin: float, end: float) -> list[float]:
    try:
        return crossings(expr, begin, end)
    except NONE:
        return []


def _changes(left: sp.Expr, right: sp.Expr, place: float) -> bool:
    """Whether the sign changes across a place by way of zero, not by a jump or a pole: with many digits."""
    at, off = sp.Rational(place), sp.Rational(TUNING.beside)
    pairs = ((left, at - off), (right, at + off), (left, at), (right, at))
    a, b, *middle = (sp.N(part.subs(TIME, where), DIGITS) for part, where in pairs)
    if not (a.is_real and b.is_real and all(value.is_real for value in middle)):
        return False
    return bool(a * b < 0 and max(map(abs, middle)) <= TUNING.pole * (abs(a) + abs(b)))

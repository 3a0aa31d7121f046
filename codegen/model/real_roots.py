"""How many real roots an expression of one name has: exactly where it is rational, else by bounds."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import mpmath
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import SimulationError
from codegen.inputs.branches import crossings, known, smooth_parts
from codegen.tuning import TUNING

Exact = Callable[[mpmath.mpf], mpmath.mpf]

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
    expr = _numbers_told(expr.xreplace({name: TIME}))
    return _of_parts(expr) if known(expr) else None


def _numbers_told(expr: sp.Expr) -> sp.Expr:
    """With what is a number, but no rational one, by its digits: terms that differ in it alone become one."""
    told: dict[sp.Basic, sp.Basic] = {}
    left = [expr]
    while left:
        part = left.pop()
        if not isinstance(part, sp.Expr) or not part.is_number:
            left += part.args
        elif not part.is_Rational:
            told[part] = sp.N(part, DIGITS)
    return expr.xreplace(told)


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
    values = [_with_digits(part) for _, _, part in parts]
    for (a, b, part), value in zip(parts, values, strict=True):
        found += [place for place in _crossings(part, a, b) if _changes(value, value, place)]
    for k, ((_, end, _), (begin, _, _)) in enumerate(pairwise(parts)):
        if begin == end and _changes(values[k], values[k + 1], end):
            found.append(end)
    roots = [b for a, b in pairwise([2 * ENDS[0], *sorted(found)]) if b - a > 10 * TUNING.beside]
    return Roots(len(roots), tuple(roots), (ENDS[0], ENDS[-1]))


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


def _with_digits(part: sp.Expr) -> Exact:
    """The function of an expression of ``t`` in numbers of `DIGITS` digits."""
    found: Exact = sp.lambdify(TIME, part, "mpmath", cse=True)
    return found


def _changes(left: Exact, right: Exact, place: float) -> bool:
    """Whether the sign changes across a place by way of zero, not by a jump or a pole: with many digits."""
    with mpmath.workdps(DIGITS):
        at, off = mpmath.mpf(place), mpmath.mpf(TUNING.beside)
        try:
            sides = a, b = left(at - off), right(at + off)
            middle = left(at), right(at)
        except NONE:
            return False
        if any(mpmath.im(one) or not mpmath.isfinite(one) for one in (*sides, *middle)):
            return False
        return bool(a * b < 0 and max(map(abs, middle)) <= TUNING.pole * (abs(a) + abs(b)))

"""Laws with corners as stretches without: where each corner lies, and what the law is between two."""

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp
from sympy.core.relational import Ge, Gt, Le, Lt

from bondgraph.inverses.rising import rising, sign_of
from bondgraph.inverses.undoing import affine_undone, undone

CORNERS = (sp.Abs, sp.sign, sp.Heaviside, sp.Max, sp.Min, sp.Piecewise)
"""What is one of several expressions, as something is above zero or below."""

MOST = 16
"""Stretches of one law."""


@dataclass(frozen=True)
class Stretch:
    """A law between two places, of which None is where it goes on without end; ``needed``: positive names."""

    low: sp.Expr | None
    high: sp.Expr | None
    law: sp.Expr
    needed: frozenset[sp.Symbol] = frozenset()


class _NotTold(Exception):
    """It is not shown on which side of a corner a stretch is."""


def stretches(law: sp.Expr, x: sp.Symbol) -> list[Stretch] | None:
    """The law on each side of each of its corners, in order; None where their places are not told.

    Each has to be where something rises or falls through zero that can be undone, in an order that all
    positive parameters give.

    >>> q, k, c = sp.symbols("q k c")
    >>> for one in stretches(k*q + c*sp.Max(q - 1, 0), q):
    ...     print(one.low, one.high, one.law)
    None 1 k*q
    1 None c*(q - 1) + k*q
    """
    try:
        return _split(Stretch(None, None, law), x)
    except _NotTold:
        return None


def _split(of: Stretch, x: sp.Symbol, depth: int = 0) -> list[Stretch]:
    corner = next(_innermost(of.law), None)
    if corner is None:
        return [of]
    if depth > 4 * MOST:
        raise _NotTold
    size = _size(corner)
    way = _side(size, x, of)
    if way is not None:
        sign, needed = way
        law = of.law.xreplace({corner: _on_side(corner, size, sign)})
        return _split(Stretch(of.low, of.high, law, of.needed | needed), x, depth + 1)
    place, needed = _zero(size, x, of)
    needed |= of.needed
    parts = Stretch(of.low, place, of.law, needed), Stretch(place, of.high, of.law, needed)
    found = [one for part in parts for one in _split(part, x, depth + 1)]
    if len(found) > MOST:
        raise _NotTold
    return found


def _innermost(law: sp.Expr) -> Iterator[sp.Expr]:
    """What has a corner, and none inside, in one order."""
    found = sorted(law.atoms(*CORNERS), key=sp.default_sort_key)
    return (one for one in found if not any(part.has(*CORNERS) for part in one.args))


def _size(corner: sp.Expr) -> sp.Expr:
    """What is above zero on one side, and below on the other."""
    if isinstance(corner, sp.Max | sp.Min):
        first, second, *_ = corner.args
        return first - second
    if isinstance(corner, sp.Piecewise):
        compared = sorted(corner.args[0].cond.atoms(Gt, Ge, Lt, Le), key=sp.default_sort_key)
        if not compared:
            raise _NotTold
        return compared[0].lhs - compared[0].rhs
    return corner.args[0]


def _on_side(corner: sp.Expr, size: sp.Expr, sign: int) -> sp.Expr:
    """A corner where its size is of this sign: less by that corner."""
    if isinstance(corner, sp.Max | sp.Min):
        first, second, *others = corner.args
        upper = isinstance(corner, sp.Max) == (sign > 0)
        return corner.func(first if upper else second, *others)
    if isinstance(corner, sp.Piecewise):
        told = {
            one: sp.true if (sign > 0) == isinstance(one, Gt | Ge) else sp.false
            for one in corner.atoms(Gt, Ge, Lt, Le)
            if one.lhs - one.rhs == size
        }
        return corner.xreplace(told)
    if isinstance(corner, sp.Abs):
        return sign * size
    return sp.Integer(sign) if isinstance(corner, sp.sign) else sp.Integer(sign > 0)


def _side(size: sp.Expr, x: sp.Symbol, of: Stretch) -> tuple[int, frozenset[sp.Symbol]] | None:
    """The sign of a size all over a stretch, zero at its ends being of either; None where it has none."""
    for told in seen_from_ends(size, x, of.low, of.high):
        sign, needed = sign_of(told, x)
        if sign is not None:
            return (1 if sign >= 0 else -1), needed
    return None


ONWARD = sp.Dummy("y", nonnegative=True)
"""How far a place is from the end of a stretch."""


def seen_from_ends(
    expr: sp.Expr, x: sp.Symbol, low: sp.Expr | None, high: sp.Expr | None
) -> list[sp.Expr]:
    """An expression over how far `ONWARD` a place is from either end of a stretch; as it is without ends."""
    ends = [low + ONWARD] if low is not None else []
    ends += [high - ONWARD] if high is not None else []
    return [sp.expand(expr.xreplace({x: end})) for end in ends] or [expr]


def _zero(size: sp.Expr, x: sp.Symbol, of: Stretch) -> tuple[sp.Expr, frozenset[sp.Symbol]]:
    """Where a size passes zero inside a stretch, and what has to be positive for that."""
    zero = sp.Integer(0)
    place = affine_undone(size, x, zero)
    if place is not None:
        sign, needed = sign_of(sp.expand(sp.diff(size, x)))
    else:
        place, told = undone(size, x, zero), rising(size, x)
        sign, needed = (2, frozenset(told.positive)) if told is not None else (None, frozenset())
    if place is None or sign is None or abs(sign) < 2:
        raise _NotTold
    gaps = [] if of.low is None else [place - of.low]
    gaps += [] if of.high is None else [of.high - place]
    for gap in gaps:
        told_gap, more = sign_of(sp.expand(gap))
        if told_gap != 2:
            raise _NotTold
        needed |= more
    return sp.expand(place), needed

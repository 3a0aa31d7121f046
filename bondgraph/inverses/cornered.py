"""Laws with corners turned round: on each stretch between two by itself, told by what the law gives."""

from itertools import pairwise

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.algebra.residues import is_zero
from bondgraph.inverses.inverse import inverse_from
from bondgraph.inverses.rising import Rising, rising, sign_of
from bondgraph.inverses.stretches import CORNERS, ONWARD, Stretch, stretches
from bondgraph.inverses.undoing import affine_undone, undone

Turned = tuple[sp.Expr, frozenset[sp.Symbol]]
"""An inverse, and the names that have to be positive for it."""


def cornered_inverse(law: sp.Expr, state: sp.Symbol, value: sp.Expr) -> Turned | None:
    """The state where a law with corners has a value; None where the law is not shown to go one way.

    It has to go on over its corners without a jump, and to rise on every stretch between them, or to fall on
    every one, at the corners, too.

    >>> q, k, c, e = sp.symbols("q k c e")
    >>> cornered_inverse(k*q + c*sp.Max(q - 1, 0), q, e)[0]
    Piecewise((e/k, e < k), ((c + e)/(c + k), True))
    """
    if not law.has(*CORNERS):
        return None
    found = stretches(law, state)
    if found is None or len(found) < 2:
        return None
    for before, after in pairwise(found):
        if not is_zero((before.law - after.law).xreplace({state: before.high})):
            return None
    turned = [_turned(one, state, value) for one in found]
    ways = {one[1] for one in turned if one is not None}
    if None in turned or len(ways) != 1:
        return None
    (way,) = ways
    branches = []
    needed: frozenset[sp.Symbol] = frozenset()
    for one, told in zip(found, turned, strict=True):
        assert told is not None
        needed |= one.needed | told[2]
        if one.high is None:
            branches.append((told[0], True))
            break
        at = sp.expand(one.law.xreplace({state: one.high}))
        branches.append((told[0], value < at if way > 0 else value > at))
    return sp.Piecewise(*branches), needed


def _turned(
    one: Stretch, x: sp.Symbol, value: sp.Expr
) -> tuple[sp.Expr, int, frozenset[sp.Symbol]] | None:
    """A stretch turned round, 1 where it rises and -1 where it falls, and what has to be positive."""
    law = sp.expand(one.law) if affine_undone(one.law, x, value) is not None else one.law
    for end, onward in ((one.low, 1), (one.high, -1)):
        if end is None:
            continue
        told = rising(law.xreplace({x: end + onward * ONWARD}), ONWARD, onward=True)
        if told is None:
            continue
        at_end = told.slope.xreplace({ONWARD: sp.Integer(0)})
        sign, _ = sign_of(at_end)
        if sign is None or abs(sign) < 2:
            continue
        way = onward * (1 if sign > 0 else -1)
        needed = frozenset(told.positive)
        found = affine_undone(law, x, value)
        if found is None and (not law.has(sp.tan) and not law.has(Look)):
            found = undone(law, x, value)
        if found is None:
            slope = sp.diff(law, x)
            back = onward * (x - end)
            domain = (way * slope, *(fact.xreplace({ONWARD: back}) for fact in told.domain))
            found = inverse_from(law, x, value, Rising(slope, told.positive, domain), end)
        return found, way, needed
    return None

"""Why a law is not turned round, in words."""

from itertools import pairwise

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.algebra.residues import is_zero
from bondgraph.inverses.rising import sloped
from bondgraph.inverses.stretches import ONWARD, Stretch, stretches
from bondgraph.tables.one_way import one_way

STEEP = "where its inverse would be infinitely steep"


def why_not(law: sp.Expr, name: sp.Symbol) -> str:
    """What is known of why a law has no inverse that is found.

    >>> q, k = sp.symbols("q k")
    >>> print(why_not(k*q**3, q))
    it is level where 3*k*q**2 is zero, where its inverse would be infinitely steep
    >>> print(why_not(q - q**3, q))
    signs do not show that it rises or falls all the way
    """
    for look in sorted(law.atoms(Look), key=sp.default_sort_key):
        table, plain = look.handle.table, look.handle.orders == (0,)
        if look.has(name) and plain and (reason := one_way(table).reason):
            return f"of table {table.name!r}, {reason}"
    found = stretches(law, name)
    if found is None:
        return "it is not told where its corners lie"
    for before, after in pairwise(found):
        if not is_zero((before.law - after.law).xreplace({name: before.high})):
            return f"it jumps at {name} = {before.high}"
    signs = [_told(one, name) for one in found]
    ways = {way > 0 for way, _ in signs if way}
    return next((reason for _, reason in signs if reason), "") or (
        "it turns back" if len(ways) > 1 else "signs do not show that it rises or falls all the way"
    )


def _told(one: Stretch, x: sp.Symbol) -> tuple[int, str]:
    """1 where a stretch rises, -1 where it falls, 0 where that is not told; and where it is level."""
    ends = [(end, way) for end, way in ((one.low, 1), (one.high, -1)) if end is not None]
    laws = [(one.law.xreplace({x: end + way * ONWARD}), ONWARD, way) for end, way in ends]
    for law, name, way in laws or [(one.law, x, 0)]:
        found = sloped(law, name, onward=bool(way))
        if found is not None:
            sign = found[1] * (way or 1)
            if sign == 0:
                return 0, f"it is level{_between(one, x)}"
            return sign, "" if abs(
                sign
            ) == 2 else f"it is level where {sp.diff(one.law, x)} is zero, {STEEP}"
    return 0, ""


def _between(one: Stretch, x: sp.Symbol) -> str:
    low = f" from {x} = {one.low}" if one.low is not None else ""
    return low + (f" up to {x} = {one.high}" if one.high is not None else "")

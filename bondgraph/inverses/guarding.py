"""Inverses that have no value for what their law never gives, nor have their slopes."""

from collections.abc import Hashable
from typing import Any

import sympy as sp

from bondgraph.algebra.lookups import Handle, Look
from bondgraph.tables.looking import BACK
from bondgraph.tables.record import Sampled

FAR = 1e300
"""Where a guard ends that is open: no number of a run comes near."""

NAMED = f".law{BACK}"
"""What the names of guards end with, after the node; no table of a user has a point in its name."""

UPWARDS = (0.0, FAR)
BETWEEN = (-1.0, 1.0)
"""Where logarithms and broken powers have values, and where the area tangent has."""


class Guard(Look):
    """An argument itself, by a table that refuses what is outside: there runs end, by the law's name."""

    GUARDS = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """One: what it stands in has no value outside, nor have that one's derivatives."""
        return sp.Integer(1)

    def _sympystr(self, printer: Any) -> str:
        (inside,) = self.places
        text = printer._print(inside)
        return text if inside.is_Symbol else f"({text})"

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        (inside,) = self.places
        text = printer._print(inside)
        text = text if inside.is_Symbol else rf"\left({text}\right)"
        return text if exp is None else rf"{text}^{{{exp}}}"


def guarded(inverse: sp.Expr, given: sp.Symbol, node: Hashable) -> sp.Expr:
    """An inverse with a guard on each argument of a function that has values on one stretch alone.

    Not one that differs by stretches: which argument counts is told by where it is.

    >>> e = sp.Symbol("e")
    >>> held = guarded(sp.log(1 + e), e, "diode")
    >>> held.subs(e, -2).evalf(), held.diff(e).subs(e, -2).evalf(), held.diff(e).subs(e, 1).evalf(2)
    (nan, nan, 0.50)
    """
    if inverse.has(sp.Piecewise):
        return inverse

    def ends(part: sp.Expr) -> tuple[float, ...] | None:
        if not (part.args and part.args[0].has(given)) or isinstance(part.args[0], Guard):
            return None
        if isinstance(part, sp.atanh):
            return BETWEEN
        broken = part.is_Pow and not part.exp.is_Integer
        return UPWARDS if isinstance(part, sp.log) or broken else None

    def kept(part: sp.Expr) -> sp.Expr:
        points = ends(part)
        assert points is not None
        table = Sampled(f"{node}{NAMED}", (points,), points, "linear", "refuse")
        return part.func(Guard(Handle(table, (0,)), part.args[0]), *part.args[1:])

    return inverse.replace(lambda part: ends(part) is not None, kept)


def never_given(table: str, low: float, high: float) -> str:
    """What is to be said where a guard is left, after its argument; nothing of a table that is none.

    >>> print(never_given("m.law⁻¹", 0.0, FAR))
    leaves what is above 0: the law of 'm' gives it in no state; begin where it does
    >>> never_given("map⁻¹", 0.0, 5.0), never_given("a.law⁻¹", -1.0, 1.0)[:31]
    ('', 'leaves what is between -1 and 1')
    """
    if not table.endswith(NAMED):
        return ""
    where = f"above {low:g}" if high >= FAR else f"between {low:g} and {high:g}"
    node = table.removesuffix(NAMED)
    return f"leaves what is {where}: the law of {node!r} gives it in no state; begin where it does"

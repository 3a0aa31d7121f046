"""Slopes of laws as a program evaluates them: one value at every point, corners and poles included."""

from collections.abc import Set as AbstractSet

import sympy as sp

from bondgraph.reduce.motion import slope_of


class NoSlopeError(ArithmeticError):
    """An expression has no slope that can be written out."""


def slope(value: sp.Expr, name: sp.Symbol, signals: AbstractSet[sp.Symbol]) -> sp.Expr:
    """The derivative by one name; `NoSlopeError` where it cannot be written out.

    At a corner it is that of one side, at a jump that beside it; where it has a pole, as that of ``sqrt(p)``
    at 0, it counts as 0 there: a slope that is wrong at one instant moves nothing.

    >>> p = sp.Symbol("p")
    >>> slope(sp.Max(0, p), p, {p}), slope(sp.sqrt(p), p, {p}).subs(p, 0)
    (Piecewise((1, p > 0), (0, True)), 0)
    """
    if name not in value.free_symbols:
        return sp.Integer(0)
    found = slope_of(value, name)
    sides = {part: _side(part.args[0]) for part in found.atoms(sp.Heaviside)}
    found = found.xreplace(sides | dict.fromkeys(found.atoms(sp.DiracDelta), sp.Integer(0)))
    if found.has(sp.Derivative, sp.Subs, sp.re, sp.im, sp.I):
        raise NoSlopeError(f"{value} has no slope along {name} that can be written out")
    poles = {
        power.base for power in found.atoms(sp.Pow)
        if power.exp.is_negative and power.base.free_symbols & signals
    }  # fmt: skip
    for base in sorted(poles, key=sp.default_sort_key):
        found = sp.Piecewise((sp.Integer(0), sp.Eq(base, 0)), (found, True))
    return found


def _side(argument: sp.Expr) -> sp.Expr:
    return sp.Piecewise((1, argument > 0), (0, True))

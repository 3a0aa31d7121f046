"""The jumps of a sign, or of a value by thresholds of one argument."""

from itertools import pairwise

import sympy as sp
from sympy.core.relational import Ge, Gt, Le, Lt


def taken_apart(part: sp.Expr) -> tuple[sp.Expr, list[tuple[sp.Expr, sp.Expr]]]:
    """A sign, or a value by thresholds of one argument: its mean, and what each jump hangs on with its half.

    >>> v = sp.Symbol("v")
    >>> taken_apart(sp.Piecewise((2, v > 1), (0, v > -1), (-2, True)))
    (0, [(v - 1, 1), (v + 1, 1)])
    """
    one = sp.Integer(1)
    if isinstance(part, sp.sign):
        return sp.Integer(0), [(part.args[0], one)]
    *branches, (last, otherwise) = part.args
    sides = [side for _, condition in branches if (side := _side(condition)) is not None]
    if otherwise != sp.true or len(sides) < len(branches) or len({way for _, way in sides}) != 1:
        return part, []
    between = [sp.expand(b[0] - a[0]) for a, b in pairwise(sides)]
    if not all(gap.is_positive for gap in between):
        return part, []
    values = [*(value for value, _ in branches), last]
    halves = [(above - below) / 2 for above, below in pairwise(values)]
    return last + sp.Add(*halves), [
        (argument, half) for (argument, _), half in zip(sides, halves, strict=True)
    ]


def _side(condition: sp.Expr) -> tuple[sp.Expr, str] | None:
    """What is positive where a condition is true, and whether it is above or below a threshold."""
    if isinstance(condition, Gt | Ge):
        return condition.lhs - condition.rhs, "above"
    if isinstance(condition, Lt | Le):
        return condition.rhs - condition.lhs, "below"
    return None

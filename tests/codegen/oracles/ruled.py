"""Whether what has several ways is one of those that its conditions leave, all numbers being told."""

import operator
from collections.abc import Callable

import sympy as sp

from bondgraph.show.statements import Statement

Number = Callable[[sp.Expr], float]
"""Tells an expression's number."""

SIDES = {
    sp.Le: lambda low, high, within: low <= high + within,
    sp.Lt: lambda low, high, within: low < high - within,
}
"""What is at a bound to within rounding, is at it: not below, and not above."""


def allowed(one: Statement, number: Number, within: float) -> list[float]:
    """The values of those ways whose conditions hold; ``within``: of numbers of the size of 1."""
    assert one.ruled is not None
    return [number(value) for value, when in one.ruled.ways if _holds(when, number, within)]


def ruled_misfit(one: Statement, number: Number, within: float) -> str:
    """What is none of its ways, else nothing."""
    value, ways = number(one.left), allowed(one, number, within)
    size = max([1.0, *map(abs, ways)])
    if any(abs(value - way) <= within * size for way in ways):
        return ""
    return f"{one.left} = {one.right_text}: {value!r} is not of {ways}"


def _holds(when: sp.Basic, number: Number, within: float) -> bool:
    if isinstance(when, sp.And | sp.Or):
        every = (_holds(part, number, within) for part in when.args)
        return all(every) if isinstance(when, sp.And) else any(every)
    if when in (sp.true, sp.false):
        return when == sp.true
    for kind, held in SIDES.items():
        if isinstance(when, kind):
            low, high = (number(side) for side in when.args)
            return operator.truth(held(low, high, within * max(1.0, abs(low), abs(high))))
    raise TypeError(f"{when} is no condition")

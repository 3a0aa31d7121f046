"""Laws undone in symbols, their outermost function first."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.inverses.tabled import turned_table

BACK: Mapping[type, Callable[[sp.Expr], sp.Expr]] = MappingProxyType(
    {
        sp.exp: sp.log, sp.log: sp.exp, sp.sinh: sp.asinh, sp.asinh: sp.sinh, sp.tanh: sp.atanh,
        sp.atanh: sp.tanh, sp.tan: sp.atan,
    }
)  # fmt: skip
"""What undoes a function that rises or falls all the way, and has no value where that one never comes to.

So there is none for ``atan``: a tangent has values beyond a right angle, too.
"""


def undone(law: sp.Expr, state: sp.Symbol, value: sp.Expr) -> sp.Expr | None:
    """The state where the law has this value; None where it is held more than once, or not undone.

    >>> q, k, e = sp.symbols("q k e")
    >>> undone(sp.sinh(k*q) - 1, q, e)
    asinh(e + 1)/k
    """
    while law != state:
        inner = [part for part in law.args if part.has(state)]
        if len(inner) != 1:
            return None
        (inside,) = inner
        rest = [part for part in law.args if part is not inside]
        if isinstance(law, sp.Add):
            value = value - sp.Add(*rest)
        elif isinstance(law, sp.Mul):
            value = value / sp.Mul(*rest)
        elif isinstance(law, sp.Pow) and inside is law.base:
            back = _power_back(value, law.exp)
            if back is None:
                return None
            value = back
        elif isinstance(law, sp.Pow):
            value = sp.log(value) / sp.log(law.base)
        elif law.func in BACK:
            value = BACK[law.func](value)
        elif isinstance(law, Look) and (back := turned_table(law.handle)) is not None:
            value = Look(back, value)
        else:
            return None
        law = inside
    return value


def affine_undone(law: sp.Expr, state: sp.Symbol, value: sp.Expr) -> sp.Expr | None:
    """The same of a law that is a sum of the state with factors, however often it holds it.

    >>> q, k, c, e = sp.symbols("q k c e")
    >>> affine_undone(k*q + c*(q - 1), q, e)
    (c + e)/(c + k)
    """
    slope = sp.expand(sp.diff(law, state))
    if slope == 0 or slope.has(state):
        return None
    return (value - sp.expand(law.xreplace({state: sp.Integer(0)}))) / slope


def _power_back(value: sp.Expr, exponent: sp.Expr) -> sp.Expr | None:
    """What has this power, and has no value where the value is below zero, as no broken power is."""
    # A root of a whole power has no slope at zero, or two values; a square of a root takes either sign.
    whole = exponent.is_Integer or (1 / exponent).is_Integer
    return None if whole and exponent not in (1, -1) else value ** (1 / exponent)

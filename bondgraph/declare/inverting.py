"""Laws of storages turned round: the state as a function of what the law gives."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.declare.elements import Element
from bondgraph.declare.fields import inverts
from bondgraph.declare.laws import ExpressionLaw
from bondgraph.inverses.inverse import inverse_of

BACK: Mapping[type, Callable[[sp.Expr], sp.Expr]] = MappingProxyType(
    {
        sp.exp: sp.log, sp.log: sp.exp, sp.sinh: sp.asinh, sp.asinh: sp.sinh, sp.tanh: sp.atanh,
        sp.atanh: sp.tanh, sp.atan: sp.tan, sp.tan: sp.atan,
    }
)  # fmt: skip
"""What undoes a function that rises or falls all the way."""


def with_inverse(element: Element) -> Element | None:
    """The storage with its law's inverse, so that it goes either way; None where it has none that is found.

    It is found where the law holds its own state once, in functions that are undone one after the other, and
    constants: what is found is put in and tried. Else it is an `Inverse`, which searches, where signs show
    that the law rises or falls all the way.

    >>> from bondgraph.declare.elements import C
    >>> from bondgraph.declare.declared import elements_of
    >>> diode, = elements_of(*C("diode", law="E*log(1 + q_diode/Q)")).values()
    >>> with_inverse(diode).inverse
    Q*(exp(e_diode/E) - 1)
    """
    if not element.kind.stores or element.energy is not None:
        return None
    if element.inverse is not None:
        return element
    law, given = element.law, element.co_energy
    if not isinstance(law, ExpressionLaw) or law.state is None or given is None:
        return None
    found = _undone(law.expression, law.state, given)
    if found is None or not inverts(law.expression.xreplace({law.state: found}), given):
        found = inverse_of(law.expression, law.state, given)
    if found is None:
        return None
    return replace(element, inverse=found, gives=None)


def _undone(law: sp.Expr, state: sp.Symbol, value: sp.Expr) -> sp.Expr | None:
    """The state where the law has this value, its outermost function undone first."""
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
            if law.exp.is_Integer and law.exp not in (1, -1):
                # A root of it has no slope at zero, or two values.
                return None
            value = value ** (1 / law.exp)
        elif isinstance(law, sp.Pow):
            value = sp.log(value) / sp.log(law.base)
        elif law.func in BACK:
            value = BACK[law.func](value)
        else:
            return None
        law = inside
    return value

"""Laws turned round: a storage's state, or what a resistance receives, as a function of what it gives."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from bondgraph.declare.elements import OTHER, Element
from bondgraph.declare.fields import inverts
from bondgraph.declare.laws import ExpressionLaw
from bondgraph.inverses.inverse import inverse_of
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
    found = _inverse(law.expression, law.state, given)
    return None if found is None else replace(element, inverse=found, gives=None, turned=True)


def flipped(element: Element) -> Element | None:
    """The resistance that gives what its law receives; None where no inverse of its law is found.

    >>> from bondgraph.declare.elements import R
    >>> from bondgraph.declare.declared import elements_of
    >>> damper, = elements_of(*R("damper", law="b*sinh(f_damper)")).values()
    >>> flipped(damper).gives, flipped(damper).law.expression
    ('flow', asinh(e_damper/b))
    """
    law, given, received = element.law, element.given, element.received
    if not (element.kind.resists and isinstance(law, ExpressionLaw) and element.owner is None):
        return None
    if element.gives is None or given is None or received is None:
        return None
    found = _inverse(law.expression, received, given)
    if found is None or TIME in found.free_symbols:
        return None
    return replace(element, law=ExpressionLaw(found), gives=OTHER[element.gives], turned=True)


def as_received(element: Element, law: ExpressionLaw) -> ExpressionLaw | None:
    """A law over a port that is turned, by what the port now receives; None where that is not found.

    A law may be written either way: by what the port gave before, or by what it gives now.
    """
    given, received = element.given, element.received
    if not element.turned or given is None or received is None:
        return law
    if given not in law.free_symbols or received in law.free_symbols:
        return law
    found = _inverse(law.expression, given, received)
    return None if found is None else ExpressionLaw(found)


def _inverse(law: sp.Expr, name: sp.Symbol, value: sp.Expr) -> sp.Expr | None:
    """What is undone step by step, or else searched."""
    if name not in law.free_symbols:
        return None
    found = _undone(law, name, value)
    if found is not None and law.has(Look):
        # Its points, which the other is made of, may lie far from those that are tried.
        return found
    if found is None or not inverts(law.xreplace({name: found}), value):
        found = inverse_of(law, name, value)
    return found


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


def _power_back(value: sp.Expr, exponent: sp.Expr) -> sp.Expr | None:
    """What has this power, and has no value where the value is below zero, as no broken power is."""
    # A root of a whole power has no slope at zero, or two values; a square of a root takes either sign.
    whole = exponent.is_Integer or (1 / exponent).is_Integer
    return None if whole and exponent not in (1, -1) else value ** (1 / exponent)

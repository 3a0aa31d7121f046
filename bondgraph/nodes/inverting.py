"""Laws turned round: a storage's state, or what a resistance receives, as a function of what it gives."""

from dataclasses import replace

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from bondgraph.inverses.cornered import cornered_inverse
from bondgraph.inverses.guarding import guarded
from bondgraph.inverses.inverse import inverse_of
from bondgraph.inverses.reasons import why_not
from bondgraph.inverses.undoing import undone
from bondgraph.nodes.elements import OTHER, Element
from bondgraph.nodes.fields import inverts
from bondgraph.nodes.laws import ExpressionLaw

Turned = tuple[sp.Expr, frozenset[sp.Symbol]]
"""An inverse, and the names that have to be positive for it beside those that it tells itself."""


def with_inverse(element: Element) -> Element | None:
    """The storage with its law's inverse, so that it goes either way; None where it has none that is found.

    It is found where the law holds its own state once, in functions that are undone one after the other, and
    constants: what is found is put in and tried. Else it is an `Inverse`, which searches, where signs show
    that the law rises or falls all the way. Of a law with corners it is one of these for each stretch.

    >>> from bondgraph.nodes.elements import C
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
    if found is None:
        return None
    inverse, needed = guarded(found[0], given, element.name), found[1]
    return replace(element, inverse=inverse, gives=None, turned=True, needed=needed)


def flipped(element: Element) -> Element | None:
    """The resistance that gives what its law receives; None where no inverse of its law is found.

    >>> from bondgraph.nodes.elements import R
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
    if found is None or TIME in found[0].free_symbols:
        return None
    back, needed = ExpressionLaw(guarded(found[0], given, element.name)), found[1]
    return replace(element, law=back, gives=OTHER[element.gives], turned=True, needed=needed)


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
    return None if found is None else ExpressionLaw(guarded(found[0], given, element.name))


def why_unturned(element: Element) -> str:
    """A sentence that tells why the law of a storage or a resistance is not turned round; none of others.

    >>> from bondgraph.nodes.elements import C
    >>> from bondgraph.declare.declared import elements_of
    >>> why_unturned(*elements_of(*C("buffer", law="k*q_buffer + sign(q_buffer)")).values())
    '. It is not turned round: it jumps at q_buffer = 0'
    """
    law = element.law
    if not isinstance(law, ExpressionLaw) or element.turned or element.inverse is not None:
        return ""
    name = law.state if element.kind.stores else element.received
    alone = element.owner is None and element.energy is None
    if name is None or name not in law.expression.free_symbols or not alone:
        return ""
    return f". It is not turned round: {why_not(law.expression, name)}"


def _inverse(law: sp.Expr, name: sp.Symbol, value: sp.Expr) -> Turned | None:
    """What is undone step by step, or stretch by stretch between corners, or else searched."""
    if name not in law.free_symbols:
        return None
    if (cornered := cornered_inverse(law, name, value)) is not None:
        return cornered
    found = undone(law, name, value)
    if found is not None and law.has(Look):
        # Its points, which the other is made of, may lie far from those that are tried.
        return found, frozenset()
    if found is None or not inverts(law.xreplace({name: found}), value):
        found = inverse_of(law, name, value)
    return None if found is None else (found, frozenset())

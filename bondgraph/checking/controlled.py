"""Known sources and nodes of signals in causal paths: gains from what they read to what they give."""

from collections.abc import Iterator, Mapping

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw

Home = tuple[int, sp.Expr]
"""The signal of a bond that has a name, and what the name is of it: a sign, of an integral by ``s``."""


def of_sources(
    strokes: Strokes, equations: CausalEquations, homes: Mapping[sp.Symbol, Home]
) -> Iterator[tuple[int, int, sp.Expr]]:
    """What known sources make of signals that they read: the signal read, the one given, the gain.

    What they add of parameters and the time is an input of its own, and passes along the same paths.

    Raises `StructureError` for laws that are not linear in what moves.
    """
    for signal, (node, sign) in equations.given.items():
        element = strokes.elements[node]
        if not element.kind.supplies or not isinstance(element.law, ExpressionLaw):
            continue
        law = element.law.expression
        gains: dict[int, sp.Expr] = {}
        for name in sorted(law.free_symbols & homes.keys(), key=str):
            slope = sp.diff(law, name)
            _check(element, name, slope, homes)
            home, factor = homes[name]
            gains[home] = gains.get(home, sp.Integer(0)) + sign * slope * factor
        yield from ((home, signal, sp.cancel(gain)) for home, gain in gains.items() if gain != 0)


def _check(
    element: Element, name: sp.Symbol, slope: sp.Expr, homes: Mapping[sp.Symbol, Home]
) -> None:
    if slope.free_symbols & {TIME, *homes} or slope.atoms(sp.Derivative, sp.Subs):
        raise StructureError(
            f"{told(element)} reads {name} by a factor that moves, and causal paths have constant gains; "
            "linearize it, or give it a constant factor"
        )


def homes_of(strokes: Strokes, equations: CausalEquations, s: sp.Symbol) -> dict[sp.Symbol, Home]:
    """Where every name of an effort, a flow or an integral is to be had, first of those that give it."""
    found: dict[sp.Symbol, Home] = {}
    for signal, (node, sign) in equations.given.items():
        element = strokes.elements[node]
        if (name := element.variable(strokes.gives(node))) is not None:
            found.setdefault(name, (signal, sp.Integer(sign)))
    for node, (signal, sign) in equations.received.items():
        element = strokes.elements[node]
        other = "effort" if strokes.gives(node) == "flow" else "flow"
        if (name := element.variable(other)) is not None:
            found.setdefault(name, (signal, sp.Integer(sign)))
        if element.integral is not None:
            found.setdefault(element.integral, (signal, sign / s))
    for node, element in enumerate(strokes.elements):
        if element.kind.joins and element.common is not None:
            zero = element.kind.common == "effort"
            bond = next(b for b in strokes.at[node] if (strokes.end[b] == node) == zero)
            found.setdefault(element.common, (2 * bond + (not zero), sp.Integer(1)))
    return found


def told(element: Element) -> str:
    """An element as it was declared: a part as its whole."""
    return f"{element.declared or element.kind} {(element.whole or element.name)!r}"

"""Refusals of singular graphs told with the expression that vanishes, every value under a name of its own."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import Row, determinant
from bondgraph.algebra.factored import factored
from bondgraph.algebra.residues import is_zero
from bondgraph.nodes.elements import Element

MOST = 6
"""Determinants of more rows are too long to be read."""


def generic(
    elements: Mapping[Hashable, Element],
) -> tuple[dict[Hashable, Element], dict[sp.Symbol, sp.Expr]]:
    """The elements with values that are symbols of their own, and what these stand for."""
    made: dict[Hashable, Element] = {}
    values: dict[sp.Symbol, sp.Expr] = {}
    for name, element in elements.items():
        if element.value is not None and not element.row:
            letter = "m" if element.kind.two_port else str(element.kind)
            symbol = sp.Symbol(f"{letter}_{name}")
            made[name] = replace(element, value=symbol)
            values[symbol] = element.value
    return made, values


def told(rows: Sequence[Row], values: Mapping[sp.Symbol, sp.Expr]) -> str | None:
    """The determinant of these rows, if it vanishes at the values: "m_a*m_b - 1 vanishes with m_a = ..."."""
    if len(rows) > MOST:
        return None
    found = factored(sp.fraction(sp.together(determinant(rows)))[0])
    put = {name: values[name] for name in found.free_symbols if name in values}
    if not is_zero(found.xreplace(put)):
        return None
    where = ", ".join(f"{name} = {put[name]}" for name in sorted(put, key=str))
    return f"{found} vanishes with {where}" if where else None


def elements_in(graph: "nx.DiGraph[Hashable]") -> dict[Hashable, Element]:
    """The elements of a validated graph by their nodes."""
    return {name: graph.nodes[name]["element"] for name in graph}

"""Laws put later over open ports that drive dependent storages: the equations with these ports turned."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.factored import factored
from bondgraph.algebra.lookups import Look
from bondgraph.derive import derive_again
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError
from bondgraph.nodes.elements import Element
from bondgraph.nodes.inverting import flipped
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.nodes.laws import law as as_law
from bondgraph.reduce.inverses import by_inverse
from bondgraph.reduce.structure import Port
from bondgraph.tables.record import Sampled


def turned(equations: StateEquations, laws: object) -> StateEquations:
    """The equations in which every port has the causality that its law needs; the same ones where they do.

    ``laws``: as for a simulator, looked at only as far as they are right. An open port gives what its
    ``gives`` says. Where that drives a dependent storage and dry friction is put over the port, or a law
    that can be turned round, which go either way, the graph is derived once more: directly on a spring the
    port then gives its flow, and the spring is a state. All other names stay as they are.

    Raises `StructureError` where friction in its other causality has a curve or a breakaway,
    `DependentSourceError` where it would divide there by a ratio that may pass through zero.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Sf("speed", "v"), bg.Zero("node"), bg.C("spring", "1/k", effort="F"),
    ...                   bg.R("slider", effort="F_s", flow="s")])
    >>> g.add_edges_from([("speed", "node"), ("node", "spring"), ("node", "slider")])
    >>> equations = bg.derive(g)
    >>> equations.states, turned(equations, {"slider": bg.DryFriction("N")}).states
    ((), (F,))
    """
    elements = _elements(equations, laws)
    held = _held(equations, laws)
    if not elements and not held:
        return equations
    found = derive_again(equations, {**held, **elements})
    for factor in _divisors_that_vanish(found, equations) if elements else ():
        names = ", ".join(map(repr, elements))
        raise DependentSourceError(
            f"the law at {names} drives a dependent storage, so it is to have its other causality; "
            f"there it would divide by {factor}, which may pass through zero: put a storage that can be "
            "independent beside it"
        )
    return found


def _elements(equations: StateEquations, laws: object) -> dict[Hashable, Element]:
    """The nodes whose ports drive dependent storages, with laws that go either way put over them."""
    if not isinstance(laws, Mapping):
        return {}
    told = {port.element.name: _law_over(port, laws) for port in equations.ports}
    if all(law is None for law in told.values()):
        return {}
    made = {
        port.element.name: _either_way(port.element, told[port.element.name], equations.tables)
        for port in driving_ports(equations)
    }
    return {name: element for name, element in made.items() if element is not None}


def _law_over(port: Port, laws: Mapping[Any, object]) -> object:
    """What is put over a port, by its node or by what it gives; None where nothing is."""
    names = (port.element.name, port.given, port.given.name)
    return next((laws[name] for name in names if name in laws), None)


def _either_way(element: Element, law: object, tables: Iterable[Sampled]) -> Element | None:
    """A resistance with a law that goes either way; None where it does not."""
    if not element.kind.resists or element.gives is None or element.turned:
        return None
    if isinstance(law, DryFriction):
        return replace(element, law=law, gives=None)
    if not isinstance(law, str | sp.Expr | ExpressionLaw):
        return None
    return flipped(replace(element, law=as_law(law, f"law at {element.name!r}", None, tables)))


def _held(equations: StateEquations, laws: object) -> dict[Hashable, Element]:
    """The nonlinear storages that friction put over open ports holds, by their inverses."""
    if not isinstance(laws, Mapping):
        return {}
    structure = equations.reduction.structure
    found: dict[Hashable, Element] = {}
    for port, row in zip(structure.ports, structure.rows, strict=True):
        if isinstance(_law_over(port, laws), DryFriction):
            found |= by_inverse(structure, row)
    return found


def driving_ports(equations: StateEquations) -> tuple[Port, ...]:
    """The ports whose inputs are differentiated somewhere, or that receive what shows rates."""
    columns = {equations.inputs[column] for _, column in equations.E.todok()}
    readings = ((port, equations.readings[port.received]) for port in equations.ports)
    return tuple(port for port, row in readings if row.H or row.K or port.given in columns)


def _divisors_that_vanish(found: StateEquations, before: StateEquations) -> list[sp.Expr]:
    """What stands below a fraction line in signals that did not before, and may pass through zero."""
    structure = found.reduction.structure
    moving = {*found.states, *found.inputs, *structure.states_of_laws, TIME}
    new = _divisors(found) - _divisors(before)
    return sorted((factor for factor in new if may_vanish(factor, moving)), key=str)


def _divisors(equations: StateEquations) -> set[sp.Expr]:
    entries = (entry for row in equations.reduction.structure.rows for entry in row.values())
    bases = (
        part.base
        for entry in entries
        for part in factored(entry).atoms(sp.Pow)
        if part.exp.is_negative
    )
    return {factor for base in bases for factor in sp.Mul.make_args(factored(base))}


def may_vanish(expr: sp.Expr, moving: set[sp.Symbol]) -> bool:
    """Whether nothing shows that an expression stays off zero as names in it move; parameters do not.

    >>> theta, r = sp.symbols("theta r")
    >>> may_vanish(sp.sin(theta), {theta}), may_vanish(2 + sp.cos(theta), {theta}), may_vanish(r, {theta})
    (True, False, False)
    """
    if not expr.free_symbols & moving:
        return False
    if isinstance(expr, sp.exp | sp.cosh):
        return False
    low, high = _bounds(expr)
    return bool(low <= 0 <= high)


def _bounds(expr: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Between what a real expression lies, whatever its names are."""
    if expr.is_Rational:
        return expr, expr
    if isinstance(expr, sp.sin | sp.cos | sp.tanh):
        return sp.Integer(-1), sp.Integer(1)
    if isinstance(expr, sp.Abs | sp.exp | sp.cosh) or (expr.is_Pow and expr.exp.is_even):
        return sp.Integer(0), sp.oo
    if isinstance(expr, Look) and (between := expr.bounds) is not None:
        return between
    if expr.is_Add:
        parts = [_bounds(part) for part in expr.args]
        return sp.Add(*(low for low, _ in parts)), sp.Add(*(high for _, high in parts))
    if expr.is_Mul and expr.args[0].is_Rational and len(expr.args) == 2:
        ends = [expr.args[0] * end for end in _bounds(expr.args[1])]
        return min(ends), max(ends)
    return -sp.oo, sp.oo

"""A linear causal graph as a graph of signals: each effort and flow, and the gain from one to the next."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import Row
from bondgraph.algebra.expressions import TIME
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.lines import field_solved
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations, causal_equations
from bondgraph.checking.controlled import Home, homes_of, of_sources, told
from bondgraph.declare.names import named_by
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element


@dataclass(frozen=True)
class SignalGraph:
    """Signals, ``2*b`` the effort of bond b and ``2*b + 1`` its flow, with edges of a ``gain``.

    ``given`` and ``received``: of one-ports by their number, the signal, and its sign over the variable.
    ``homes``: of names the signal that has it, and what the name is of that.
    """

    strokes: Strokes
    graph: "nx.DiGraph[int]"
    given: Mapping[int, tuple[int, int]]
    received: Mapping[int, tuple[int, int]]
    homes: Mapping[sp.Symbol, Home]


def signal_graph(causal: CausalGraph, s: sp.Symbol) -> SignalGraph:
    """The graph of all signals, with storages as multiples of ``s`` and of ``1/s``.

    Raises `StructureError` for laws, switches and values that move, `AlgebraicLoopError` for a field
    whose matrix has no inverse where one is needed.
    """
    strokes = causal.assignment
    _check_linear(strokes, s)
    equations = causal_equations(strokes)
    homes = homes_of(strokes, equations, s)
    made: nx.DiGraph[int] = nx.DiGraph()
    made.add_nodes_from(range(2 * len(strokes.bonds)))
    for signal, terms in enumerate(equations.terms):
        for source, factor in terms:
            made.add_edge(source, signal, gain=factor)
    for source, signal, gain in (
        *_of_one_ports(strokes, equations, s), *of_sources(strokes, equations, homes)
    ):  # fmt: skip
        made.add_edge(source, signal, gain=gain)
    nx.freeze(made)
    given = {node: (signal, sign) for signal, (node, sign) in equations.given.items()}
    return SignalGraph(
        strokes, made, MappingProxyType(given), equations.received, MappingProxyType(homes)
    )


def _check_linear(strokes: Strokes, s: sp.Symbol) -> None:
    moving = {TIME} | {name for element in strokes.elements for name in named_by(element)}
    for element in strokes.elements:
        read: set[sp.Symbol] = set() if element.value is None else element.value.free_symbols
        read = read.union(*(value.free_symbols for _, value in element.row))
        if element.task is not None:
            raise StructureError(
                f"{told(element)} works at instants, and causal paths are of what goes on all the time; take "
                "linearize(..., period=...)"
            )
        if element.kind.supplies:
            read |= set() if element.law is None else element.law.free_symbols & {s}
        elif element.law is not None or element.kind.switches:
            raise StructureError(
                f"{told(element)} is not linear, and causal paths have gains of linear "
                "elements alone; give it a constant value (a switch: take bondgraph.in_mode)"
            )
        if read & moving:
            name = min(read & moving, key=str)
            raise StructureError(
                f"{told(element)} reads {name}, which moves, and causal paths have constant "
                "gains; give it a constant value"
            )
        if s in read:
            raise StructureError(
                f"{told(element)} has a parameter {s}; call Laplace's variable by "
                "another name, with s=..."
            )


def _of_one_ports(
    strokes: Strokes, equations: CausalEquations, s: sp.Symbol
) -> Iterator[tuple[int, int, sp.Expr]]:
    """What storages and resistances make of what they receive: received signal, given signal, gain."""
    numbers = {name: node for node, name in enumerate(strokes.names)}
    given = {node: (signal, sign) for signal, (node, sign) in equations.given.items()}
    done: set[int] = set()
    for node, element in enumerate(strokes.elements):
        linear = element.kind.stores or (element.kind.resists and element.gives is None)
        if not linear or node in done:
            continue
        nodes = [numbers[name] for name, _ in element.row] or [node]
        done.update(nodes)
        for to, row in zip(nodes, _solved(strokes, nodes, s), strict=True):
            for at, factor in row.items():
                received, known = equations.received[nodes[at]]
                signal, sign = given[to]
                yield received, signal, sp.cancel(sign * known * factor)


def _solved(strokes: Strokes, nodes: list[int], s: sp.Symbol) -> list[Row]:
    """What each of a field's ports gives per unit of what they receive; of one element, its own gain."""
    matrix: list[Row] = []
    right: list[Row] = []
    for at, node in enumerate(nodes):
        element = strokes.elements[node]
        caused = _caused(element)
        scale = s if element.kind.stores else sp.Integer(1)
        line: Row = {at: sp.Integer(1)} if strokes.gives(node) == caused else {}
        known: Row = {} if line else {at: sp.Integer(-1)}
        values = [value for _, value in element.row] or [element.constant]
        for k, value in enumerate(values):
            if value == 0:
                continue
            if strokes.gives(nodes[k]) == caused:
                known[k] = known.get(k, sp.Integer(0)) + scale * value
            else:
                line[k] = line.get(k, sp.Integer(0)) - scale * value
        matrix.append(line)
        right.append(known)
    return field_solved(strokes.elements[nodes[0]].owner, matrix, right)


def _caused(element: Element) -> str:
    """What value times s, or times one, makes of the other: e = (I f)', f = (C e)', e = R f."""
    return "flow" if element.kind.gives == "effort" else "effort"


def node_of(strokes: Strokes, node: int) -> Hashable:
    """A node as it was declared: of a field's port the field, of a part its whole."""
    element = strokes.elements[node]
    return element.owner or element.whole or element.name

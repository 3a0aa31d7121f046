"""`junction_structure`: what every port receives, as an exact linear function of what all ports give."""

from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import (
    FixedRow,
    Row,
    SingularError,
    add_scaled,
    combined,
    fixed,
    scaled,
    solve,
)
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations, causal_equations, causal_groups, loop_rows
from bondgraph.declare.tables import TABLES
from bondgraph.errors import AlgebraicLoopError
from bondgraph.reduce.structure import JunctionStructure, Port


def junction_structure(causal: CausalGraph) -> JunctionStructure:
    """Eliminate the bonds along causal paths, solving each loop of them on its own.

    Raises `AlgebraicLoopError` for a loop whose determinant vanishes identically.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L"), ("loop", "R")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> from bondgraph import assign_causality
    >>> junction_structure(assign_causality(g)).S.tolist()  # of the ports u, L and R
    [[0, 1, 0], [1, 0, -1], [0, 1, 0]]
    """
    strokes = causal.assignment
    equations = causal_equations(strokes)
    one_ports = [node for node, element in enumerate(strokes.elements) if element.one_port]
    index = {node: at for at, node in enumerate(one_ports)}
    signals, loops = _signals(strokes, equations, index)
    rows = []
    for node in one_ports:
        signal, sign = equations.received[node]
        rows.append(signals[signal] if sign == 1 else fixed(scaled(signals[signal], sign)))
    common = {
        strokes.names[node]: signals[2 * strokes.at[node][0] + (element.kind.common == "flow")]
        for node, element in enumerate(strokes.elements)
        if element.kind.joins
    }
    pairs = zip(signals[::2], signals[1::2], strict=True)
    return JunctionStructure(
        ports=tuple(_port(strokes, node) for node in one_ports),
        rows=tuple(rows),
        common=MappingProxyType(common),
        bonds=MappingProxyType(dict(zip(strokes.declared, pairs, strict=True))),
        elements=MappingProxyType(dict(zip(strokes.names, strokes.elements, strict=True))),
        loops=loops,
        ends=tuple((strokes.names[tail], strokes.names[head]) for tail, head in strokes.bonds),
        tables=causal.graph.graph[TABLES],
    )


def _port(strokes: Strokes, node: int) -> Port:
    element = strokes.elements[node]
    tail = strokes.bonds[strokes.at[node][0]][0] == node
    inward = -1 if element.kind.supplies and tail else 1
    return Port(element, strokes.gives(node), inward)


def _signals(
    strokes: Strokes, equations: CausalEquations, index: dict[int, int]
) -> tuple[list[FixedRow], tuple[tuple[FixedRow, ...], ...]]:
    """Every signal as a sparse row over what the ports give, and the loops on the way."""
    signals: list[FixedRow] = [{} for _ in equations.terms]
    loops: list[tuple[FixedRow, ...]] = []
    for group in causal_groups(equations.terms):
        if len(group) == 1:
            signals[group[0]] = _signal(equations, group[0], index, signals)
        else:
            _solve_loop(strokes, equations, group, signals)
            loops.append(tuple(map(fixed, loop_rows(equations, group))))
    return signals, tuple(loops)


def _signal(
    equations: CausalEquations, signal: int, index: dict[int, int], signals: list[FixedRow]
) -> FixedRow:
    if signal in equations.given:
        node, sign = equations.given[signal]
        return fixed({index[node]: sp.Integer(sign)})
    terms = equations.terms[signal]
    if len(terms) == 1:
        source, factor = terms[0]
        return signals[source] if factor == 1 else fixed(scaled(signals[source], factor))
    return fixed(combined((signals[source], factor) for source, factor in terms))


def _solve_loop(
    strokes: Strokes, equations: CausalEquations, group: tuple[int, ...], signals: list[FixedRow]
) -> None:
    """Solve ``s = W s + r`` for the signals of one loop, r being known rows."""
    place = {signal: at for at, signal in enumerate(group)}
    matrix: list[Row] = []
    right: list[Row] = []
    for at, signal in enumerate(group):
        inside: Row = {at: sp.Integer(1)}
        outside: Row = {}
        for source, factor in equations.terms[signal]:
            if source in place:
                add_scaled(inside, {place[source]: sp.Integer(1)}, -factor)
            else:
                add_scaled(outside, signals[source], factor)
        matrix.append(inside)
        right.append(outside)
    try:
        solved = solve(matrix, right)
    except SingularError:
        raise AlgebraicLoopError(_loop_message(strokes, group)) from None
    for signal, row in zip(group, solved, strict=True):
        signals[signal] = fixed(row)


def _loop_message(strokes: Strokes, group: tuple[int, ...]) -> str:
    names = []
    for signal in group[:8]:
        tail, head = strokes.declared[signal // 2]
        names.append(f"{'flow' if signal % 2 else 'effort'} of {tail!r} -> {head!r}")
    more = f" and {len(group) - 8} more" if len(group) > 8 else ""
    return (
        f"the signals {', '.join(names)}{more} form a loop whose determinant vanishes identically; "
        "open the loop, or put a storage or a resistance on it"
    )

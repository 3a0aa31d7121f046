"""Right sides: every effort and flow in terms of others, as the node that gives it makes it."""

from collections.abc import Hashable, Iterator
from typing import Literal

import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, solve
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations, Term
from bondgraph.errors import AlgebraicLoopError
from bondgraph.nodes.elements import Element

Rule = Literal["given", "balance", "transfer", "law", "rate"]
"""The kinds of right sides; of a "rate" the terms are the momentum or displacement it is the rate of."""

Line = tuple[Rule, list[Term], sp.Expr]
"""A right side: its kind, its terms in other signals, and what is left: a state or an input, or 0."""


def signal_lines(strokes: Strokes, equations: CausalEquations) -> Iterator[Line]:
    """Every signal's right side, in the order of the signals."""
    numbers = {name: at for at, name in enumerate(strokes.names)}
    fields: dict[int, list[Term]] = {}
    for signal, terms in enumerate(equations.terms):
        if signal in equations.given:
            node, sign = equations.given[signal]
            yield _given(strokes, equations, node, sign, numbers, fields)
        elif strokes.elements[owner(strokes, signal)].kind.joins:
            zero = strokes.elements[owner(strokes, signal)].kind.common == "effort"
            balance = (signal % 2 == 1) == zero
            yield "balance" if balance else "transfer", list(terms), sp.Integer(0)
        else:
            yield "transfer", list(terms), sp.Integer(0)


def _given(
    strokes: Strokes, equations: CausalEquations, node: int, sign: int,
    numbers: dict[Hashable, int], fields: dict[int, list[Term]],
) -> Line:  # fmt: skip
    """What a one-port gives; ``sign`` is the bond's over the element's."""
    element, none = strokes.elements[node], sp.Integer(0)
    if element.kind.detects:
        return "given", [], none
    if is_independent(strokes, node):
        return "given", [], sign * variable_of(element, strokes.gives(node))
    if element.kind.stores and element.inverse is not None:
        # The state as a function of what the element receives, written as a multiple of that.
        signal, known = equations.received[node]
        other = "effort" if strokes.gives(node) == "flow" else "flow"
        factor = element.inverse / variable_of(element, other)
        return "rate", [(signal, sign * known * factor)], none
    if element.kind.stores:
        row = element.row or ((element.name, element.constant),)
        effort = element.kind.gives == "effort"
        stored = [(numbers[name], value) for name, value in row if value != 0]
        return "rate", [_term(strokes, at, effort, sign * value) for at, value in stored], none
    if not element.row:
        value = element.constant
        signal, known = equations.received[node]
        factor = value if strokes.gives(node) == "effort" else 1 / value
        return "law", [(signal, sign * known * factor)], none
    if node not in fields:
        fields |= _field(strokes, [numbers[name] for name, _ in element.row])
    return "law", [(signal, sign * factor) for signal, factor in fields[node]], none


def owner(strokes: Strokes, signal: int) -> int:
    """The node that gives the signal: a flow the one that receives the effort, an effort the other."""
    tail, head = strokes.bonds[signal // 2]
    at_head = strokes.end[signal // 2] == head
    return head if at_head == (signal % 2 == 1) else tail


def is_independent(strokes: Strokes, node: int) -> bool:
    """Whether a one-port gives a state or an input."""
    element = strokes.elements[node]
    if element.gives is not None:
        return not element.kind.detects
    if element.lets_go:
        return True
    return element.kind.stores and strokes.gives(node) == (element.kind.gives)


def variable_of(element: Element, which: str) -> sp.Symbol:
    """An element's effort or flow."""
    return element.effort if which == "effort" else element.flow


def _term(strokes: Strokes, node: int, effort: bool, factor: sp.Expr) -> Term:
    """A multiple of a one-port's effort or flow, as a multiple of its bond's."""
    bond = strokes.at[node][0]
    turned = effort and strokes.bonds[bond][0] == node
    return 2 * bond + (not effort), -factor if turned else factor


def field_solved(owner: Hashable, matrix: list[Row], right: list[Row]) -> list[Row]:
    """What a field's ports give, from its equations; `AlgebraicLoopError` where these do not tell it."""
    try:
        return solve(matrix, right)
    except SingularError:
        raise AlgebraicLoopError(
            f"the field {owner!r} cannot give what it has to: that part of its matrix has no inverse; "
            "change a value, or put a storage between"
        ) from None


def _field(strokes: Strokes, nodes: list[int]) -> dict[int, list[Term]]:
    """``e = R f`` of a field of resistances, solved for what its ports give."""
    matrix: list[Row] = []
    right: list[Row] = []
    for at, node in enumerate(nodes):
        effort_given = strokes.gives(node) == "effort"
        line: Row = {at: sp.Integer(1)} if effort_given else {}
        known: Row = {} if effort_given else {at: sp.Integer(-1)}
        for k, (_, value) in enumerate(strokes.elements[node].row):
            if value != 0 and strokes.gives(nodes[k]) == "flow":
                line[k] = -value
            elif value != 0:
                known[k] = value
        matrix.append(line)
        right.append(known)
    solved = field_solved(strokes.elements[nodes[0]].owner, matrix, right)
    return {
        node: [
            _term(strokes, nodes[k], strokes.gives(nodes[k]) == "flow", factor)
            for k, factor in row.items()
        ]
        for node, row in zip(nodes, solved, strict=True)
    }

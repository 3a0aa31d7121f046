"""Which signal follows from which: every effort and flow in terms of others, once strokes are known.

Signal ``2*b`` is the effort of bond b, ``2*b + 1`` its flow.
"""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import networkx as nx
import sympy as sp

from bondgraph.causality.record import Strokes

Term = tuple[int, sp.Expr]


@dataclass(frozen=True)
class CausalEquations:
    """Every signal as a sum of others: ``signal = sum(coefficient * signal)``.

    A signal that a one-port gives has no terms and stands in ``given``, with the one-port's number
    and the sign of its effort (-1 for an I, C or R that is the tail of its bond: power counts into it
    all the same, its flow is the bond's, its effort the bond's negative).
    """

    terms: tuple[tuple[Term, ...], ...]
    given: Mapping[int, tuple[int, int]]
    received: Mapping[int, tuple[int, int]]


def causal_equations(strokes: Strokes) -> CausalEquations:
    """The assignments that the strokes read into the nodes' equations."""
    terms: list[tuple[Term, ...]] = [()] * (2 * len(strokes.bonds))
    given: dict[int, tuple[int, int]] = {}
    received: dict[int, tuple[int, int]] = {}
    for node, element in enumerate(strokes.elements):
        if element.one_port:
            bond = strokes.at[node][0]
            gives_effort = strokes.end[bond] != node
            sign = _effort_sign(strokes, node, bond)
            given[2 * bond + (not gives_effort)] = (node, sign if gives_effort else 1)
            received[node] = (2 * bond + gives_effort, 1 if gives_effort else sign)
        else:
            rule = _two_port if element.kind.two_port else _junction
            for signal, right in rule(strokes, node):
                terms[signal] = right
    return CausalEquations(tuple(terms), MappingProxyType(given), MappingProxyType(received))


def _effort_sign(strokes: Strokes, node: int, bond: int) -> int:
    tail = strokes.bonds[bond][0] == node
    return -1 if tail and strokes.elements[node].kind.absorbs else 1


def _junction(strokes: Strokes, node: int) -> Iterator[tuple[int, tuple[Term, ...]]]:
    """The common variable handed on, and the balance solved for the bond that brings it."""
    zero = strokes.elements[node].kind.common == "effort"
    common, balanced = (0, 1) if zero else (1, 0)
    bonds = strokes.at[node]
    source = next(b for b in bonds if (strokes.end[b] == node) == zero)
    sign = {b: 1 if strokes.bonds[b][1] == node else -1 for b in bonds}
    one = sp.Integer(1)
    for bond in bonds:
        if bond != source:
            yield 2 * bond + common, ((2 * source + common, one),)
    balance = tuple((2 * b + balanced, -sign[source] * sign[b] * one) for b in bonds if b != source)
    yield 2 * source + balanced, balance


def _two_port(strokes: Strokes, node: int) -> Iterator[tuple[int, tuple[Term, ...]]]:
    """TF: e_in = m e_out, f_out = m f_in. GY: e_in = r f_out, e_out = r f_in."""
    inward = next(b for b in strokes.at[node] if strokes.bonds[b][1] == node)
    outward = next(b for b in strokes.at[node] if strokes.bonds[b][0] == node)
    value = strokes.elements[node].constant
    e_in, f_in, e_out, f_out = 2 * inward, 2 * inward + 1, 2 * outward, 2 * outward + 1
    gives_e_in = strokes.end[inward] != node
    if not strokes.elements[node].kind.gyrates:
        if gives_e_in:
            yield e_in, ((e_out, value),)
            yield f_out, ((f_in, value),)
        else:
            yield e_out, ((e_in, 1 / value),)
            yield f_in, ((f_out, 1 / value),)
    elif gives_e_in:
        yield e_in, ((f_out, value),)
        yield e_out, ((f_in, value),)
    else:
        yield f_out, ((e_in, 1 / value),)
        yield f_in, ((e_out, 1 / value),)


def loop_rows(equations: CausalEquations, group: Sequence[int]) -> list[dict[int, sp.Expr]]:
    """``1 - W`` of a loop's signals ``s = W s + r``, as sparse rows."""
    place = {signal: at for at, signal in enumerate(group)}
    rows: list[dict[int, sp.Expr]] = []
    for at, signal in enumerate(group):
        row: dict[int, sp.Expr] = {at: sp.Integer(1)}
        for source, factor in equations.terms[signal]:
            if source in place:
                row[place[source]] = row.get(place[source], sp.Integer(0)) - factor
        rows.append(row)
    return rows


def causal_groups(terms: Sequence[Sequence[Term]]) -> Iterator[tuple[int, ...]]:
    """Signals in an order in which each follows from earlier ones; a loop comes as one group."""
    users: list[list[int]] = [[] for _ in terms]
    missing = [len(right) for right in terms]
    for signal, right in enumerate(terms):
        for source, _ in right:
            users[source].append(signal)
    ready = deque(signal for signal, count in enumerate(missing) if count == 0)
    while ready:
        signal = ready.popleft()
        yield (signal,)
        for user in users[signal]:
            missing[user] -= 1
            if missing[user] == 0:
                ready.append(user)
    left = [signal for signal, count in enumerate(missing) if count > 0]
    if left:
        yield from _looped_groups(left, users)


def _looped_groups(left: list[int], users: list[list[int]]) -> Iterator[tuple[int, ...]]:
    rest: nx.DiGraph[int] = nx.DiGraph()
    rest.add_nodes_from(left)
    rest.add_edges_from((signal, user) for signal in left for user in users[signal])
    condensed = nx.condensation(rest)
    first = {group: min(condensed.nodes[group]["members"]) for group in condensed}
    for group in nx.lexicographical_topological_sort(condensed, key=first.__getitem__):
        yield tuple(sorted(condensed.nodes[group]["members"]))

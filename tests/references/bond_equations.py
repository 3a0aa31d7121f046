"""The linear equations of a bond graph, bond by bond, and an exact test of their determinant.

Every bond (u, v) has two unknowns, its effort and its flow; every node contributes as many
equations as it has bonds, so that the system is square. Nothing is eliminated or ordered.

Signs: a bond with an element I, C or R at one end counts as if it pointed into that element.
If both ends are such elements, a 1-junction stands between them: the tail has the same flow
and the opposite effort. The same holds for an I, C or R drawn into a TF or GY: the incoming
effort of the TF or GY is the opposite of the element's.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Sequence
from fractions import Fraction
from heapq import heapify, heappop, heappush
from typing import NamedTuple

import networkx as nx
import sympy

Bond = tuple[str, str]
Value = Fraction | str  # an exact number or the name of a symbol

PRIME = 2**61 - 1
PASSIVE = ("I", "C", "R")
PORTS = (*PASSIVE, "Se", "Sf")
BOTH = ("effort", "flow")


class Term(NamedTuple):
    """A summand `sign * factor * s**order * variable` of a bond equation."""

    bond: Bond
    variable: str  #: "effort" or "flow"
    sign: int = 1
    factor: Value = Fraction(1)
    order: int = 0  #: 1 where a storage differentiates, otherwise 0


def kind(graph: nx.DiGraph[str], node: str) -> str:
    """The kind of a node, as its attributes give it."""
    return str(graph.nodes[node]["kind"])


def is_input(graph: nx.DiGraph[str], node: str) -> bool:
    """Whether a node is a source or an open port, an R without a value."""
    if kind(graph, node) == "R":
        return graph.nodes[node].get("value") is None
    return kind(graph, node) in ("Se", "Sf")


def givable(graph: nx.DiGraph[str], node: str) -> tuple[str, ...]:
    """What a one-port may give, the preferred first: integral for storages, effort for R."""
    if is_input(graph, node):
        gives = str(graph.nodes[node].get("gives", "effort"))
        return ({"Se": "effort", "Sf": "flow", "R": gives}[kind(graph, node)],)
    return BOTH[::-1] if kind(graph, node) == "I" else BOTH


def one_bond(graph: nx.DiGraph[str], node: str) -> Bond:
    """The single bond of a one-port."""
    bonds = [*graph.in_edges(node), *graph.out_edges(node)]
    if len(bonds) != 1:
        raise ValueError(f"one-port {node!r} has {len(bonds)} bonds instead of one")
    tail, head = bonds[0]
    return tail, head


def inward(graph: nx.DiGraph[str], bond: Bond, node: str) -> int:
    """1 if power on the bond counts into the node, otherwise -1."""
    tail, head = bond
    if kind(graph, tail) in PASSIVE and kind(graph, head) not in PASSIVE:
        head = tail
    return 1 if node == head else -1


def equations(graph: nx.DiGraph[str], node: str) -> list[list[Term]]:
    """The homogeneous equations of a node, each a sum that vanishes (at an input: equals it)."""
    what = kind(graph, node)
    if what in ("Zero", "One"):
        return _junction(graph, node, *(BOTH if what == "Zero" else BOTH[::-1]))
    if what in ("TF", "GY"):
        return _two_port(graph, node)
    bond = one_bond(graph, node)
    flow = Term(bond, "flow")
    effort = Term(bond, "effort", inward(graph, bond, node) if what in PASSIVE else 1)
    if is_input(graph, node):
        return [[effort if givable(graph, node) == ("effort",) else flow]]
    value, order = _value(graph, node), int(what != "R")
    if what == "C":
        return [[flow, Term(bond, "effort", -effort.sign, value, order)]]
    return [[effort, Term(bond, "flow", -1, value, order)]]


def _junction(graph: nx.DiGraph[str], node: str, same: str, summed: str) -> list[list[Term]]:
    """All bonds share one variable; the other, counted inwards, adds to zero."""
    bonds = [*graph.in_edges(node), *graph.out_edges(node)]
    balance = [Term(bond, summed, inward(graph, bond, node)) for bond in bonds]
    return [balance, *([Term(bonds[0], same), Term(bond, same, -1)] for bond in bonds[1:])]


def _two_port(graph: nx.DiGraph[str], node: str) -> list[list[Term]]:
    """TF: e_in = m e_out, f_out = m f_in. GY: e_in = r f_out, e_out = r f_in."""
    sources, targets = list(graph.in_edges(node)), list(graph.out_edges(node))
    if len(sources) != 1 or len(targets) != 1:
        raise ValueError(f"{node!r} needs one bond in and one bond out")
    (first,), (second,), value = sources, targets, _value(graph, node)
    effort_in = Term(first, "effort", inward(graph, first, node))
    if kind(graph, node) == "TF":
        return [
            [effort_in, Term(second, "effort", -1, value)],
            [Term(second, "flow"), Term(first, "flow", -1, value)],
        ]
    return [
        [effort_in, Term(second, "flow", -1, value)],
        [Term(second, "effort"), Term(first, "flow", -1, value)],
    ]


def _value(graph: nx.DiGraph[str], node: str) -> Value:
    """The value of a node, exactly."""
    raw = graph.nodes[node].get("value")
    if isinstance(raw, sympy.Symbol):
        return str(raw.name)
    if isinstance(raw, sympy.Rational):
        return Fraction(int(raw.p), int(raw.q))
    if isinstance(raw, sympy.Float):
        return Fraction(float(raw))
    if isinstance(raw, str):
        return raw if raw.isidentifier() else Fraction(raw)
    if isinstance(raw, int | float | Fraction):
        return Fraction(raw)
    raise TypeError(f"node {node!r} has the value {raw!r}: give a number or one name")


def residues(terms: Sequence[Term], seed: int) -> dict[tuple[Bond, str], int]:
    """An equation modulo `PRIME`, with symbols and s replaced by random residues."""
    row: dict[tuple[Bond, str], int] = defaultdict(int)
    for term in terms:
        if isinstance(term.factor, str):
            factor = _random_residue(seed, term.factor)
        else:
            factor = term.factor.numerator * pow(term.factor.denominator, -1, PRIME)
        if term.order:
            factor *= _random_residue(seed, "the frequency s")  # no symbol: it has blanks
        row[term.bond, term.variable] += term.sign * factor
    return {key: entry % PRIME for key, entry in row.items() if entry % PRIME}


def _random_residue(seed: int, name: str) -> int:
    return random.Random(f"{seed}:{name}").randrange(1, PRIME)


def nonsingular(rows: Sequence[dict[tuple[Bond, str], int]]) -> bool:
    """Whether a square system has full rank modulo `PRIME`; sparse, shortest row first."""
    rows = [dict(row) for row in rows]
    holders: dict[tuple[Bond, str], set[int]] = defaultdict(set)
    for k, row in enumerate(rows):
        for key in row:
            holders[key].add(k)
    queue = [(len(row), k) for k, row in enumerate(rows)]
    heapify(queue)
    done: set[int] = set()
    while queue:
        size, k = heappop(queue)
        if k in done or size != len(rows[k]):
            continue  # an entry from before the row changed
        if not size:
            return False
        done.add(k)
        for key in rows[k]:
            holders[key].discard(k)
        pivot = min(rows[k], key=lambda key: len(holders[key]))
        inverse = pow(rows[k][pivot], -1, PRIME)
        for other in list(holders[pivot]):
            row, factor = rows[other], rows[other][pivot] * inverse
            for key, entry in rows[k].items():
                row[key] = (row.get(key, 0) - factor * entry) % PRIME
                holders[key].add(other)
                if not row[key]:
                    del row[key]
                    holders[key].discard(other)
            heappush(queue, (len(row), other))
    return True

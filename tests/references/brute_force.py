"""Bond graphs solved and decided by brute force, as a judge of faster routes.

The equations of all bonds are solved densely at one complex frequency, their rank is found
exactly modulo a prime, and causalities are enumerated one by one: no elimination along causal
paths, no propagation. Signs and conventions are those of `bond_equations`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import networkx as nx
import numpy as np

from .bond_equations import (
    BOTH,
    PASSIVE,
    PORTS,
    Bond,
    Term,
    equations,
    givable,
    inward,
    is_input,
    kind,
    nonsingular,
    one_bond,
    residues,
)

Response = Mapping[str, complex]


@dataclass(frozen=True)
class TransferResult:
    """Responses at one frequency: `effort[u, v][a]` is the effort of bond (u, v) to input a.

    Keys are the bonds as drawn. The values of a bond that ends at one I, C or R count into
    that element, whichever way the bond is drawn.
    """

    inputs: tuple[str, ...]  #: names of sources and open ports, in declaration order
    effort: Mapping[Bond, Response]
    flow: Mapping[Bond, Response]


def transfer(
    graph: nx.DiGraph[str], s: complex, values: Mapping[str, complex | float]
) -> TransferResult:
    """Every bond's response to a unit of each input, at the complex frequency `s` (1/s).

    `values` maps symbol names to numbers. Raises `numpy.linalg.LinAlgError` if the graph is not
    `regular`, or if its matrix is exactly singular at these numbers.
    """
    if not regular(graph):
        raise np.linalg.LinAlgError("the determinant of the bond equations vanishes")
    bonds = list(graph.edges)
    inputs = [node for node in graph if is_input(graph, node)]
    column = {(bond, q): 2 * k + BOTH.index(q) for k, bond in enumerate(bonds) for q in BOTH}
    matrix = np.zeros((len(column), len(column)), dtype=complex)
    right = np.zeros((len(column), len(inputs)), dtype=complex)
    rows = [(node, terms) for node in graph for terms in equations(graph, node)]
    for row, (node, terms) in enumerate(rows):
        for term in terms:
            matrix[row, column[term.bond, term.variable]] += _number(term, s, values)
        if node in inputs:
            right[row, inputs.index(node)] = 1
    scale = np.abs(matrix).max(axis=1, keepdims=True)
    solved = np.linalg.solve(matrix / scale, right / scale).tolist()
    effort, flow = (
        {bond: dict(zip(inputs, solved[column[bond, q]], strict=True)) for bond in bonds}
        for q in BOTH
    )
    return TransferResult(tuple(inputs), effort, flow)


def _number(term: Term, s: complex, values: Mapping[str, complex | float]) -> complex:
    symbol = isinstance(term.factor, str)
    factor = values[str(term.factor)] if symbol else float(term.factor)
    return complex(term.sign * factor * s**term.order)


def port(graph: nx.DiGraph[str], solution: TransferResult, node: str) -> tuple[Response, Response]:
    """Effort and flow of a one-port to every input, power counted into I, C and R.

    At Se and Sf they are those of the bond as it counts.
    """
    bond = one_bond(graph, node)
    sign = inward(graph, bond, node) if kind(graph, node) in PASSIVE else 1
    return {a: sign * e for a, e in solution.effort[bond].items()}, solution.flow[bond]


def regular(graph: nx.DiGraph[str], seed: int = 0) -> bool:
    """Whether the bond equations determine every effort and flow, for general symbols.

    Exact rank modulo `PRIME`: numbers as they are, each symbol and s a random residue that
    depends on `seed` and the name only. True is certain; a false False has a probability below
    4B / 2**61 for B bonds.
    """
    return nonsingular([residues(terms, seed) for n in graph for terms in equations(graph, n)])


def regular_port_choices(graph: nx.DiGraph[str], seed: int = 0) -> list[dict[str, str]]:
    """All choices of what the one-ports give for which the junction structure is regular.

    Each I, C and linear R gives "effort" or "flow"; Se, Sf and open ports are fixed, and listed
    too. Regular: the equations of junctions, TF and GY have one solution once what the ports
    give is known. Lexicographic order: storages in declaration order, integral first, then
    resistances, effort first. Two to the number of free ports trials, so for small graphs.
    """
    inside = [node for node in graph if kind(graph, node) not in PORTS]
    fixed = [residues(terms, seed) for node in inside for terms in equations(graph, node)]
    ports = [node for node in graph if kind(graph, node) in PORTS]
    ports.sort(key=lambda node: kind(graph, node) not in ("I", "C"))
    bonds = [one_bond(graph, node) for node in ports]
    choices = []
    for given in product(*(givable(graph, node) for node in ports)):
        known = [residues([Term(b, q)], seed) for b, q in zip(bonds, given, strict=True)]
        if nonsingular(fixed + known):
            choices.append(dict(zip(ports, given, strict=True)))
    return choices


def valid_strokes(graph: nx.DiGraph[str]) -> list[dict[Bond, str]]:
    """All complete causal assignments, as bond -> the node that receives the effort.

    Each of the 2**B assignments is held against the rule of every node.
    """
    bonds = list(graph.edges)
    ends = {node: [*graph.in_edges(node), *graph.out_edges(node)] for node in graph}
    found = []
    for heads in product(*bonds):
        strokes = dict(zip(bonds, heads, strict=True))
        if all(_obeys(graph, n, [strokes[b] == n for b in ends[n]]) for n in graph):
            found.append(strokes)
    return found


def _obeys(graph: nx.DiGraph[str], node: str, received: list[bool]) -> bool:
    """The causal rule of a node, from whether it receives the effort of each of its bonds."""
    what, count = kind(graph, node), sum(received)
    if what in PORTS:
        return ("flow" if count else "effort") in givable(graph, node)
    return count in {"Zero": (1,), "One": (len(received) - 1,), "TF": (1,), "GY": (0, 2)}[what]


def given_by(graph: nx.DiGraph[str], strokes: Mapping[Bond, str]) -> dict[str, str]:
    """What every one-port gives under an assignment of strokes: "effort" or "flow"."""
    ports = (node for node in graph if kind(graph, node) in PORTS)
    return {n: "flow" if strokes[one_bond(graph, n)] == n else "effort" for n in ports}

"""Random graphs against brute force: acceptance, transfer functions, the choice of causality."""

import random
from fractions import Fraction

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.bond_equations import is_input, kind
from references.brute_force import (
    TransferResult,
    port,
    regular,
    regular_port_choices,
    transfer,
)
from references.build import Graph
from references.matrices import leading_minors, numbers, rationals
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg

REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError)
TOLERANCE = 1e-9
"""Of a response, or of 1 where responses are small: double precision loses up to 1e-12 here."""


def _small(seed: int, largest: int = 14) -> Graph:
    rng = random.Random(seed)
    return random_graph(rng, rng.randint(3, largest), mesh=0.4, symbols=rng.random() < 0.6)


def _ports(graph: Graph) -> list[str]:
    return [node for node in graph if kind(graph, node) in ("Se", "Sf", "I", "C", "R")]


def _derived(graph: Graph) -> bg.StateEquations | None:
    """The equations with every port as an output, None if the graph is refused."""
    try:
        return bg.derive(graph, outputs=_ports(graph))
    except REFUSALS:
        return None


def _values(graph: Graph, rng: random.Random) -> dict[str, float]:
    names = (attributes.get("value") for _, attributes in graph.nodes(data=True))
    return {name: rng.uniform(0.3, 2) for name in names if isinstance(name, str)}


def _responses(equations: bg.StateEquations, s: complex, values: dict[str, float]) -> np.ndarray:
    """Outputs per unit of each input: ``F (s A - J)^-1 (B + s E) + D + s G``."""
    A, J, B, E, F, D, G = (numbers(getattr(equations, name), values) for name in "AJBEFDG")
    if not equations.states:
        return D + s * G
    return F @ np.linalg.solve(s * A - J, B + s * E) + D + s * G


def _received(graph: Graph, judge: TransferResult, node: str, symbol: sp.Symbol) -> dict:
    """What brute force says of the variable that a port receives; e_... is an effort, f_... a flow."""
    effort, flow = port(graph, judge, node)
    return dict(effort if symbol.name.startswith("e_") else flow)


def _assert_same_responses(graph: Graph, equations: bg.StateEquations, rng: random.Random) -> None:
    values = _values(graph, rng)
    s = complex(rng.uniform(0.2, 1), rng.uniform(0.2, 2))
    judge = transfer(graph, s, values)
    got = _responses(equations, s, values)
    column = {node: _column(graph, equations, node) for node in graph if is_input(graph, node)}
    assert set(judge.inputs) == set(column)
    for row, node in enumerate(_ports(graph)):
        expected = _received(graph, judge, node, equations.outputs[row])
        for source, response in expected.items():
            error = abs(got[row, column[source]] - response)
            assert error <= TOLERANCE * max(1, abs(response)), (node, source)


def _column(graph: Graph, equations: bg.StateEquations, node: str) -> int:
    """The input of a source or open port: ``u_<node>``, or what the port gives."""
    gives = graph.nodes[node].get("gives")
    name = {None: f"u_{node}", "effort": f"e_{node}", "flow": f"f_{node}"}[gives]
    return equations.inputs.index(sp.Symbol(name))


@pytest.mark.parametrize("seed", seeds("graphs"))
def test_small_graph_is_derived_as_brute_force_solves_it(seed: int) -> None:
    graph = _small(seed)
    before = nx.DiGraph(graph)
    equations = _derived(graph)
    assert (equations is not None) == regular(graph)
    assert nx.utils.graphs_equal(graph, before)
    if equations is not None:
        _assert_same_responses(graph, equations, random.Random(seed))
    elif graph.number_of_edges() <= 10:
        assert regular_port_choices(graph) == []


@pytest.mark.parametrize("seed", seeds("larger-graphs"))
def test_larger_graph_is_derived_as_brute_force_solves_it(seed: int) -> None:
    rng = random.Random(100_000 + seed)
    graph = random_graph(rng, rng.randint(15, 60), mesh=0.25, symbols=rng.random() < 0.3)
    equations = _derived(graph)
    assert (equations is not None) == regular(graph)
    if equations is not None:
        _assert_same_responses(graph, equations, rng)


def test_random_graphs_are_of_both_sorts() -> None:
    """Of the graphs above some are refused, most are not, and some have dependent storages."""
    accepted = [seed for seed in range(400) if regular(_small(seed))]
    assert 250 < len(accepted) < 380
    dependent = [seed for seed in accepted[:100] if bg.assign_causality(_small(seed)).derivative]
    assert len(dependent) > 20


@pytest.mark.parametrize("seed", seeds("best-causality"))
def test_causality_is_the_best_regular_choice_in_order_of_preference(seed: int) -> None:
    """Storages in declaration order, integral first; then resistances, effort first."""
    graph = _small(seed, largest=9)
    choices = regular_port_choices(graph)
    if not choices:
        with pytest.raises(REFUSALS):
            bg.assign_causality(graph)
        return
    strokes = bg.assign_causality(graph).strokes
    bonds = {node: next(bond for bond in graph.edges if node in bond) for node in choices[0]}
    given = {node: "flow" if strokes[bond] == node else "effort" for node, bond in bonds.items()}
    assert given == choices[0]


def _regular(seed: int, largest: int) -> Graph:
    """The first regular one of a row of random graphs."""
    for attempt in range(seed, seed + 1_000_000, 100_000):
        if regular(graph := _small(attempt, largest)):
            return graph
    raise AssertionError("no regular graph in ten")


def _rationals(graph: Graph, rng: random.Random) -> dict[str, Fraction]:
    return {name: Fraction(rng.randint(1, 30), 10) for name in _values(graph, rng)}


@pytest.mark.parametrize("seed", seeds("mass-matrices"))
def test_mass_matrix_is_symmetric_and_positive_definite_for_positive_storages(seed: int) -> None:
    graph = _regular(seed, largest=20)
    A = rationals(bg.derive(graph).A, _rationals(graph, random.Random(seed)))
    assert A == A.T
    assert all(minor > 0 for minor in leading_minors(A))


@pytest.mark.parametrize("seed", seeds("lossless"))
def test_structure_without_resistances_is_skew_symmetric(seed: int) -> None:
    """Energy is stored or exchanged, never lost: J = -J^T.

    An open port that drives no dependent storage enters by the negative of what it receives:
    its column of B is -F^T of its row.
    """
    graph = _regular(seed, largest=20)
    for _, attributes in graph.nodes(data=True):
        if attributes["kind"] == "R" and "gives" not in attributes:
            attributes["kind"] = "C"
    if not regular(graph):
        return
    equations = bg.derive(graph)
    values = _rationals(graph, random.Random(seed))
    J, B, F = (rationals(getattr(equations, name), values) for name in "JBF")
    assert J == -J.T
    given = [port.element.given for port in equations.ports if port.element.kind == "R"]
    assert len(given) == F.rows
    for row, name in enumerate(given):
        column = equations.inputs.index(name)
        if not equations.E[:, column].todok():
            assert B[:, column] == -F[row, :].T

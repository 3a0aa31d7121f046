"""Names: one quantity each, one set of assumptions each."""

import pytest
import sympy as sp
from references.build import Graph, bond_graph

import bondgraph as bg


def _graph(*nodes: tuple) -> Graph:
    """A 1-junction with a mass and these nodes."""
    graph = bond_graph([bg.One("j"), bg.I("m", "m", flow="v"), *nodes], "j>m")
    graph.add_edges_from(("j", name) for name, _ in nodes)
    return graph


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (bg.R("a", effort="x"), bg.R("b", effort="x")),
        (bg.Se("a", "x"), bg.R("b", effort="x")),
        (bg.R("a", effort="x", law="c*f_a"), bg.R("b", effort="x", law="c*f_b")),
        (bg.C("a", law="q_a", effort="x"), bg.R("b", effort="x")),
    ],
)
def test_variable_that_two_ports_impose_is_refused(first: tuple, second: tuple) -> None:
    with pytest.raises(bg.StructureError, match="'a' and 'b' both impose a variable x"):
        bg.derive(_graph(first, second))


def test_state_of_a_law_is_a_variable_of_its_own() -> None:
    with pytest.raises(bg.StructureError, match=r"'[ak]' and '[ak]' both impose a variable q_k"):
        bg.derive(_graph(bg.C("k", law="q_k/c"), bg.R("a", effort="q_k")))


def test_value_may_not_be_its_own_variable() -> None:
    with pytest.raises(
        bg.StructureError, match="'b': its value is f_b, the name of its own variable"
    ):
        bg.derive(_graph(bg.R("b", "f_b")))


def test_one_symbol_object_for_one_name_is_accepted() -> None:
    inertia = sp.Symbol("J", positive=True)
    graph = _graph(bg.R("b", inertia), bg.C("k", 1 / inertia))
    assert inertia in bg.derive(graph).parameters


@pytest.mark.parametrize("given", [sp.Symbol("J"), "J", sp.Symbol("J", real=True)])
def test_one_name_with_different_assumptions_is_refused(given: object) -> None:
    graph = _graph(bg.R("b", sp.Symbol("J", positive=True)), bg.C("k", given))
    with pytest.raises(bg.StructureError, match=r"'k': the symbol J .* different assumptions"):
        bg.derive(graph)


def test_signal_of_a_law_with_assumptions_is_refused() -> None:
    with pytest.raises(bg.StructureError, match=r"'b': the symbol v .* different assumptions"):
        bg.derive(_graph(bg.R("b", law=sp.Symbol("v", real=True) ** 2)))


def test_law_may_read_the_time() -> None:
    equations = bg.derive(_graph(bg.R("b", law="c*f_b*sin(t)")))
    assert sp.Symbol("t") in equations.laws["b"].free_symbols


def test_three_parts_are_joined_by_what_they_share() -> None:
    """a and b share an input, b and c a law's signal."""
    nodes = [
        bg.Se("sa", "u"), bg.I("a", "1"), bg.Se("sb", "u"), bg.I("b", "1", flow="w"),
        bg.R("rc", law="k*w"), bg.I("c", "1"),
    ]  # fmt: skip
    assert len(bg.derive(bond_graph(nodes, "sa>a sb>b rc>c")).states) == 3

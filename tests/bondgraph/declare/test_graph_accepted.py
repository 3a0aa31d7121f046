"""`validate`: what it hands on, and that the user's graph stays as it was."""

import copy
from fractions import Fraction

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.alsd import alsd_graph
from references.build import bond_graph

import bondgraph as bg


def test_users_graph_is_not_changed() -> None:
    graph = alsd_graph()
    before = copy.deepcopy(graph)
    bg.derive(graph, outputs=["clutch"])
    assert nx.utils.graphs_equal(graph, before)
    assert graph.graph == before.graph
    assert list(graph) == list(before)
    assert list(graph.edges) == list(before.edges)
    assert not nx.is_frozen(graph)


def test_refused_graph_is_not_changed() -> None:
    graph = alsd_graph()
    graph.nodes["I_w2"]["value"] = 0
    before = copy.deepcopy(graph)
    with pytest.raises(bg.StructureError, match="'I_w2'"):
        bg.derive(graph)
    assert nx.utils.graphs_equal(graph, before)


def test_validated_graph_is_frozen() -> None:
    checked = bg.validate(alsd_graph())
    assert nx.is_frozen(checked)
    with pytest.raises(nx.NetworkXError, match=r"[Ff]rozen"):
        checked.add_node("x")


def test_validating_twice_gives_the_same_graph() -> None:
    checked = bg.validate(alsd_graph())
    assert bg.validate(checked) is checked
    assert bg.derive(checked) == bg.derive(alsd_graph())


def test_validated_graph_does_not_follow_the_users_later_changes() -> None:
    graph = alsd_graph()
    checked = bg.validate(graph)
    graph.nodes["I_w1"]["value"] = "other"
    assert checked.nodes["I_w1"]["element"].value == sp.Symbol("I_w1")


def test_graph_that_only_says_it_is_validated_is_validated() -> None:
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.I("m", 0)], "s>j>m")
    graph.graph["validated"] = True
    with pytest.raises(bg.StructureError, match="'m': its value is zero"):
        bg.validate(graph)
    with pytest.raises(bg.StructureError, match="'m': its value is zero"):
        bg.validate(nx.freeze(graph))


def test_bonds_of_passive_elements_point_into_them_and_remember_how_they_were_declared() -> None:
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.I("m", "m")], "s>j m>j")
    checked = bg.validate(graph)
    assert checked.edges["j", "m"]["declared"] == ("m", "j")
    assert checked.edges["s", "j"]["declared"] == ("s", "j")
    assert set(bg.assign_causality(graph).strokes) == {("s", "j"), ("m", "j")}


def test_elements_have_exact_values_and_default_names() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", 0.1, unit="kg"), bg.R(7, "2*b")]
    graph = bond_graph(nodes, "s>j>m")
    graph.add_edge("j", 7)
    checked = bg.validate(graph)
    mass, damper = checked.nodes["m"]["element"], checked.nodes[7]["element"]
    assert (mass.value, mass.unit) == (sp.Rational(1, 10), "kg")
    assert (mass.effort, mass.flow) == sp.symbols("e_m f_m")
    assert damper.value == 2 * sp.Symbol("b")
    assert (damper.effort, damper.flow) == sp.symbols("e_7 f_7")


@pytest.mark.parametrize(
    "value",
    [2, 2.0, Fraction(2), np.float64(2), np.int64(2), "2", "4/2", sp.Integer(2), sp.Float(2)],
)
def test_value_may_be_any_number(value: object) -> None:
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.I("m", value)], "s>j>m")
    assert bg.validate(graph).nodes["m"]["element"].value == 2


def test_negative_and_symbolic_values_are_accepted() -> None:
    nodes = [bg.Se("s", "u"), bg.TF("g", "-n"), bg.I("m", "m_0 + m_1")]
    equations = bg.derive(bond_graph(nodes, "s>g>m"))
    m_0, m_1, n = sp.symbols("m_0 m_1 n")
    assert sp.expand(equations.A[0, 0] - m_0 - m_1) == 0
    assert sp.expand(equations.B[0, 0] + 1 / n) == 0


def test_junction_whose_name_makes_no_symbol_is_accepted() -> None:
    nodes = [bg.Se("s", "u"), bg.One("left wheel"), bg.I("m", "m")]
    graph = bond_graph(nodes, "")
    nx.add_path(graph, ["s", "left wheel", "m"])
    assert bg.derive(graph).A[0, 0] == sp.Symbol("m")


@pytest.mark.parametrize("law", [None, "a*v"])
def test_parts_that_share_an_input_or_a_law_belong_together(law: str | None) -> None:
    """One law reads a speed of the other part; or both parts have one input."""
    second = "u" if law is None else "w"
    nodes = [
        bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.Se("r", second), bg.One("k"),
        bg.I("n", "n"), bg.R("p", law=law),
    ]  # fmt: skip
    assert len(bg.derive(bond_graph(nodes, "s>j>m r>k>n k>p")).states) == 2

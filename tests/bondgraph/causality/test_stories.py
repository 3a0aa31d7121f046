"""Refusals of causality in words: who, where, why."""

import pytest
from references.brute_force import regular, regular_port_choices, valid_strokes
from references.build import Graph, bond_graph

import bondgraph as bg


def _refused(graph: Graph, message: str) -> str:
    """The refusal's text; the refusal is genuine by both judges."""
    assert not regular(graph)
    assert regular_port_choices(graph) == []
    with pytest.raises(bg.CausalityError, match=message) as caught:
        bg.derive(graph)
    return str(caught.value)


def test_two_effort_sources_on_a_0_junction() -> None:
    graph = bond_graph(
        [bg.Se("a", "u"), bg.Se("b", "v"), bg.Zero("n"), bg.R("r", "r")], "a>n b>n n>r"
    )
    assert valid_strokes(graph) == []
    text = _refused(graph, "sources 'a' and 'b' both impose the effort of 0-junction 'n'")
    assert "Zero 'n' takes its effort from one bond only" in text
    assert "but Se 'b' imposes its effort" in text
    assert "Remove one of them" in text


def test_two_flow_sources_on_a_1_junction() -> None:
    graph = bond_graph(
        [bg.Sf("a", "u"), bg.Sf("b", "v"), bg.One("n"), bg.I("m", "m")], "a>n b>n n>m"
    )
    _refused(graph, "sources 'a' and 'b' both impose the flow of 1-junction 'n'")


def test_open_port_against_a_source() -> None:
    graph = bond_graph(
        [bg.Sf("s", "u"), bg.One("n"), bg.R("p", gives="flow"), bg.I("m", "m")], "s>n n>p n>m"
    )
    _refused(graph, "nodes 's' and 'p' both impose the flow of 1-junction 'n'")


def test_two_sources_bonded_to_each_other() -> None:
    text = _refused(bond_graph([bg.Se("a", "u"), bg.Se("b", "v")], "a>b"), "'a' and 'b'")
    assert "Se 'a' imposes its effort" in text


def test_efforts_that_meet_through_a_transformer_and_a_gyrator() -> None:
    nodes = [
        bg.Se("a", "u"), bg.TF("gear", "n"), bg.Zero("z"), bg.GY("motor", "r"), bg.Sf("b", "v"),
        bg.R("r", "r"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "a>gear>z>r b>motor>z")
    text = _refused(graph, "sources 'a' and 'b'")
    assert "TF 'gear' passes causality through" in text
    assert "GY 'motor' gyrates what it receives" in text


@pytest.mark.parametrize(("source", "junction"), [(bg.Se, bg.Zero), (bg.Sf, bg.One)])
def test_long_chain_between_two_sources_is_told_briefly(source, junction) -> None:
    count = 3_000
    names = [f"j{k}" for k in range(count)]
    nodes = [source("a", "u"), source("b", "v"), *(junction(name) for name in names)]
    graph = bond_graph(nodes, ">".join(["a", *names, "b"]))
    with pytest.raises(bg.CausalityError, match="sources 'a' and 'b'") as caught:
        bg.assign_causality(graph)
    assert len(str(caught.value)) < 3_000


def test_bond_is_told_as_it_was_declared() -> None:
    """A one-port drawn as the tail of its bond is counted the other way, not drawn the other way."""
    nodes = [bg.Zero("z"), bg.R("p"), bg.R("q"), bg.R("r", "r")]
    text = _refused(bond_graph(nodes, "p>z q>z r>z"), "'p' and 'q'")
    assert "bond 'p' -> 'z'" in text


def test_of_two_open_ports_on_one_effort_the_later_may_give_its_flow() -> None:
    nodes = [bg.Sf("s", "v"), bg.Zero("z"), bg.C("k", "c"), bg.R("a"), bg.R("b")]
    text = _refused(bond_graph(nodes, "s>z>k z>a z>b"), "nodes 'a' and 'b' both impose the effort")
    assert text.endswith("or let the open port 'b' give its flow (gives='flow')")
    assert bg.derive(bond_graph([*nodes[:-1], bg.R("b", gives="flow")], "s>z>k z>a z>b"))

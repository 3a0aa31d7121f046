"""What a teacher would ask about a graph; and that nothing is asked about graphs that are right."""

import networkx as nx
import pytest
from references.build import Graph, bond_graph
from references.cases import CASES

import bondgraph as bg
from differentials.topologies import catalog, graph

MASS = [bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("damper", "b")]
TWO_MASSES = [
    bg.Se("push", "F"), bg.One("one"), bg.I("m_1", "m_1"), bg.Zero("between"), bg.C("spring", "1/k"),
    bg.One("two"), bg.I("m_2", "m_2"), bg.R("drag", "b"),
]  # fmt: skip
BEFORE = "push>one>m_1 two>m_2 between>spring two>drag"
RIGHT = f"{BEFORE} one>between>two"


def _rules(graph: Graph, kind: str = "doubt") -> list[str]:
    return [one.rule for one in bg.check(graph) if one.kind == kind]


def _variants(name: str) -> list[Graph]:
    full = [True, False] if catalog[name].full else [False]
    return [graph(name, halfshafts, lumped) for halfshafts in full for lumped in (True, False)]


@pytest.mark.parametrize("name", catalog)
def test_nothing_is_doubted_in_the_catalog(name: str) -> None:
    for one in _variants(name):
        assert bg.check(one).doubts == ()


@pytest.mark.parametrize("name", CASES)
def test_nothing_is_doubted_in_textbooks(name: str) -> None:
    case = CASES[name]
    assert bg.check(bond_graph(case.nodes, case.bonds)).doubts == ()


def test_two_masses_with_a_spring_between_are_right() -> None:
    found = bg.check(bond_graph(TWO_MASSES, RIGHT))
    assert (len(found), bool(found), str(found)) == (0, False, "nothing found")


def test_a_sum_of_speeds_where_a_spring_needs_their_difference() -> None:
    (found,) = bg.check(bond_graph(TWO_MASSES, f"{BEFORE} one>between two>between"))
    assert (found.rule, found.bond) == ("supply", ("two", "between"))
    assert "'m_2'" in found.text
    assert "sum of two flows" in found.text
    assert found.way_out == "draw the bond as 'between' -> 'two'"


def test_a_spring_that_both_masses_take_power_from() -> None:
    (found,) = bg.check(bond_graph(TWO_MASSES, f"{BEFORE} between>two between>one"))
    assert (found.rule, found.bond) == ("supply", ("between", "one"))


def test_two_supplies_on_one_node_are_no_doubt() -> None:
    """Two branches, each with a source and a coil, charge one capacitor: a sum of currents."""
    nodes = [
        bg.Se("u_1", "u_1"), bg.One("a"), bg.I("L_1", "L_1"), bg.Zero("node"), bg.C("C", "C"),
        bg.One("b"), bg.I("L_2", "L_2"), bg.Se("u_2", "u_2"),
    ]  # fmt: skip
    assert len(bg.check(bond_graph(nodes, "u_1>a>L_1 a>node>C u_2>b>L_2 b>node"))) == 0


def test_an_arrow_out_of_a_resistance() -> None:
    (found,) = bg.check(bond_graph(MASS, "push>mass>m damper>mass"))
    assert (found.rule, found.bond) == ("arrow", ("damper", "mass"))
    assert found.way_out == "draw the bond as 'mass' -> 'damper'"


def test_an_arrow_out_of_a_storage_into_a_transformer() -> None:
    nodes = [*MASS, bg.TF("lever", "n"), bg.I("J", "J")]
    found = bg.check(bond_graph(nodes, "push>mass>m mass>damper J>lever>mass")).doubts
    assert [one.rule for one in found] == ["arrow"]
    assert "invert its modulus" in found[0].way_out


def test_an_arrow_out_of_a_stop_is_told_as_one() -> None:
    nodes = [*MASS, bg.Stop("wall", high=1)]
    (found,) = bg.check(bond_graph(nodes, "push>mass>m mass>damper wall>mass"))
    assert "Stop 'wall'" in found.text


def test_a_source_that_pulls_alone_and_a_load_beside_one_that_drives() -> None:
    assert _rules(bond_graph(MASS, "mass>push mass>m mass>damper")) == ["source"]
    loaded = bond_graph([*MASS, bg.Se("load", "L")], "push>mass>m mass>damper mass>load")
    assert _rules(loaded) == []


def test_a_junction_with_one_bond() -> None:
    (found,) = bg.check(bond_graph([*MASS, bg.Zero("open")], "push>mass>m mass>damper mass>open"))
    assert (found.rule, found.node) == ("one bond", "open")
    assert "whose flow is zero" in found.text


def test_sources_that_contradict_each_other_are_a_finding_with_the_engines_way_out() -> None:
    nodes = [bg.Se("a", "a"), bg.Se("b", "b"), bg.Zero("n"), bg.R("r", "r")]
    (found,) = bg.check(bond_graph(nodes, "a>n b>n n>r"))
    assert found.rule == "causality"
    assert "both impose the effort of 0-junction 'n'" in found.text
    assert found.way_out.startswith("remove one of them")


def test_what_is_no_bond_graph_is_refused() -> None:
    with pytest.raises(bg.StructureError, match="no kind"):
        bg.check(nx.DiGraph([("a", "b")]))
    checked = bg.validate(bond_graph(MASS, "push>mass>m mass>damper"))
    for judge in (bg.check, bg.merged):
        with pytest.raises(bg.StructureError, match="checked copy"):
            judge(checked)


def test_numbers_that_nothing_reads() -> None:
    graph = bond_graph(MASS, "push>mass>m mass>damper")
    assert len(bg.check(graph, parameters={"m": 1, "b": 2})) == 0
    unread, signal, near = bg.check(graph, parameters={"m": 1, "g": 9.81, "v": 0, "bb": 2})
    assert unread.text == "no value or law reads the parameter g"
    assert signal.text == "v is a signal of the graph, not a parameter"
    assert near.way_out == "correct its name (did you mean 'b'?)"


def test_a_number_for_an_input_is_told_so() -> None:
    (found,) = bg.check(bond_graph(MASS, "push>mass>m mass>damper"), parameters={"F": 1})
    assert "F is a signal" in found.text


def test_findings_are_shown_as_text_and_as_markdown() -> None:
    found = bg.check(bond_graph(MASS, "push>mass>m damper>mass"), parameters={"x_y": 1})
    lines = str(found).splitlines()
    assert [line.split(":")[0] for line in lines] == ["doubt (parameter)", "doubt (arrow)"]
    shown = found._repr_markdown_()
    assert shown.startswith("- **doubt** (parameter): no value or law reads the parameter x\\_y.")
    assert repr(found) == "<Check: 2 findings, 0 strokes>"
    assert bg.check(bond_graph(TWO_MASSES, RIGHT))._repr_markdown_() == "Nothing found."


def test_hints_name_what_merged_takes_out() -> None:
    nodes = [*MASS, bg.One("more"), bg.C("spring", "1/k"), bg.Zero("through"), bg.C("far", "c")]
    found = bg.check(bond_graph(nodes, "push>mass>m mass>damper mass>more>spring more>through>far"))
    assert [(one.kind, one.rule) for one in found] == [
        ("hint", "same kind"),
        ("hint", "pass-through"),
    ]
    assert (found.findings[0].bond, found.findings[1].node) == (("mass", "more"), "through")

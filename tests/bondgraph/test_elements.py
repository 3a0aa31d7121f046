"""The constructors return what networkx takes; defaults are left out."""

import pytest

import bondgraph as bg


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        (bg.Se("s", "u"), ("s", {"kind": "Se", "value": "u"})),
        (bg.Sf("s", 3, unit="m/s"), ("s", {"kind": "Sf", "value": 3, "unit": "m/s"})),
        (bg.I("m", "m_0"), ("m", {"kind": "I", "value": "m_0"})),
        (
            bg.I("m", "m_0", flow="v", priority=-1),
            ("m", {"kind": "I", "value": "m_0", "flow": "v", "priority": -1}),
        ),
        (bg.C("k", law="q_k/c", effort="F"), ("k", {"kind": "C", "effort": "F", "law": "q_k/c"})),
        (bg.R("p"), ("p", {"kind": "R"})),
        (bg.R("p", gives="flow"), ("p", {"kind": "R", "gives": "flow"})),
        (bg.R("r", 2, flow="v"), ("r", {"kind": "R", "value": 2, "flow": "v"})),
        (bg.TF("g", "n"), ("g", {"kind": "TF", "value": "n"})),
        (bg.GY("g", "r"), ("g", {"kind": "GY", "value": "r"})),
        (bg.Zero("z", effort="F"), ("z", {"kind": "Zero", "effort": "F"})),
        (bg.One("j"), ("j", {"kind": "One"})),
    ],
)
def test_constructor_gives_a_node_of_plain_data(node: tuple, expected: tuple) -> None:
    assert node == expected
    assert type(node[1]["kind"]) is str


def test_kinds_are_the_nine_of_the_table() -> None:
    assert [str(kind) for kind in bg.Kind] == ["Se", "Sf", "I", "C", "R", "TF", "GY", "Zero", "One"]


def test_element_without_a_value_says_so() -> None:
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from([bg.Se("s", "u"), bg.I("m", "m")])
    graph.add_edge("s", "m")
    checked = bg.validate(graph)
    assert checked.nodes["m"]["element"].constant == checked.nodes["m"]["element"].value
    with pytest.raises(AttributeError, match="Se 's' has no constant value"):
        _ = checked.nodes["s"]["element"].constant

"""The constructors return what networkx takes; defaults are left out."""

import pytest
from references.build import bond_graph

import bondgraph as bg
from bondgraph.nodes.elements import Element


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


def test_kinds_are_those_of_textbooks_and_a_stop() -> None:
    kinds = ["Se", "Sf", "I", "C", "R", "TF", "GY", "Zero", "One", "De", "Df", "Stop", "Sw",
             "Function", "State", "Controller", "StateMachine", "Hysteresis",
             "RateLimiter", "Delay"]  # fmt: skip
    assert [str(kind) for kind in bg.Kind] == kinds


def _checked(*nodes: tuple) -> dict[object, Element]:
    """The elements of a 1-junction with these nodes."""
    graph = bond_graph([bg.One("j"), *nodes], "")
    graph.add_edges_from(("j", name) for name, _ in nodes)
    return {name: data["element"] for name, data in bg.validate(graph).nodes(data=True)}


def test_element_without_a_value_says_so() -> None:
    elements = _checked(bg.Se("s", "u"), bg.I("m", "m"))
    assert elements["m"].constant == elements["m"].value
    with pytest.raises(AttributeError, match="Se 's' has no constant value"):
        _ = elements["s"].constant


@pytest.mark.parametrize(
    ("node", "given", "received"),
    [
        (bg.Se("a", "u"), "u", "f_a"),
        (bg.Sf("a", "u"), "u", "e_a"),
        (bg.R("a"), "e_a", "f_a"),
        (bg.R("a", gives="flow"), "f_a", "e_a"),
        (bg.I("a", law="p_a/m"), "f_a", "e_a"),
        (bg.C("a", law="q_a/c"), "e_a", "f_a"),
        (bg.I("a", "m"), "None", "None"),
        (bg.R("a", "r"), "None", "None"),
    ],
)
def test_what_an_element_gives_and_receives_where_that_is_fixed(
    node: tuple, given: str, received: str
) -> None:
    element = _checked(node, bg.I("other", 1))["a"]
    assert (str(element.given), str(element.received)) == (given, received)


def test_one_ports_are_all_but_junctions_and_two_ports() -> None:
    elements = _checked(bg.Se("s", "u"), bg.R("r", 1))
    assert {name for name, element in elements.items() if element.one_port} == {"s", "r"}

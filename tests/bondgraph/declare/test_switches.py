"""Switches and controlled junctions as declared: both modes against equations by hand, files, prefixes."""

from typing import Any

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from bondgraph.declare.renaming import Part

C, E, L, R = sp.symbols("C E L R")
FORMS = {"json": (bg.to_json, bg.from_json), "graphml": (bg.to_graphml, bg.from_graphml)}


def _texts(names: tuple[sp.Symbol, ...]) -> list[str]:
    return [str(name) for name in names]


def _charger(**more: object) -> Part:
    """A battery, a key, a resistance, a coil and a capacitor in one loop."""
    nodes = [bg.Se("bat", "E"), bg.One("loop"), bg.Sw("key", on="gate", **more), bg.R("R", "R"),
             bg.I("L", "L", flow="i"), bg.C("c", "C", effort="u")]  # fmt: skip
    return bond_graph(nodes, "bat>loop>key loop>R loop>L loop>c")


def _controlled() -> Part:
    """The loop of battery, resistance and capacitor, itself switched."""
    nodes = [bg.Se("bat", "E"), bg.One("loop", on="gate"), bg.R("R", "R"),
             bg.C("c", "C", effort="u")]  # fmt: skip
    return bond_graph(nodes, "bat>loop>R loop>c")


def _shorted() -> Part:
    """A pump, a resistance and a tank at one node, itself switched."""
    nodes = [bg.Sf("pump", "Q"), bg.Zero("node", on="gate"), bg.R("R", "R"),
             bg.C("c", "C", effort="u")]  # fmt: skip
    return bond_graph(nodes, "pump>node>R node>c")


def test_a_closed_switch_gives_no_effort() -> None:
    """L i' = E - R i - u less the switch's own effort, C u' = i."""
    closed = bg.derive(bg.in_mode(_charger(), ["key"]))
    assert _texts(closed.states) == ["i", "u"]
    assert _texts(closed.inputs) == ["E", "e_key"]
    assert sp.diag(L, C) == closed.A
    assert sp.Matrix([[-R, -1], [1, 0]]) == closed.J
    assert sp.Matrix([[1, -1], [0, 0]]) == closed.B
    assert closed.laws["key"] == bg.ExpressionLaw(sp.Integer(0))


def test_an_open_switch_gives_no_flow_and_makes_the_coil_dependent() -> None:
    """C u' = f_key; the coil's current is the switch's, its effort L f_key' across the switch."""
    opened = bg.derive(bg.in_mode(_charger()), outputs=["key"])
    assert _texts(opened.states) == ["u"]
    assert _texts(opened.inputs) == ["E", "f_key"]
    assert sp.Matrix([[C]]) == opened.A
    assert sp.Matrix([[0]]) == opened.J
    assert sp.Matrix([[0, 1]]) == opened.B
    assert _texts(opened.outputs) == ["e_key"]
    # e_key = E - R f_key - u - L f_key'
    assert sp.Matrix([[-1]]) == opened.F
    assert sp.Matrix([[1, -R]]) == opened.D
    assert sp.Matrix([[0, -L]]) == opened.G


def test_a_controlled_one_junction_is_a_loop_or_none() -> None:
    on = bg.derive(bg.in_mode(_controlled(), ["loop"]))
    assert _texts(on.inputs) == ["E", "e_loop_switch"]
    assert (sp.Matrix([[C]]), sp.Matrix([[-1 / R]])) == (on.A, on.J)
    assert sp.Matrix([[1 / R, -1 / R]]) == on.B
    off = bg.derive(bg.in_mode(_controlled()))
    assert _texts(off.inputs) == ["E", "f_loop_switch"]
    assert (sp.Matrix([[C]]), sp.zeros(1), sp.Matrix([[0, 1]])) == (off.A, off.J, off.B)


def test_a_controlled_zero_junction_is_a_node_or_the_ground() -> None:
    on = bg.derive(bg.in_mode(_shorted(), ["node"]))
    assert _texts(on.inputs) == ["Q", "f_node_switch"]
    assert (sp.Matrix([[C]]), sp.Matrix([[-1 / R]])) == (on.A, on.J)
    assert sp.Matrix([[1, -1]]) == on.B
    off = bg.derive(bg.in_mode(_shorted()))
    assert off.states == ()
    assert _texts(off.inputs) == ["Q", "e_node_switch"]


def test_names_are_the_same_in_all_modes() -> None:
    one, other = (bg.derive(bg.in_mode(_charger(), on)) for on in ([], ["key"]))
    assert set(one.signals) == set(other.signals)


def test_the_graph_itself_stays_as_it_was() -> None:
    graph = _charger()
    before: Part = nx.DiGraph(graph)
    bg.in_mode(graph, ["key"])
    assert nx.utils.graphs_equal(graph, before)
    assert list(bg.in_mode(graph, ["key"])) == list(graph)


def test_a_graph_in_a_mode_has_no_switches_left() -> None:
    settled = bg.in_mode(_charger(), ["key"])
    assert bg.switches(settled) == ()
    with pytest.raises(bg.StructureError, match="'key' is no switch of this graph; there are none"):
        bg.in_mode(settled, ["key"])


def test_switches_are_listed_with_their_conditions() -> None:
    (key,) = bg.switches(_charger(off="f_key - 2"))
    assert (key.name, key.gives) == ("key", "effort")
    assert (key.on, key.off) == (sp.Symbol("gate"), sp.Symbol("f_key") - 2)
    (loop,), (node,) = bg.switches(_controlled()), bg.switches(_shorted())
    assert (loop.name, loop.gives, loop.off) == ("loop", "effort", -sp.Symbol("gate"))
    assert (node.name, node.gives) == ("node", "flow")


@pytest.mark.parametrize(
    ("on", "message"),
    [
        (["kee"], "'kee' is no switch of this graph; there are 'key'"),
        (["R"], "'R' is no switch of this graph; there are 'key'"),
        ("key", "on must be a list of switches, not 'key'"),
        (3, "on must be a list of switches, not 3"),
    ],
)  # fmt: skip
def test_what_is_no_switch_is_refused(on: Any, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        bg.in_mode(_charger(), on)


def test_the_port_of_a_controlled_junction_is_no_name_of_its_own() -> None:
    with pytest.raises(bg.StructureError, match=r"'loop_switch' is no switch .* there are 'loop'"):
        bg.in_mode(_controlled(), ["loop_switch"])


def test_a_graph_in_no_mode_has_one_set_of_equations_for_both() -> None:
    """L i' = E - R i - u - e_key, whatever keeps i at zero while the key is open."""
    whole = bg.derive(_charger())
    assert (_texts(whole.states), _texts(whole.inputs)) == (["i", "u"], ["E", "e_key"])
    assert (sp.diag(L, C), sp.Matrix([[-R, -1], [1, 0]])) == (whole.A, whole.J)
    assert sp.Matrix([[1, -1], [0, 0]]) == whole.B
    assert whole.laws == {}


@pytest.mark.parametrize(
    ("node", "message"),
    [
        (bg.Sw("q", None), "node 'q' has no condition on"),
        (bg.Sw("q", None, off="x"), "node 'q' has no condition on"),
        (bg.One("q", off="x"), "node 'q' has no condition on"),
        (bg.Zero("q", off="x"), "node 'q' has no condition on"),
        (bg.Sw("q", "a > b"), "node 'q', on: 'a > b' is not allowed"),
        (bg.Sw("q", "a", off=True), "node 'q', off: True is neither a number"),
        (bg.Sw("q", "a", value=2), "unknown attribute 'value'; kind Sw may have"),
        (bg.Sw("q", "a", unit="V"), "unknown attribute 'unit'; kind Sw may have"),
        (bg.R("q", 2, on="a"), "unknown attribute 'on'; kind R may have"),
        (bg.Sw("q", sp.Symbol("a", positive=True), off=sp.Symbol("a")), "different assumptions"),
        (bg.Sw("q", sp.Symbol("r", positive=True)), "the symbol r is used elsewhere with diff"),
        (bg.Sw("q", sp.Symbol("f_q", real=True)), "the symbol f_q is used elsewhere with diff"),
        (bg.Sw("q", "a", effort="u"), "'s' and 'q' both impose a variable u"),
        (bg.Sw("q", "a", flow="t"), "'t' is the time"),
    ],
)  # fmt: skip
def test_wrong_declarations_are_refused(node: bg.nodes.elements.Node, message: str) -> None:
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.R("r", "r"), node], "s>j>r j>q")
    with pytest.raises(bg.StructureError, match=message):
        bg.in_mode(graph)


def test_the_port_of_a_controlled_junction_must_be_free() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j", on="gate"), bg.R("j_switch", "r")]
    with pytest.raises(bg.StructureError, match="two nodes are called 'j_switch'"):
        bg.switches(bond_graph(nodes, "s>j>j_switch"))


def test_a_switch_has_one_bond() -> None:
    nodes = [bg.Se("s", "u"), bg.Sw("q", "gate"), bg.R("r", "r")]
    with pytest.raises(bg.StructureError, match="'q' has 2 bonds; it needs exactly one"):
        bg.switches(bond_graph(nodes, "s>q>r"))


def _with_everything() -> Part:
    """Switches with and without ``off``, both controlled junctions, storages with inverses."""
    nodes = [
        bg.Se("s", "u"), bg.One("j", on="u - u_0", off="i_d"), bg.R("r", "r"),
        bg.Sw("d", on="e_d", off=-sp.Symbol("i_d"), flow="i_d"), bg.Zero("z", on="sin(w*t)"),
        bg.Sw("k", on=sp.Rational(1, 3), effort="u_k"),
        bg.C("spring", law="k*q_spring**3", inverse="sign(e_spring)*(abs(e_spring)/k)**(1/3)"),
        bg.One("m"), bg.I("wheel", law="p_wheel/J", inverse="J*omega", flow="omega"),
    ]  # fmt: skip
    return bond_graph(nodes, "s>j>r j>d j>z>spring z>k z>m>wheel")


@pytest.mark.parametrize("form", FORMS)
def test_conditions_and_inverses_come_back_from_files(form: str) -> None:
    to_text, from_text = FORMS[form]
    graph = _with_everything()
    text = to_text(graph)
    back = from_text(text)
    assert to_text(back) == text
    assert bg.switches(back) == bg.switches(graph)
    one, other = bg.validate(graph), bg.validate(back)
    assert [one.nodes[n]["element"] for n in one] == [other.nodes[n]["element"] for n in other]
    assert list(one.edges) == list(other.edges)
    assert other.nodes["spring"]["element"].inverse == sp.sympify(
        "sign(e_spring)*(Abs(e_spring)/k)**Rational(1,3)"
    )
    assert back.nodes["wheel"]["inverse"] == "J*omega"


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("key", ["on", "off"])
def test_conditions_in_pieces_come_back(form: str, key: str) -> None:
    graph = _charger()
    graph.nodes["key"][key] = sp.Piecewise((1, sp.Symbol("u") > 0), (-1, True))
    to_text, from_text, *_ = FORMS[form]
    back = from_text(to_text(graph))
    assert bg.expression(back.nodes["key"][key], "here") == graph.nodes["key"][key]


def test_prefixes_reach_conditions_and_inverses() -> None:
    copy = bg.prefixed(_with_everything(), "l_", parameters=["u_0"])
    found = {switch.name: (str(switch.on), str(switch.off)) for switch in bg.switches(copy)}
    assert found["l_j"] == ("l_u - l_u_0", "l_i_d")
    assert found["l_d"] == ("e_l_d", "-l_i_d")
    assert found["l_z"] == ("sin(t*w)", "-sin(t*w)")
    assert str(copy.nodes["l_wheel"]["inverse"]) == "J*l_omega"
    assert copy.nodes["l_spring"]["inverse"] == sp.sympify(
        "sign(e_l_spring)*(Abs(e_l_spring)/k)**Rational(1,3)"
    )
    assert copy.nodes["l_k"] == {"kind": "Sw", "on": sp.Rational(1, 3), "effort": "l_u_k"}


def test_prefixes_reach_the_names_of_controlled_junctions_ports() -> None:
    """A One that carries current until it falls to zero: its own port's default names move with it."""
    graph = _controlled()
    graph.nodes["loop"].update(on="e_loop_switch", off="-f_loop_switch")
    copy = bg.prefixed(graph, "l_")
    (switch,) = bg.switches(copy)
    assert (str(switch.on), str(switch.off)) == ("e_l_loop_switch", "-f_l_loop_switch")

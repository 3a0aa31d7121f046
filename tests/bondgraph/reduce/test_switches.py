"""The ports of equations that switch: which way is held, and what changes each of them over."""

from dataclasses import replace
from typing import Any

import pytest
import sympy as sp
from references.build import Graph, bond_graph
from references.random_switches import random_switched

import bondgraph as bg
from bondgraph.declare.validate import validate, with_elements
from bondgraph.nodes.elements import Node


def _series(node: Node, *more: Node) -> Graph:
    """A source, a resistance of 2, a coil and the node in one loop: the node gives an effort."""
    nodes = [bg.Se("s", "u"), bg.One("j", flow="i"), bg.R("r", 2), bg.I("L", "L", flow="i_L"), node]
    bonds = " ".join(f"j>{name}" for name, _ in more)
    return bond_graph([*nodes, *more], f"s>j>r j>L j>{node[0]} {bonds}")


def _across(node: Node) -> Graph:
    """A source, a resistance and a capacitor with the node across it: the node gives a flow."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.R("r", "R"), bg.Zero("z", effort="v"),
             bg.C("c", "C", effort="v_c"), node]  # fmt: skip
    return bond_graph(nodes, f"s>j>r j>z>c z>{node[0]}")


def _one(graph: Graph) -> bg.SwitchPort:
    (found,) = bg.derive(graph).switches
    return found


def test_an_effort_form_is_held_while_it_is_off() -> None:
    one = _one(_series(bg.Sw("k", on="gate", off="1/2 - gate")))
    gate = sp.Symbol("gate")
    assert (one.name, one.on, one.off) == ("k", gate, sp.Rational(1, 2) - gate)
    assert (one.gives, one.held, one.guard, one.side) == ("effort", "off", "commanded", 0)
    assert (one.port.given, one.port.received) == sp.symbols("e_k f_k")


def test_a_flow_form_is_held_while_it_is_on() -> None:
    one = _one(_across(bg.Sw("k", on="gate")))
    assert (one.gives, one.held, one.guard) == ("flow", "on", "commanded")
    assert (one.port.given, one.port.received) == sp.symbols("f_k e_k")


def test_controlled_junctions_are_held_as_what_they_give_tells() -> None:
    """A loop that is off carries no flow, a node that is off has no effort."""
    loop = [bg.Se("s", "u"), bg.One("j", on="g"), bg.I("L", "L"), bg.R("r", "R")]
    one = _one(bond_graph(loop, "s>j>L j>r"))
    assert (one.name, one.gives, one.held) == ("j", "effort", "off")
    node = [bg.Sf("s", "u"), bg.Zero("j", on="g"), bg.C("c", "C"), bg.R("r", "R")]
    one = _one(bond_graph(node, "s>j>c j>r"))
    assert (one.name, one.gives, one.held) == ("j", "flow", "off")
    one = _one(bond_graph([*node[:2], bg.I("L", "L")], "s>j>L"))
    assert (one.name, one.gives, one.held) == ("j", "effort", "on")


def test_ports_that_switch_come_in_declaration_order() -> None:
    graph = _series(bg.Diode("b"), bg.R("p"), bg.Sw("a", on="g"))
    assert [one.name for one in bg.derive(graph).switches] == ["b", "a"]
    assert [port.element.name for port in bg.derive(graph).ports] == ["s", "b", "p", "a"]


@pytest.mark.parametrize(
    ("on", "off", "side"),
    [
        ("e_k", "-f_k", 1), ("2*e_k", "-f_k/3", 1), ("-e_k", "f_k", -1), ("e_k/7", "-3*f_k", 1),
        # The same quantities under other names: the loop's, the coil's flow, the resistance's effort 2 i.
        ("e_k", "-i", 1), ("e_k", "-i_L", 1), ("e_k", "-e_r", 1), ("-e_k", "f_s", -1),
        ("e_k + i - i_L", "-2*f_k + i", 1), ("e_k", sp.Symbol("w", positive=True) * sp.Symbol("i") * -1, 1),
        ("w**2*e_k/w**2", "-f_k", 1),
        # Turned one way only, another port's, a threshold, a factor of unknown sign, no multiple at all.
        ("e_k", "f_k", 0), ("-e_k", "-f_k", 0), ("f_k", "-e_k", 0), ("e_k", "-e_k", 0), ("e_L", "-f_k", 0),
        ("e_k - 1/10", "-f_k", 0), ("e_k", "-f_k - i_0", 0), ("w*e_k", "-w*f_k", 0), ("e_k*f_k", "-f_k", 0),
        ("e_k**3", "-f_k", 0), ("abs(e_k)", "-f_k", 0), ("e_k - e_k + t*f_k", "-f_k", 0),
        ("e_k + u", "-f_k", 0), ("e_k + e_r", "-f_k", 0), ("-e_L", "-f_k", 0), ("e_k", "u - f_k", 0),
    ],
)  # fmt: skip
def test_one_sided_switches_are_recognised_exactly(on: Any, off: Any, side: int) -> None:
    one = _one(_series(bg.Sw("k", on=on, off=off)))
    assert (one.guard, one.side) == (("one-sided" if side else "general"), side)


@pytest.mark.parametrize(
    ("on", "off", "side"),
    # On, its effort is held at zero and f_k >= 0; off, it gives f_k = 0 and receives e_k <= 0.
    [
        ("e_k", "-f_k", -1),
        ("-e_k", "f_k", 1),
        ("v", "-f_k", -1),
        ("v_c", "-f_k", -1),
        ("u", "-f_k", 0),
    ],
)
def test_in_flow_form_the_side_is_told_by_what_is_given(on: str, off: str, side: int) -> None:
    one = _one(_across(bg.Sw("k", on=on, off=off)))
    assert (one.held, one.side) == ("on", side)


@pytest.mark.parametrize("turned", [False, True])
def test_an_arrow_turned_round_changes_nothing(turned: bool) -> None:
    """Power counts into a switch whichever way its bond is drawn."""
    graph = _series(bg.Diode("d"))
    if turned:
        graph.remove_edge("j", "d")
        graph.add_edge("d", "j")
    assert _one(graph).side == 1


@pytest.mark.parametrize("make", [bg.Zero, bg.One])
def test_a_controlled_junction_can_be_one_sided(make: Any) -> None:
    """A loop that carries flow until it reverses; a node that holds pressure until that reverses."""
    common, other = ("e", "f") if make is bg.Zero else ("f", "e")
    junction = make("j", on=f"{other}_j_switch", off=f"-{common}_j_switch")
    nodes = [bg.Se("s", "u"), junction, bg.R("r", "R"), bg.One("end"), bg.I("L", "L")]
    one = _one(bond_graph(nodes, "s>end>j>r end>L"))
    assert (one.guard, one.name) == ("one-sided", "j")
    assert one.side == (1 if one.held == "off" else -1)
    wrong = make("j", on=f"{common}_j_switch", off=f"-{other}_j_switch")
    assert _one(bond_graph([nodes[0], wrong, *nodes[2:]], "s>end>j>r end>L")).guard == "general"


@pytest.mark.parametrize(
    ("on", "off", "guard"),
    [
        ("gate", None, "commanded"), ("sin(w*t) - d", None, "commanded"), ("1", "-1", "commanded"),
        ("u - u_0", None, "commanded"), ("i - 1", None, "general"), ("gate", "i", "general"),
        ("gate - e_known", None, "general"), ("q_store - 1", None, "general"), ("gate", "angle", "general"),
        ("gate", "e_open", "general"),
    ],
)  # fmt: skip
def test_what_comes_from_outside_commands(on: str, off: str | None, guard: str) -> None:
    """An open source's input does; a known source, a law's state, an integral, an open port do not."""
    more = [bg.Se("known", "3*t"), bg.C("store", law="k*q_store**3"), bg.Df("turned", integrate="angle"),
            bg.R("open")]  # fmt: skip
    assert _one(_series(bg.Sw("k", on=on, off=off), *more)).guard == guard


@pytest.mark.parametrize(
    ("node", "held", "free"),
    [
        (bg.Diode("k"), "-e_k", "f_k"),
        (bg.CheckValve("k"), "-e_k", "f_k"),
        (bg.Freewheel("k"), "e_k", "-f_k"),
    ],
)
def test_constructors_say_which_way_they_hold(node: Node, held: str, free: str) -> None:
    """Held, ``held`` is not negative; let go, ``free`` is not."""
    one = _one(_series(node))
    assert (one.guard, one.held) == ("one-sided", "off")
    given, received = one.port.given, one.port.received
    assert -one.side * given == sp.sympify(held)
    assert one.side * received == sp.sympify(free)


def test_constructors_take_names_of_their_own() -> None:
    name, attributes = bg.Freewheel("fw", effort="tau", flow=sp.Symbol("slip_speed"))
    assert attributes == {"kind": "Sw", "on": "-tau", "off": sp.Symbol("slip_speed"),
                          "effort": "tau", "flow": sp.Symbol("slip_speed")}  # fmt: skip
    assert _one(_series((name, attributes))).side == -1
    with pytest.raises(bg.StructureError, match="rename the node, or name its effort and flow"):
        bg.derive(_series(bg.Diode("a-b")))
    assert _one(_series(bg.Diode("a-b", effort="e_d", flow="f_d"))).side == 1
    assert bg.Diode(3)[1]["off"] == "-f_3"


def test_prefixes_keep_a_one_way_switch_one_sided() -> None:
    copy = bg.prefixed(_series(bg.Freewheel("fw")), "l_")
    assert _one(copy).side == -1


@pytest.mark.parametrize("form", ["json", "graphml"])
def test_files_keep_a_one_way_switch_one_sided(form: str) -> None:
    write, read = getattr(bg, f"to_{form}"), getattr(bg, f"from_{form}")
    graph = _series(bg.Diode("d", flow="i_d"), bg.Freewheel("fw"))
    back = read(write(graph))
    assert write(back) == write(graph)
    assert [(one.name, one.side) for one in bg.derive(back).switches] == [("d", 1), ("fw", -1)]


def test_a_switch_that_drives_a_dependent_storage_is_refused() -> None:
    """No graph leads to one: here the switch across a capacitor is made to give its effort."""
    checked = validate(_across(bg.Sw("k", on="gate")))
    forced = replace(checked.nodes["k"]["element"], gives="effort")
    with pytest.raises(bg.DependentSourceError, match="the switch 'k' drives a dependent storage"):
        bg.derive(with_elements(checked, {"k": forced}))


def test_equations_with_switches_are_shown_as_they_stand() -> None:
    """R C v' = u - v - R f_k, by hand, in every view."""
    equations = bg.derive(_across(bg.Sw("k", on="gate")))
    assert str(equations).splitlines()[0].startswith("[ C ] [v_c'] = [ -1/R ]")
    u, v, R, C, f = sp.symbols("u v_c R C f_k")
    assert sp.cancel(bg.explicit(equations)[v] - (u - v - R * f) / (R * C)) == 0
    assert r"f_{k}" in bg.latex(equations)
    lines = [
        (line.kind, str(line.symbol))
        for line in bg.assignments(_across(bg.Sw("k", on="gate")))
        if line.kind == "given"
    ]
    assert lines == [("given", "u"), ("given", "v_c"), ("given", "f_k")]


@pytest.mark.parametrize("seed", range(12))
def test_files_and_prefixes_leave_random_switches_as_they_are(seed: int) -> None:
    graph = random_switched(seed)
    try:
        equations = bg.derive(graph)
    except (bg.CausalityError, bg.AlgebraicLoopError):
        return
    for write, read in ((bg.to_json, bg.from_json), (bg.to_graphml, bg.from_graphml)):
        back = bg.derive(read(write(graph)))
        assert back.switches == equations.switches
        assert (back.A, back.J, back.B, back.F) == (
            equations.A, equations.J, equations.B, equations.F,
        )  # fmt: skip
    copy = bg.derive(bg.prefixed(graph, "p_"))
    assert [one.name for one in copy.switches] == [f"p_{one.name}" for one in equations.switches]
    assert [(one.gives, one.held, one.guard) for one in copy.switches] == [
        (one.gives, one.held, one.guard) for one in equations.switches
    ]
    assert (copy.A, copy.J, copy.B) == (equations.A, equations.J, equations.B)


@pytest.mark.parametrize("seed", range(12))
def test_random_graphs_with_switches_are_drawn_with_every_stroke(seed: int) -> None:
    """A stroke at the end that receives the effort: at the switch where that gives its flow."""
    graph = random_switched(seed)
    try:
        equations = bg.derive(graph)
    except (bg.CausalityError, bg.AlgebraicLoopError):
        return
    drawn = bg.drawing(graph)
    assert drawn.subject.remark == ""
    assert all(bond.stroke is not None for bond in drawn.scene.bonds)
    places = {item.name: at for at, item in enumerate(drawn.subject.items)}
    for one in equations.switches:
        at = places[one.port.element.name]
        assert drawn.subject.items[at].symbol == "Sw"
        (link,) = (link for link in drawn.subject.links if at in (link.tail, link.head))
        assert (link.receiver == at) == (one.gives == "flow")

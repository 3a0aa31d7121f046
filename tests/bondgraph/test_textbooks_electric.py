"""Circuits and electric machines of textbooks, against Kirchhoff's laws and Newton's."""

from collections.abc import Hashable

import networkx as nx
import sympy as sp
from references.build import Node, bond_graph
from references.matrices import differences
from references.textbook import agree, rates, s, transfer
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED


def _is(found: sp.Expr, text: str) -> bool:
    return bool(sp.cancel(found - bg.expression(text, "expected")) == 0)


def test_two_resistances_and_no_storage_between_them() -> None:
    """After Borutzky, Bond Graph Methodology: an algebraic loop of two resistors beside L and C.

    Kirchhoff at the node: ``(E_0 - u)/R_1 = u/R_2 + i``.
    """
    nodes: list[Node] = [
        bg.Se("source", "E_0"), bg.One("in"), bg.R("R1", "R_1"), bg.Zero("node"), bg.R("R2", "R_2"),
        bg.One("branch"), bg.I("L", "L_0"), bg.C("C", "C_0"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>in>R1 in>node>R2 node>branch>L branch>C")
    agree(
        rates(graph),
        {"p_L": "R_2*(E_0 - R_1*p_L/L_0)/(R_1 + R_2) - q_C/C_0", "q_C": "p_L/L_0"},
    )
    node = bg.derive(graph, outputs=["node"])
    assert differences(node.D, [[bg.expression("R_2/(R_1 + R_2)", "D")]]) == {}


def test_two_capacitors_in_a_loop_with_a_source() -> None:
    """After Borutzky: causality conflict; ``(C_1 + C_2) u_2' = C_1 E_0' - u_2/R_0``.

    The source gives ``i = C_2 u_2' + u_2/R_0``.
    """
    nodes: list[Node] = [
        bg.Se("source", "E_0"), bg.One("loop"), bg.C("C1", "C_1", priority=-1), bg.Zero("node"),
        bg.C("C2", "C_2", effort="u_2"), bg.R("R", "R_0"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>loop>C1 loop>node>C2 node>R")
    causal = bg.assign_causality(graph)
    assert (causal.integral, causal.derivative) == (("C2",), ("C1",))
    equations = bg.derive(graph, outputs=["source"])
    C_1, C_2, R_0 = sp.symbols("C_1 C_2 R_0")
    assert differences(equations.A, [[C_1 + C_2]]) == {}
    assert differences(equations.J, [[-1 / R_0]]) == {}
    assert differences(equations.E, [[C_1]]) == {}
    assert equations.B.todok() == {}
    assert _is(transfer(equations), "C_1*s*(C_2*s + 1/R_0)/((C_1 + C_2)*s + 1/R_0)")
    assert differences(equations.G, [[C_1 * C_2 / (C_1 + C_2)]]) == {}


def test_three_inductors_at_a_node() -> None:
    """After Borutzky: the currents of a cut set are dependent; ``i_1 = i_2 + i_3``."""
    nodes: list[Node] = [bg.Se("source", "E_0"), bg.Zero("node"), bg.One("one"),
                         bg.I("L1", "L_1", priority=-1)]  # fmt: skip
    bonds = "source>one>L1 one>node "
    for at in (2, 3):
        nodes += [bg.One(f"arm{at}"), bg.I(f"L{at}", f"L_{at}", flow=f"i_{at}"),
                  bg.R(f"R{at}", f"R_{at}")]  # fmt: skip
        bonds += f"node>arm{at}>L{at} arm{at}>R{at} "
    equations = bg.derive(bond_graph(nodes, bonds), outputs=["source"])
    L_1, L_2, L_3, R_2, R_3 = sp.symbols("L_1 L_2 L_3 R_2 R_3")
    assert equations.states == sp.symbols("i_2 i_3")
    assert differences(equations.A, [[L_1 + L_2, L_1], [L_1, L_1 + L_3]]) == {}
    assert differences(equations.J, sp.diag(-R_2, -R_3)) == {}
    assert differences(equations.B, [[1], [1]]) == {}
    assert differences(equations.F, [[1, 1]]) == {}


def _bridge(detector: Node, *more: Node) -> "nx.DiGraph[Hashable]":
    """Four arms: R_1, R_2 from the source to nodes a and b, and from there two to ground."""
    nodes: list[Node] = [
        bg.Se("source", "E_0"), bg.Zero("top"), bg.One("ta"), bg.R("R1", "R_1"), bg.One("tb"),
        bg.R("R2", "R_2"), bg.Zero("a"), bg.R("R3", "R_3"), bg.Zero("b"), bg.One("ab"), detector,
        *more,
    ]  # fmt: skip
    bonds = f"source>top>ta>a>R3 ta>R1 top>tb>b tb>R2 a>ab>b ab>{detector[0]} "
    return bond_graph(nodes, bonds + " ".join(f"b>{name}" for name, _ in more))


def test_wheatstones_bridge() -> None:
    """A classical circuit; the galvanometer's current by Thevenin."""
    graph = _bridge(bg.R("Rg", "R_g", flow="i_g"), bg.R("R4", "R_4"))
    equations = bg.derive(graph, outputs=["ab"])
    assert equations.states == ()
    loops = "R_g*(R_1 + R_3)*(R_2 + R_4) + R_1*R_3*(R_2 + R_4) + R_2*R_4*(R_1 + R_3)"
    assert _is(equations.D[0, 0], f"(R_2*R_3 - R_1*R_4)/({loops})")


def test_a_bridge_with_a_coil_and_a_capacitor() -> None:
    """The same bridge: a coil as detector, a capacitor in the fourth arm; nodes by Kirchhoff.

    ``u_a = (E_0/R_1 - i) R_1 R_3/(R_1 + R_3)``, ``C_4 u_b' = (E_0 - u_b)/R_2 + i``.
    """
    found = rates(_bridge(bg.I("L", "L_g", flow="i"), bg.C("C4", "C_4", effort="u_b")), False)
    agree(
        found,
        {
            "i": "((E_0/R_1 - i)*R_1*R_3/(R_1 + R_3) - u_b)/L_g",
            "u_b": "((E_0 - u_b)/R_2 + i)/C_4",
        },
    )


def test_a_passive_circuit_of_a_coil_beside_a_divider() -> None:
    """After Cellier, Continuous System Modeling: L across the source, R_1 in front of C and R_2.

    ``C u' = (U_0 - u)/R_1 - u/R_2``, ``L i' = U_0``; the source gives ``i + (U_0 - u)/R_1``.
    """
    nodes: list[Node] = [
        bg.Se("source", "U_0"), bg.Zero("top"), bg.I("L", "L_0", flow="i"), bg.One("down"),
        bg.R("R1", "R_1"), bg.Zero("node"), bg.C("C", "C_0", effort="u"), bg.R("R2", "R_2"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>top>L top>down>R1 down>node>C node>R2")
    equations = bg.derive(graph, outputs=["source"])
    L_0, C_0, R_1, R_2 = sp.symbols("L_0 C_0 R_1 R_2")
    assert equations.states == sp.symbols("i u")
    assert differences(equations.A, sp.diag(L_0, C_0)) == {}
    assert differences(equations.J, sp.diag(0, -1 / R_1 - 1 / R_2)) == {}
    assert differences(equations.B, [[1], [1 / R_1]]) == {}
    assert differences(equations.F, [[1, -1 / R_1]]) == {}
    assert differences(equations.D, [[1 / R_1]]) == {}


def test_a_ladder_of_three_cells() -> None:
    """After Gawthrop and Smith, Metamodelling, RC circuits: the ladder's 1, 6, 5, 1 by Kirchhoff."""
    nodes: list[Node] = [bg.Se("source", "u")]
    bonds = ""
    before = "source"
    for at in (1, 2, 3):
        nodes += [bg.One(f"j{at}"), bg.R(f"R{at}", "R_0"), bg.Zero(f"z{at}"), bg.C(f"C{at}", "C_0")]
        bonds += f"{before}>j{at}>z{at}>C{at} j{at}>R{at} "
        before = f"z{at}"
    equations = bg.derive(bond_graph(nodes, bonds), outputs=["z3"])
    assert _is(transfer(equations), "1/((R_0*C_0*s)**3 + 5*(R_0*C_0*s)**2 + 6*R_0*C_0*s + 1)")


def test_a_twin_t_stops_one_frequency() -> None:
    """A classical mesh of two T: ``(1 + x^2)/(1 + 4 x + x^2)`` with ``x = R C s``, by nodes."""
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.Zero("in"), bg.Zero("out"), bg.Zero("x"), bg.Zero("y"),
        bg.One("ix"), bg.R("Ra", "R_0"), bg.One("xo"), bg.R("Rb", "R_0"), bg.C("Cx", "2*C_0"),
        bg.One("iy"), bg.C("Ca", "C_0"), bg.One("yo"), bg.C("Cb", "C_0"), bg.R("Ry", "R_0/2"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "source>in in>ix>x>xo>out ix>Ra xo>Rb x>Cx in>iy>y>yo>out iy>Ca yo>Cb y>Ry"
    )
    equations = bg.derive(graph, outputs=["out"])
    assert len(equations.states) == 3
    expected = "(1 + (R_0*C_0*s)**2)/(1 + 4*R_0*C_0*s + (R_0*C_0*s)**2)"
    assert _is(transfer(equations), expected)


def test_a_gyrator_makes_a_capacitor_a_coil() -> None:
    """After Karnopp, Margolis, Rosenberg: a gyrator's far side turns round; ``Z = R_0 + r^2 C_0 s``."""
    nodes: list[Node] = [bg.Sf("source", "i"), bg.One("loop"), bg.R("R", "R_0"), bg.GY("turn", "r"),
                         bg.C("C", "C_0")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "source>loop>R loop>turn>C"), outputs=["source"])
    assert equations.states == ()
    assert _is(_transfer_without_states(equations), "R_0 + r**2*C_0*s")
    nodes[0] = bg.Se("source", "u")
    driven = bg.derive(bond_graph(nodes, "source>loop>R loop>turn>C"), outputs=["source"])
    assert _is(transfer(driven), "1/(R_0 + r**2*C_0*s)")


def _transfer_without_states(equations: bg.StateEquations) -> sp.Expr:
    return (equations.D + s * equations.G)[0, 0]


def test_two_gyrators_are_a_transformer() -> None:
    """After Karnopp, Margolis, Rosenberg: in a chain the ratio is that of the two moduli."""
    nodes: list[Node] = [bg.Se("source", "u"), bg.GY("first", "r_1"), bg.Zero("between"),
                         bg.GY("second", "r_2"), bg.One("far"), bg.I("L", "L_0"),
                         bg.R("R", "R_0")]  # fmt: skip
    graph = bond_graph(nodes, "source>first>between>second>far>L far>R")
    agree(rates(graph), {"p_L": "r_2*u/r_1 - R_0*p_L/L_0"})


def test_a_motor_with_a_geared_load() -> None:
    """After Karnopp, Margolis, Rosenberg, and Gawthrop and Bevan's tutorial: a direct current motor.

    Behind a gear of ratio n a load: ``(J_m + J_l/n^2) w' = K i - (b_m + b_l/n^2) w``.
    """
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.One("coil"), bg.I("L", "L_a", flow="i"), bg.R("R", "R_a"),
        bg.GY("motor", "K"), bg.One("shaft"), bg.I("Jm", "J_m", flow="w"), bg.R("bm", "b_m"),
        bg.TF("gear", "1/n"), bg.One("load"), bg.I("Jl", "J_l"), bg.R("bl", "b_l"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "source>coil>L coil>R coil>motor>shaft>Jm shaft>bm shaft>gear>load>Jl load>bl"
    )
    equations = bg.derive(graph, outputs=["shaft"])
    J, b = "(J_m + J_l/n**2)", "(b_m + b_l/n**2)"
    assert _is(transfer(equations), f"K/((L_a*s + R_a)*({J}*s + {b}) + K**2)")
    agree(rates(graph, False), {"i": "(u - R_a*i - K*w)/L_a", "w": f"(K*i - {b}*w)/{J}"})


BUCK: list[Node] = [
    bg.Se("supply", "E_0"), bg.TF("switch", "1/d"), bg.One("coil"), bg.I("L", "L_0", flow="i"),
    bg.R("r", "r_L"), bg.Zero("out"), bg.C("C", "C_0", effort="v"), bg.R("load", "R_0"),
    bg.Se("duty", "d"), bg.R("reader", 1),
]  # fmt: skip
BUCK_BONDS = "supply>switch>coil>L coil>r coil>out>C out>load duty>reader"


def test_an_averaged_buck_converter() -> None:
    """After Borutzky, switched systems: averaged, the switch is a transformer of the duty d.

    ``L i' = d E_0 - r_L i - v``, ``C v' = i - v/R``; the supply's current is d i.
    """
    graph = bond_graph(BUCK, BUCK_BONDS)
    agree(
        rates(graph, False),
        {"i": "(d*E_0 - r_L*i - v)/L_0", "v": "(i - v/R_0)/C_0"},
    )
    current = bg.derive(graph, outputs=["supply"])
    assert differences(current.F, [[sp.Symbol("d"), 0]]) == {}


def test_an_averaged_buck_converter_answers_its_duty() -> None:
    """The same converter: control to output, ``E_0 R/(...)`` at a supply of U_0."""
    equations = bg.derive(bond_graph(BUCK, BUCK_BONDS), outputs=["out"])
    model = bg.linearize(equations, at={"d": "D_0", "E_0": "U_0", "i": "i_0"})
    duty = model.inputs.index(sp.Symbol("d"))
    below = "(L_0*s + r_L)*(R_0*C_0*s + 1) + R_0"
    assert _is(transfer(model, duty), f"U_0*R_0/({below})")
    supply = model.inputs.index(sp.Symbol("E_0"))
    assert _is(transfer(model, supply), f"D_0*R_0/({below})")


def test_an_averaged_boost_converter() -> None:
    """After Borutzky: ``L i' = E_0 - (1 - d) v``, ``C v' = (1 - d) i - v/R``."""
    nodes: list[Node] = [
        bg.Se("supply", "E_0"), bg.One("coil"), bg.I("L", "L_0", flow="i"), bg.TF("switch", "1 - d"),
        bg.Zero("out"), bg.C("C", "C_0", effort="v"), bg.R("load", "R_0"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "supply>coil>L coil>switch>out>C out>load")
    agree(
        rates(graph, False),
        {"i": "(E_0 - (1 - d)*v)/L_0", "v": "((1 - d)*i - v/R_0)/C_0"},
    )


def test_a_series_motor_and_its_linearisation() -> None:
    """Classical: the field carries the armature's current; ``e = K i w``, torque ``K i^2``."""
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.One("loop"), bg.I("L", "L_0", flow="i"), bg.R("R", "R_0"),
        bg.GY("motor", "K*i"), bg.One("shaft"), bg.I("J", "J_0", flow="w"), bg.R("b", "b"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>loop>L loop>R loop>motor>shaft>J shaft>b")
    agree(rates(graph, False), {"i": "(u - R_0*i - K*i*w)/L_0", "w": "(K*i**2 - b*w)/J_0"})
    model = bg.linearize(bg.derive(graph, outputs=[]), at={"i": "i_0", "w": "w_0"})
    K, R_0, b, i_0, w_0 = sp.symbols("K R_0 b i_0 w_0")
    assert differences(model.J, [[-R_0 - K * w_0, -K * i_0], [2 * K * i_0, -b]]) == {}


def test_sallen_and_keys_filter() -> None:
    """Classical: the amplifier's output is a source of K times the node's voltage.

    The node over the source: ``1/(R_1 R_2 C_1 C_2 s^2 + (R_1 C_2 + R_2 C_2 + R_1 C_1 (1 - K)) s + 1)``.
    """
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.One("a"), bg.R("R1", "R_1"), bg.Zero("x"), bg.One("b"),
        bg.R("R2", "R_2"), bg.Zero("y", effort="v_y"), bg.C("C2", "C_2", effort="v_y"),
        bg.Se("amplifier", "K*v_y"), bg.One("back"), bg.C("C1", "C_1", effort="v_1"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>a>R1 a>x x>b>y>C2 b>R2 x>back>C1 back>amplifier")
    model = bg.linearize(bg.derive(graph, outputs=["y"]))
    assert model.inputs == sp.symbols("u,")
    damping = "(R_1*C_2 + R_2*C_2 + R_1*C_1*(1 - K))"
    assert _is(transfer(model), f"1/(R_1*R_2*C_1*C_2*s**2 + {damping}*s + 1)")

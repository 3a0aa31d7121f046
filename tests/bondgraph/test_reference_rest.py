"""What other toolkits print beside the rates: sub-models, transfer functions, data, closed forms."""

from collections.abc import Hashable, Mapping

import networkx as nx
import pytest
import sympy as sp
from references.build import Node, bond_graph
from references.matrices import differences
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED

s, t = sp.symbols("s t")


def _rates(graph: "nx.DiGraph[Hashable]", energy: bool = True) -> dict[str, sp.Expr]:
    found = bg.explicit(bg.derive(graph, outputs=[]), energy=energy)
    return {str(state): rate for state, rate in found.items()}


def _agree(found: Mapping[str, sp.Expr], expected: Mapping[str, str]) -> None:
    """The same states, and rates that differ by nothing."""
    assert set(found) == set(expected)
    for state, text in expected.items():
        assert sp.cancel(found[state] - bg.expression(text, state)) == 0, state


def _open_ended(nodes: list[Node], *bonds: tuple[str, str]) -> "nx.DiGraph[Hashable]":
    """A part whose bonds may end at terminals that another part declares."""
    graph: nx.DiGraph[Hashable] = nx.DiGraph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from(bonds)
    return graph


def test_an_oscillator_of_two_sub_models_and_its_closed_form() -> None:
    """BondGraphs.jl module_tests.jl: R = L = C = 1, L in a sub-model of its own, q(0) = p(0) = 1."""
    rc = bond_graph([bg.Zero("node"), bg.R("R", 1), bg.C("C", 1)], "node>R node>C")
    coil = bg.prefixed(_open_ended([bg.I("L", 1)], ("node", "L")), "coil_", keep=["node"])
    found = _rates(bg.assemble(rc, coil))
    _agree(found, {"q_C": "-q_C - p_coil_L", "p_coil_L": "q_C"})
    w, fading = sp.sqrt(3) / 2, sp.exp(-t / 2)
    closed = {
        sp.Symbol("q_C"): fading * (sp.cos(w * t) - sp.sqrt(3) * sp.sin(w * t)),
        sp.Symbol("p_coil_L"): fading * (sp.cos(w * t) + sp.sqrt(3) * sp.sin(w * t)),
    }
    for state, value in closed.items():
        assert sp.expand(sp.diff(value, t) - found[str(state)].subs(closed)) == 0
    ends = [float(value.subs(t, 1)) for value in closed.values()]
    assert ends == pytest.approx([-0.40731424, 1.1932073], abs=1e-7)


def test_a_source_drives_an_impedance_in_another_sub_model() -> None:
    """BondGraphTools test_modular.py, modular.bg: ``x0' = x1``, ``x1' = u - x0 - x1``."""
    impedance = bond_graph([bg.One("Z"), bg.R("R", 1), bg.I("L", 1), bg.C("C", 1)], "Z>R Z>L Z>C")
    source = _open_ended([bg.Se("Vs", "u")], ("Vs", "port"))
    parts = bg.prefixed(impedance, "z_"), bg.prefixed(source, "s_", {"port": "z_Z"})
    _agree(_rates(bg.assemble(*parts)), {"q_z_C": "p_z_L", "p_z_L": "s_u - q_z_C - p_z_L"})


def _one_state(nodes: list[Node], bonds: str, output: str) -> tuple[sp.Expr, ...]:
    """A, B, C, D and G of one displacement x: ``x' = A x + B u``, ``y = C x + D u = G u``."""
    equations = bg.derive(bond_graph(nodes, bonds), outputs=[output])
    assert equations.E.todok() == {}
    assert equations.G.todok() == {}
    c = equations.A[0]
    A, B = equations.J[0] / c, equations.B[0]
    C, D = equations.F[0] / c, equations.D[0]
    return A, B, C, D, C * B / (s - A) + D


def test_a_low_pass_and_its_transfer_function() -> None:
    """MTT Electrical_rep, rc: A = -1/(c r), B = 1/r, C = 1/c, D = 0, G = 1/(c r s + 1)."""
    nodes: list[Node] = [
        bg.Se("in", "u"),
        bg.One("j"),
        bg.R("r", "r"),
        bg.Zero("z"),
        bg.C("c", "c"),
    ]
    r, c = sp.symbols("r c")
    expected = (-1 / (c * r), 1 / r, 1 / c, 0, 1 / (c * r * s + 1))
    found = _one_state(nodes, "in>j>r j>z>c", "z")
    assert differences(sp.Matrix(found), sp.Matrix(expected)) == {}


def test_a_loop_of_resistances_its_algebraic_equation_and_transfer_function() -> None:
    """MTT AlgebraicLoops_rep, aRC: ``0 = (-c u + c v r1 + c v r2 + x)/c``, G = 1/(c (r1 + r2) s + 1)."""
    nodes: list[Node] = [bg.Se("in", "u"), bg.One("j"), bg.R("r1", "r1"), bg.R("r2", "r2"),
                         bg.Zero("z"), bg.C("c", "c")]  # fmt: skip
    bonds = "in>j>r1 j>r2 j>z>c"
    r1, r2, c, u = sp.symbols("r1 r2 c u")
    A, B, C, D, G = _one_state(nodes, bonds, "z")
    expected = (-1 / (c * (r1 + r2)), 1 / (r1 + r2), 1 / c, 0, 1 / (c * (r1 + r2) * s + 1))
    assert differences(sp.Matrix([A, B, C, D, G]), sp.Matrix(expected)) == {}
    x, v = sp.Symbol("q_c"), _rates(bond_graph(nodes, bonds))["q_c"]
    assert sp.cancel((-c * u + c * v * r1 + c * v * r2 + x) / c) == 0


def test_a_direct_current_motor_in_its_sources_numbers() -> None:
    """PyBondGraph bg_dc_motor.py: RA = 4, LA = 15e-6, Kt = 9.54e-3, J = RB = 1e-6, U = 5."""
    nodes: list[Node] = [bg.Se("U", 5), bg.One("a"), bg.R("RA", 4), bg.I("LA", 15e-6),
                         bg.GY("K", 9.54e-3), bg.One("b"), bg.R("RB", 1e-6), bg.I("J", 1e-6)]  # fmt: skip
    _agree(
        _rates(bond_graph(nodes, "U>a a>RA a>LA a>K>b b>RB b>J")),
        {"p_LA": "5 - 800000*p_LA/3 - 9540*p_J", "p_J": "636*p_LA - p_J"},
    )


def test_a_hoist_with_the_position_of_its_load() -> None:
    """PyBondGraph bg_hoisting_device.py, all five states: ``x_m' = p_m/m``."""
    nodes: list[Node] = [
        bg.Se("supply", "U"), bg.One("a"), bg.R("Rel", "Rel"), bg.I("el", "L"), bg.GY("motor", "K"),
        bg.One("b"), bg.R("Rb", "Rb"), bg.I("J", "J"), bg.TF("drum", "r"), bg.Zero("rope"),
        bg.C("Cr", "Cr"), bg.One("load"), bg.I("m", "m"), bg.Se("weight", "G"),
        bg.Df("place", integrate="x_m"),
    ]  # fmt: skip
    bonds = (
        "supply>a a>Rel a>el a>motor>b b>Rb b>J b>drum>rope>Cr rope>load>m weight>load load>place"
    )
    _agree(
        _rates(bond_graph(nodes, bonds)),
        {
            "p_el": "U - Rel*p_el/L - K*p_J/J",
            "p_J": "K*p_el/L - Rb*p_J/J - r*q_Cr/Cr",
            "q_Cr": "r*p_J/J - p_m/m",
            "p_m": "q_Cr/Cr + G",
            "x_m": "p_m/m",
        },
    )


def test_a_rod_pendulum_on_an_accelerated_pivot() -> None:
    """MTT Mechanical_rep, Pendulum, with its own source: the pivot's velocity V has the rate u2.

    ``x1' = j (u1 - l m u2 sin x2)/(j + l^2 m)`` for x1 = j w, where the source divides twice;
    z1/m and z2/m are the velocities ``l w cos x2`` (the source's sign is the other) and ``l w sin x2 + V``.
    """
    nodes: list[Node] = [
        bg.Se("drive", "u_1"), bg.One("rot"), bg.I("j", "j", flow="w"), bg.Df("angle", integrate="x_2"),
        bg.TF("tx", "l*cos(x_2)"), bg.One("x"), bg.I("m_x", "m", priority=-1),
        bg.TF("ty", "l*sin(x_2)"), bg.Zero("sum"), bg.Sf("pivot", "V"), bg.One("y"),
        bg.I("m_y", "m", priority=-1),
    ]  # fmt: skip
    graph = bond_graph(nodes, "drive>rot>j rot>angle rot>tx>x>m_x rot>ty>sum pivot>sum>y>m_y")
    found = _rates(graph, False)
    assert set(found) == {"w", "x_2"}
    expected = bg.expression("(u_1 - l*m*d_V*sin(x_2))/(j + l**2*m)", "w")
    assert sp.simplify(found["w"] - expected) == 0
    assert found["x_2"] == sp.Symbol("w")
    equations = bg.derive(graph, outputs=["x", "y"])
    rod, angle = sp.symbols("l x_2")
    assert differences(equations.F, [[rod * sp.cos(angle)], [rod * sp.sin(angle)]]) == {}
    assert differences(equations.D, [[0, 0], [0, 1]]) == {}


def test_a_port_hamiltonian_exactly() -> None:
    """BondGraphTools test_porthamiltonian.py: ``x' = u - p``, ``p' = x + x^3``."""
    nodes: list[Node] = [bg.Sf("u", "u"), bg.Zero("z"), bg.C("x", energy="q_x**2/2 + q_x**4/4"),
                         bg.I("p", 1)]  # fmt: skip
    _agree(_rates(bond_graph(nodes, "u>z z>x z>p")), {"q_x": "u - p_p", "p_p": "q_x + q_x**3"})


def test_a_spring_linkage_rests_where_its_source_says() -> None:
    """MTT Mechanical_rep, NonlinearMSD: ``u = 2 k l^2 cos(eta/2)(sin(eta/2) - sin(alpha/2))``."""
    spring = "2*k*l**2*cos(q_c/2)*(sin(q_c/2) - sin(alpha/2))"
    nodes: list[Node] = [bg.Se("drive", "u"), bg.One("rot"), bg.I("j", "j"), bg.R("r", "r"),
                         bg.C("c", law=spring)]  # fmt: skip
    found = _rates(bond_graph(nodes, "drive>rot>j rot>r rot>c"))
    _agree(found, {"q_c": "p_j/j", "p_j": f"u - r*p_j/j - {spring}"})
    at_rest = {sp.Symbol("p_j"): 0, sp.Symbol("u"): bg.expression(spring, "rest")}
    assert [sp.expand(found[state].subs(at_rest)) for state in ("q_c", "p_j")] == [0, 0]


def test_a_closed_cycle_of_reactions_exactly() -> None:
    """BondGraphTools test_biochem.py: Ce k = 1, 2, 3 and Re r = 1, 2, 3, R = T = 1."""
    nodes: list[Node] = []
    bonds = ""
    for at, name in enumerate(("X", "Y", "Z"), start=1):
        nodes += [bg.Zero(name, effort=f"mu_{name}"), bg.C(f"c{name}", law=f"log({at}*q_c{name})")]
        bonds += f"{name}>c{name} "
    for at, (one, other) in enumerate((("X", "Y"), ("Y", "Z"), ("Z", "X")), start=1):
        law = f"{at}*(exp(mu_{one}) - exp(mu_{other}))"
        nodes += [bg.One(f"re{at}"), bg.R(f"r{at}", law=law, gives="flow")]
        bonds += f"{one}>re{at}>{other} re{at}>r{at} "
    _agree(
        _rates(bond_graph(nodes, bonds)),
        {
            "q_cX": "-4*q_cX + 2*q_cY + 9*q_cZ",
            "q_cY": "q_cX - 6*q_cY + 6*q_cZ",
            "q_cZ": "3*q_cX + 4*q_cY - 15*q_cZ",
        },
    )

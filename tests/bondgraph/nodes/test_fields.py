"""Storages and resistances with several ports: matrices and energies, against hand derivations."""

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import Step, simulator

L1, L2, M, r, c, m, s = sp.symbols("L1 L2 M r c m s")


NAMES = {"one": "i_1", "two": "i_2"}


def _with_ports(nodes: list, bonds: str, ports: dict[tuple[str, str], str]) -> nx.DiGraph:
    graph = bond_graph(nodes, bonds)
    for bond, port in ports.items():
        graph.edges[bond]["port"] = port
    return graph


def _coils(**more: object) -> nx.DiGraph:
    """Two loops coupled by a mutual inductance; the second holds a resistance."""
    value = more.pop("value", [["L1", "M"], ["M", "L2"]])
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.One("b"), bg.R("r_a", "r_a"), bg.R("r", "r"),
             bg.I("coils", value, ports=["one", "two"], flow=NAMES, **more)]  # fmt: skip
    return _with_ports(
        nodes, "u>a>r_a a>coils b>r b>coils", {("a", "coils"): "one", ("b", "coils"): "two"}
    )


def test_coupled_coils_share_their_matrix() -> None:
    """L1 i1' + M i2' = u - r_a i1, M i1' + L2 i2' = -r i2."""
    equations = bg.derive(_coils(), outputs=[])
    assert [str(state) for state in equations.states] == ["i_1", "i_2"]
    assert sp.Matrix([[L1, M], [M, L2]]) == equations.A
    assert sp.diag(-sp.Symbol("r_a"), -r) == equations.J
    assert sp.Matrix([1, 0]) == equations.B


def test_a_port_with_derivative_causality_needs_no_inverse_of_the_matrix() -> None:
    """Port two in a loop with another inductance L3 of higher priority, in series."""
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.One("b"), bg.I("L3", "L3", flow="i_2", priority=1),
             bg.R("r", "r"), bg.I("coils", [["L1", "M"], ["M", "L2"]], ports=["one", "two"])]  # fmt: skip
    graph = _with_ports(
        nodes, "u>a>coils b>L3 b>r b>coils", {("a", "coils"): "one", ("b", "coils"): "two"}
    )
    causal = bg.assign_causality(graph)
    assert causal.integral == ("L3", "coils.one")
    assert causal.derivative == ("coils.two",)
    assert causal.strokes["b", "coils"] in ("b", "coils")
    equations = bg.derive(graph, outputs=[])
    assert sp.Matrix([[L2 + sp.Symbol("L3"), M], [M, L1]]) == equations.A
    assert sp.diag(-r, 0) == equations.J


def test_a_fields_diagonal_is_that_many_storages() -> None:
    apart = bg.derive(_coils(value=[["L1", 0], [0, "L2"]]), outputs=[])
    assert sp.diag(L1, L2) == apart.A


def _beam(**elastic: object) -> nx.DiGraph:
    """A cantilever's tip: force and bending moment, one compliance with two ports, and a rigid body."""
    nodes = [bg.Se("load", "P"), bg.One("tip"), bg.I("m", "m", flow="v"), bg.One("turn"),
             bg.I("J", "J", flow="w"), bg.C("beam", ports=["down", "tilt"], **elastic)]  # fmt: skip
    return _with_ports(
        nodes,
        "load>tip>m tip>beam turn>J turn>beam",
        {("tip", "beam"): "down", ("turn", "beam"): "tilt"},
    )


def test_a_cantilever_has_its_textbook_compliance_and_energy() -> None:
    """Euler-Bernoulli: C = [[l^3/3, l^2/2], [l^2/2, l]]/(E I); the same by its energy q^T K q/2."""
    length, EI = 1.2, 50.0
    C = np.array([[length**3 / 3, length**2 / 2], [length**2 / 2, length]]) / EI
    K = np.linalg.inv(C)
    text = [[float(entry) for entry in row] for row in C]
    q = ["q_beam_down", "q_beam_tilt"]
    energy = "+".join(f"{float(K[i, j] / 2)!r}*{q[i]}*{q[j]}" for i in range(2) for j in range(2))
    runs = []
    for elastic in ({"value": text}, {"energy": energy}):
        ready = simulator(bg.derive(_beam(**elastic), outputs=[]), {"m": 0.8, "J": 0.01})
        runs.append(ready.run(np.linspace(0, 0.5, 26), inputs={"P": Step(0.05, 3.0)}))
    for name in ("v", "w", "e_beam_down", "e_beam_tilt"):
        assert runs[0][name] == pytest.approx(runs[1][name], abs=1e-6), name
    assert runs[0].energy("beam") == pytest.approx(runs[1].energy("beam"), abs=1e-8)
    supplied = runs[0].power("load")
    absorbed = sum(runs[0].power(node) for node in ("m", "J", "beam"))
    assert supplied == pytest.approx(absorbed, abs=1e-9)


def test_port_hamiltonian_one_port_takes_its_effort_from_the_gradient() -> None:
    """H = x^2/2 + x^4/4 beside an inertia and a flow source: x' = u - p, p' = x + x^3."""
    nodes = [bg.Sf("u", "u"), bg.Zero("z"), bg.C("x", energy="q_x**2/2 + q_x**4/4"), bg.I("p", 1)]
    ready = simulator(bg.derive(bond_graph(nodes, "u>z z>x z>p"), outputs=[]), {})
    assert ready.states == ("f_p", "q_x")
    assert ready.rhs(0.0, [0.7, 0.5], [0.2]) == pytest.approx([0.5 + 0.125, 0.2 - 0.7])
    run = ready.run(np.linspace(0, 1, 5), {"q_x": 1.0}, {"u": 0.0})
    assert run.energy("x") + run.energy("p") == pytest.approx(np.full(5, 0.75), abs=1e-8)


RESIST = sp.Matrix([[5, 1, 0], [2, 4, 1], [0, 1, 3]])


@pytest.mark.parametrize("inverted", [(), (0,), (1,), (0, 2), (0, 1, 2)])
def test_a_resistance_field_in_every_causality(inverted: tuple[int, ...]) -> None:
    """Each port ends on a mass (it gives effort) or on a capacitance (it gives flow): e = R f."""
    nodes: list = [bg.R("R", RESIST, ports=["x", "y", "z"])]
    bonds, ports = "", {}
    for at, port in enumerate("xyz"):
        if at in inverted:
            nodes += [bg.Zero(port), bg.C(f"c_{port}", 1, effort=f"s_{port}")]
        else:
            nodes += [bg.One(port), bg.I(f"c_{port}", 1, flow=f"s_{port}")]
        bonds += f"{port}>c_{port} {port}>R "
        ports[port, "R"] = port
    equations = bg.derive(_with_ports(nodes, bonds, ports), outputs=[])
    state = np.array([0.3, -1.1, 0.7])
    # Unknown efforts and flows of the field: e - R f = 0, with one of each pair given by the state.
    system, right = np.zeros((3, 3)), np.zeros(3)
    R = np.array(RESIST, dtype=float)
    for i in range(3):
        for j in range(3):
            if j in inverted:
                system[i, j] -= R[i, j]
            else:
                right[i] += R[i, j] * state[j]
        if i in inverted:
            right[i] -= state[i]
        else:
            system[i, i] += 1
    given = np.linalg.solve(system, right)
    assert np.array(equations.J, dtype=float) @ state == pytest.approx(-given)


def test_a_diagonal_resistance_field_is_that_many_resistances() -> None:
    nodes: list = [bg.R("R", [["a", 0], [0, "b"]], ports=["x", "y"])]
    for port in "xy":
        nodes += [bg.One(port), bg.I(f"m_{port}", 1)]
    graph = _with_ports(nodes, "x>m_x x>R y>m_y y>R", {("x", "R"): "x", ("y", "R"): "y"})
    assert -sp.diag(*sp.symbols("a b")) == bg.derive(graph, outputs=[]).J


def test_a_modulated_field_obeys_energy() -> None:
    """A moving coil: the mutual inductance turns with the rotor, whose torque is i1 i2 dM/dtheta."""
    energy = "p_coils_one**2/(2*L1) + p_coils_two**2/(2*L2) - cos(theta)*p_coils_one*p_coils_two/K"
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.One("b"), bg.R("r", "r"), bg.One("rot"),
             bg.I("J", "J", flow="w"), bg.Df("angle", integrate="theta"),
             bg.I("coils", energy=energy, ports=["one", "two"])]  # fmt: skip
    graph = _with_ports(
        nodes,
        "u>a>coils b>r b>coils rot>J rot>angle",
        {("a", "coils"): "one", ("b", "coils"): "two"},
    )
    ready = simulator(bg.derive(graph, outputs=[]), {"L1": 1, "L2": 2, "K": 5, "r": 1, "J": 1})
    p, theta = np.array([0.4, -0.3]), 0.8
    flows = [p[0] / 1 - np.cos(theta) * p[1] / 5, p[1] / 2 - np.cos(theta) * p[0] / 5]
    state = dict(zip(ready.states, np.zeros(len(ready.states)), strict=True))
    state |= {"p_coils_one": p[0], "p_coils_two": p[1], "theta": theta}
    rate = dict(zip(ready.states, ready.rhs(0.0, list(state.values()), [2.0]), strict=True))
    assert rate["p_coils_one"] == pytest.approx(2.0)
    assert rate["p_coils_two"] == pytest.approx(-flows[1])


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"value": [["L1", "M"], ["N", "L2"]]}, "'one' differ, N and M: only a symmetric matrix"),
        ({"value": [["L1", "M"]]}, "matrix of 2 rows"),
        ({"value": [["L1"], ["M"]]}, "must have 2 entries"),
        ({"value": [["L1", "L1"], ["L1", "L1"]]}, "determinant of the value vanishes"),
        ({"value": "L1"}, "matrix of 2 rows"),
        ({"law": "p_coils"}, "give a matrix as value, or an energy, not law"),
        ({"energy": "p_coils_one**2", "value": None}, "does not depend on p_coils_two"),
    ],
)
def test_a_field_that_is_none_is_refused(attributes: dict, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(_coils(**attributes))


@pytest.mark.parametrize(
    ("port", "message"),
    [(None, "must name a port of 'coils' as port=...; there are one, two"), ("three", "there are one, two"),
     ("two", "'coils.one' has 0 bonds")],
)  # fmt: skip
def test_bonds_name_the_ports_they_are_on(port: str | None, message: str) -> None:
    graph = _coils()
    graph.edges["a", "coils"].clear()
    if port is not None:
        graph.edges["a", "coils"]["port"] = port
    with pytest.raises(bg.StructureError, match=message):
        bg.validate(graph)


def test_ports_of_nodes_that_have_none_and_missing_bonds_are_refused() -> None:
    graph = _coils()
    graph.edges["a", "r_a"]["port"] = "one"
    with pytest.raises(bg.StructureError, match="port names the port of the one field"):
        bg.validate(graph)
    graph = _coils()
    graph.remove_edge("b", "coils")
    with pytest.raises(bg.StructureError, match=r"'coils\.two' has 0 bonds"):
        bg.validate(graph)

"""Linear analysis where it is easily wrong: rates, mixed holds, drifting poles, singular points."""

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

m, n, a, r, w, u, e_a = sp.symbols("m n a r w u e_a")


def test_a_port_on_a_capacitance_is_held_by_its_effort() -> None:
    """w = f_p + e_c/r + c e_c', and f_p = 0: what holds it is e_c, a state once the port is turned.

    Under a law that gives the effort it cannot turn, and c e_p' would be needed.
    """
    nodes = [bg.Sf("w", "w"), bg.Zero("z"), bg.R("r", "r"), bg.C("c", "c")]
    equations = bg.derive(bond_graph([*nodes, bg.R("p")], "w>z>r z>c z>p"))
    assert dict(bg.holding_efforts(equations, ["p"])) == {sp.Symbol("e_p"): sp.Symbol("e_c")}
    ruled = bg.derive(bond_graph([*nodes, bg.R("p", law="3*t")], "w>z>r z>c z>p"))
    with pytest.raises(bg.DependentSourceError, match="'p' depends on the rate"):
        bg.holding_efforts(ruled, ["p"])


def _mixed() -> bg.StateEquations:
    """Port b ties mass n to mass m; port a lies beside a resistance on n."""
    nodes = [
        bg.Se("u", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("z"), bg.R("b"),
        bg.One("k"), bg.I("n", "n", flow="w"), bg.Zero("y"), bg.R("a"), bg.R("r", "r"),
    ]  # fmt: skip
    return bg.derive(bond_graph(nodes, "u>j>m j>z>b z>k>n k>y>a y>r"))


@pytest.mark.parametrize("order", [["a", "b"], ["b", "a"]])
def test_one_port_beside_a_resistance_and_one_between_masses_hold_together(
    order: list[str],
) -> None:
    """All of w goes through r; (m + n) w' = u - e_a and m v' = u - e_b."""
    held = bg.holding_efforts(_mixed(), ["a", "b"])
    assert sp.cancel(held[e_a] - r * w) == 0
    assert sp.cancel(held[sp.Symbol("e_b")] - (m * r * w + n * u) / (m + n)) == 0
    model = bg.linearize(_mixed(), stuck=order, outputs=["w", "e_a", "e_b"])
    # (m + n) w' = u - r w
    expected = [1, r, n * sp.Symbol("s") + r]
    whole = 1 / ((m + n) * sp.Symbol("s") + r)
    found = model.transfer_function()
    assert [sp.cancel(found[at] - value * whole) for at, value in enumerate(expected)] == [0, 0, 0]


def test_a_clutch_to_an_inertia_with_a_law_can_be_held() -> None:
    """The same two inertias, one of them by the law f = p/m of its momentum."""

    def locked(first: tuple) -> sp.Matrix:
        nodes = [bg.Se("u", "u"), bg.One("j"), first, bg.Zero("z"), bg.R("cl"), bg.One("k"),
                 bg.I("n", "n", flow="w")]  # fmt: skip
        equations = bg.derive(bond_graph(nodes, "u>j>m j>z>cl z>k>n"))
        return bg.linearize(equations, stuck=["cl"], outputs=["w"]).transfer_function()

    plain = locked(bg.I("m", "m", flow="v"))
    assert (locked(bg.I("m", law="p_m/m")) - plain).applyfunc(sp.cancel).is_zero_matrix
    assert sp.cancel(plain[0] - 1 / ((m + n) * sp.Symbol("s"))) == 0


def test_poles_of_rounding_are_no_oscillation() -> None:
    """Springs to ground side by side leave poles at 0, and one oscillation of 2 rad/s."""
    nodes = [bg.One("j"), bg.I("m", 1, flow="v"), bg.C("k_1", 1, effort="F_1"),
             bg.C("k_2", "1/2", effort="F_2"), bg.C("k_3", 1, effort="F_3")]  # fmt: skip
    model = bg.linearize(bg.derive(bond_graph(nodes, "j>m j>k_1 j>k_2 j>k_3"))).numeric({})
    assert model.drifts
    assert model.mode({"v": 1}).pole.imag == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("mass", "k", "b"), [(1e6, 1e12, 1.0), (1e-6, 1e-12, 1.0), (1.0, 1.0, 0.1)]
)
def test_dc_gain_of_widely_scaled_oscillators(mass: float, k: float, b: float) -> None:
    nodes = [
        bg.Se("u", "u"),
        bg.One("j"),
        bg.I("m", "m"),
        bg.C("c", "1/k", effort="F"),
        bg.R("b", "b"),
    ]
    equations = bg.derive(bond_graph(nodes, "u>j>m j>c j>b"), outputs=[])
    model = bg.linearize(equations, outputs=["F"]).numeric({"m": mass, "k": k, "b": b})
    assert not model.drifts
    assert model.dc_gain() == pytest.approx(np.array([[1.0]]), rel=1e-9)


def test_a_pole_at_zero_has_no_gain_there() -> None:
    nodes = [bg.Se("u", "u"), bg.One("j"), bg.I("m", "m", flow="v")]
    model = bg.linearize(bg.derive(bond_graph(nodes, "u>j>m")), outputs=["v"]).numeric({"m": 2})
    with pytest.raises(bg.ParameterError, match="pole at 0"):
        model.dc_gain()
    with pytest.raises(bg.ParameterError, match="is a pole"):
        model.frequency_response([0.0])
    assert model.transfer(1j) == pytest.approx(np.array([[1 / 2j]]))


def test_laws_that_cancel_a_storage_are_refused() -> None:
    """Law -(1 + m/d) F_d on a mass m whose dependent mass d shows F_d = d v'."""
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.I("d", "d", effort="F_d", priority=-1),
             bg.R("p", law="-(1 + m/d)*F_d")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "j>m j>d j>p"))
    with pytest.raises(bg.SingularStorageError, match="cancel the storages"):
        bg.linearize(equations, outputs=["v"])


def test_a_singular_a_is_seen_through_rounding() -> None:
    """1/a + 1/b + 1/c = 0 with values that no float holds."""
    nodes = [bg.Se("u", "u"), bg.One("j"), bg.I("a", "a"), bg.Zero("z"), bg.One("k"), bg.I("b", "b"),
             bg.One("l"), bg.I("c", "c")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "u>j>a j>z z>k>b z>l>c"))
    with pytest.raises(bg.ParameterError, match="singular"):
        bg.linearize(equations).numeric({"a": 3, "b": 7, "c": sp.Rational(-21, 10)})


@pytest.mark.parametrize(
    ("inputs", "message"),
    [("muu", "inputs must be a list"), (["t"], "t can't be an input"),
     (["v"], "v can't be an input"), (["e_p"], "e_p can't be an input"), (["x"], "no law reads")],
)  # fmt: skip
def test_names_that_are_no_inputs_are_refused(inputs: object, message: str) -> None:
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.R("p", law="mu*v + m*sin(t)", effort="e_p")]
    with pytest.raises(bg.SignalError, match=message):
        bg.linearize(bg.derive(bond_graph(nodes, "j>m j>p")), inputs=inputs)


def test_states_of_laws_are_outputs_too_and_aliases_are_worked_out() -> None:
    nodes = [
        bg.One("j"),
        bg.I("m", "m", flow="v"),
        bg.C("k", law="k*q_k**3"),
        bg.R("p", law="f_p**2"),
    ]
    equations = bg.derive(bond_graph(nodes, "j>m j>k j>p"))
    model = bg.linearize(equations, at={"q_k": 2, "v": 5}, outputs=["q_k"])
    k = sp.Symbol("k")
    assert sp.Matrix([[-10, -12 * k], [1, 0]]) == model.J
    assert sp.Matrix([[0, 1]]) == model.F


def test_a_port_named_twice_is_refused() -> None:
    for act in (bg.holding_efforts, lambda e, stuck: bg.linearize(e, stuck=stuck)):
        with pytest.raises(bg.StructureError, match="names 'b' twice"):
            act(_mixed(), ["b", "b"])


def _weight_on_a_crank() -> bg.StateEquations:
    g: nx.DiGraph[str] = nx.DiGraph()
    g.add_nodes_from([
        bg.Se("W", "-m*g"), bg.One("y"), bg.One("turn"), bg.I("J", "J", flow="w"),
        bg.Df("sensor", integrate="theta"), bg.TF("crank", "sin(theta)"),
    ])  # fmt: skip
    g.add_edges_from([
        ("turn", "J"), ("turn", "sensor"), ("turn", "crank"), ("crank", "y"), ("W", "y"),
    ])  # fmt: skip
    return bg.derive(g, outputs=[])


def test_a_known_source_behind_a_moving_ratio_has_its_value_at_the_point() -> None:
    m, g = sp.symbols("m g")
    # J theta'' = -m g sin(theta), which is -m g theta about 0.
    model = bg.linearize(_weight_on_a_crank(), at={"theta": 0})
    assert sp.Matrix([[0, -m * g], [1, 0]]) == model.J


def test_a_point_that_contradicts_a_known_source_is_refused() -> None:
    with pytest.raises(bg.SignalError, match="e_W is 7, but its law gives"):
        bg.linearize(_weight_on_a_crank(), at={"theta": 0, "e_W": 7})

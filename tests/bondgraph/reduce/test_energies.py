"""Storages whose values read inputs: their momenta and displacements are the states."""

import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

m, J, n, b, load, F, p, w, v, q, k = sp.symbols("m J n b load F p_m w v q_spring k")


def _cart(value: str, *more: tuple, bonds: str = "") -> bg.StateEquations:
    nodes = [
        bg.Se("push", "F"),
        bg.One("cart"),
        bg.I("m", value, flow="v"),
        bg.R("drag", "b"),
        *more,
    ]
    return bg.derive(bond_graph(nodes, f"push>cart>m cart>drag {bonds}"), inputs=["load"])


def test_a_filled_mass_has_its_momentum_as_its_state() -> None:
    """``p' = F - b p/(m (1 + load))``, and no rate of the load."""
    equations = _cart("m*(1 + load)")
    assert equations.states == (p,)
    assert equations.inputs == (F, load)
    assert sp.cancel(equations.J[0, 0] + b / (m * (1 + load))) == 0
    assert (equations.A[0, 0], list(equations.B), equations.E.todok()) == (1, [1, 0], {})


def test_a_filled_compliance_has_its_displacement_as_its_state() -> None:
    nodes = [
        bg.Sf("speed", "w"),
        bg.Zero("z"),
        bg.C("spring", "load/k", effort="F"),
        bg.R("leak", "b"),
    ]
    equations = bg.derive(bond_graph(nodes, "speed>z>spring z>leak"), inputs=["load"])
    assert equations.states == (q,)
    assert sp.cancel(equations.J[0, 0] + k / (load * b)) == 0


def test_what_is_filled_behind_a_ratio_shares_a_momentum() -> None:
    """``pi = (J + n^2 m load) w`` is what the shaft's torque changes."""
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1), bg.TF("gear", "n"),
             bg.One("out"), bg.I("m", "m*load"), bg.R("drag", "b")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "T>a>J a>gear>out>m a>drag"), inputs=["load"])
    assert equations.states == (sp.Symbol("p_J"),)
    assert (equations.A[0, 0], equations.E.todok()) == (1, {})
    assert sp.cancel(equations.J[0, 0] + b / (J + n**2 * m * load)) == 0


def test_a_speed_that_is_given_adds_to_a_shared_momentum() -> None:
    """Of a mass between a cart and a moved floor, ``pi = m v + m_2 load (v - w)``."""
    nodes = [bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m", flow="v", priority=1), bg.Zero("z"),
             bg.One("between"), bg.I("m_2", "m_2*load"), bg.Sf("floor", "w")]  # fmt: skip
    graph = bond_graph(nodes, "push>cart>m cart>z>between>m_2 floor>z")
    equations = bg.derive(graph, outputs=["cart"], inputs=["load"])
    assert (equations.states, equations.E.todok()) == ((p,), {})
    # F = m v' + (m_2 load (v + w))', the bonds into the node adding up.
    m_2 = sp.Symbol("m_2")
    assert sp.cancel(equations.F[0, 0] - 1 / (m + m_2 * load)) == 0
    assert sp.cancel(equations.D[0, 1] + m_2 * load / (m + m_2 * load)) == 0


def test_values_that_read_the_speed_read_it_over_the_momentum() -> None:
    equations = _cart("m*(1 + load)", bg.R("drag", "b*v"))
    assert sp.cancel(equations.J[0, 0] + b * p / (m * (1 + load)) ** 2) == 0


def test_a_mass_that_reads_its_own_speed_keeps_it_as_its_state() -> None:
    assert _cart("m*(1 + load*v)").states == (v,)


def test_a_constant_mass_beside_an_opened_valve_keeps_its_speed() -> None:
    nodes = [bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m", flow="v"), bg.R("drag", "b*load")]
    equations = bg.derive(bond_graph(nodes, "push>cart>m cart>drag"), inputs=["load"])
    assert (equations.states, equations.J[0, 0]) == ((v,), -b * load)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ("load", "inputs must be a list of names, not 'load'"),
        (["loda"], r"no value reads an input loda \(did you mean 'load'\?\)"),
        (["v"], "v can be no input of values: it is a signal of the graph"),
        (["t"], "t can be no input of values: it is the time"),
    ],
)
def test_what_can_be_no_input_is_refused(inputs, message: str) -> None:
    nodes = [bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m*(1 + load)", flow="v")]
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(bond_graph(nodes, "push>cart>m"), inputs=inputs)


def test_a_derivation_tells_the_momentum() -> None:
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1), bg.TF("gear", "n"),
             bg.One("out"), bg.I("m", "m*load", flow="v")]  # fmt: skip
    text = bg.explain(bond_graph(nodes, "T>a>J a>gear>out>m"), inputs=["load"]).text()
    assert "p_J = (J + load*m*n^2)*w" in text
    assert "p_J' = T" in text
    assert "p_J' = e_J" not in text

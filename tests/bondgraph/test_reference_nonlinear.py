"""Nonlinear and modulated models with printed equations, from other toolkits and their documents."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from rig.walked import WALKED

import bondgraph as bg
from codegen import simulator

pytestmark = WALKED


def _rhs(equations: bg.StateEquations, numbers: dict, state: dict, inputs: tuple = ()) -> dict:
    ready = simulator(equations, numbers)
    x = [state[name] for name in ready.states]
    return dict(zip(ready.states, ready.rhs(0.0, x, inputs), strict=True))


def test_a_rod_pendulum_is_right_where_its_source_divides_twice() -> None:
    """MTT, Mechanical_rep, Pendulum (Gawthrop and Smith, s. 10.3), the printed ODE corrected:

    x1' = j (u1 - l m u2 sin x2)/(j + l^2 m) for the rod's momentum x1 = j w.
    """
    nodes = [bg.Se("drive", "u_1"), bg.One("rot"), bg.I("j", "j", flow="w"),
             bg.Df("angle", integrate="x_2"), bg.TF("tx", "l*cos(x_2)"), bg.One("x"),
             bg.I("m_x", "m", priority=-1), bg.TF("ty", "l*sin(x_2)"), bg.One("y"),
             bg.I("m_y", "m", priority=-1), bg.Se("weight", "W")]  # fmt: skip
    graph = bond_graph(nodes, "drive>rot>j rot>angle rot>tx>x>m_x rot>ty>y>m_y weight>y")
    equations = bg.derive(graph, outputs=[])
    j, m, rod, g, u_1, x_2, W = sp.symbols("j m l g u_1 x_2 W")
    rate = (equations.J[0] * sp.Symbol("w") + (equations.B * sp.Matrix([u_1, W]))[0]) / equations.A[
        0
    ]
    expected = (u_1 - rod * m * g * sp.sin(x_2)) / (j + rod**2 * m)
    assert sp.simplify(rate.subs(W, -m * g) - expected) == 0


def test_a_spring_linkage_and_its_linearisation() -> None:
    """MTT, Mechanical_rep, NonlinearMSD: x2' = u - r x2/j + 2 k l^2 cos(x1/2)(sin(a/2) - sin(x1/2))."""
    law = "2*k*l**2*cos(q_c/2)*(sin(q_c/2) - sin(a/2))"
    nodes = [bg.Se("drive", "u"), bg.One("rot"), bg.I("j", "j", flow="w"), bg.R("r", "r"),
             bg.C("c", law=law)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "drive>rot>j rot>r rot>c"), outputs=[])
    k, l2, a, eta = sp.Symbol("k"), sp.Symbol("l") ** 2, sp.Symbol("a"), sp.Symbol("eta")
    model = bg.linearize(equations, at={"q_c": eta})
    assert [str(state) for state in model.states] == ["w", "q_c"]
    slope = k * l2 * (
        sp.sin(eta / 2) ** 2 - sp.cos(eta / 2) ** 2 - sp.sin(eta / 2) * sp.sin(a / 2)
    )  # fmt: skip
    assert sp.simplify(model.J[0, 1] - slope) == 0
    numbers = {"j": 0.4, "r": 0.2, "k": 3.0, "l": 0.5, "a": np.pi / 3}
    rate = _rhs(equations, numbers, {"w": 0.7, "q_c": 0.9}, (1.1,))
    spring = 2 * 3.0 * 0.25 * np.cos(0.45) * (np.sin(np.pi / 6) - np.sin(0.45))
    assert rate["w"] == pytest.approx((1.1 - 0.2 * 0.7 + spring) / 0.4)


def test_a_closed_cycle_of_three_reactions() -> None:
    """BondGraphTools test_biochem: X' = -4X + 2Y + 9Z, Y' = X - 6Y + 6Z, Z' = 3X + 4Y - 15Z.

    Species e = ln(k x), reactions v = r (exp(A_f) - exp(A_r)), R = T = 1.
    """
    nodes: list = []
    bonds = ""
    for at, name in enumerate("XYZ", start=1):
        nodes += [bg.Zero(name, effort=f"mu_{name}"), bg.C(f"c{name}", law=f"log({at}*q_c{name})")]
        bonds += f"{name}>c{name} "
    for at, (one, other) in enumerate(("XY", "YZ", "ZX"), start=1):
        law = f"{at}*(exp(mu_{one}) - exp(mu_{other}))"
        nodes += [bg.One(f"re{at}"), bg.R(f"r{at}", law=law, gives="flow")]
        bonds += f"{one}>re{at}>{other} re{at}>r{at} "
    equations = bg.derive(bond_graph(nodes, bonds), outputs=[])
    X, Y, Z = 0.5, 1.7, 0.9
    rate = _rhs(equations, {}, {"q_cX": X, "q_cY": Y, "q_cZ": Z})
    assert rate == {
        "q_cX": pytest.approx(-4 * X + 2 * Y + 9 * Z),
        "q_cY": pytest.approx(X - 6 * Y + 6 * Z),
        "q_cZ": pytest.approx(3 * X + 4 * Y - 15 * Z),
    }

"""Pendulums against Lagrange's equations, which sympy differentiates from energies alone."""

from collections.abc import Mapping, Sequence

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph
from references.resolved import rationals
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED

t, g = sp.symbols("t g")
Coordinates = Mapping[str, str]
"""Names of angles and positions to those of their rates."""


def lagrange(
    kinetic: sp.Expr, potential: sp.Expr, names: Coordinates, forces: Sequence[sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """The rates of the rates, from ``d/dt dT/dq' - dT/dq + dV/dq = Q``, solved by `LUsolve`."""
    q = sp.Matrix(sp.symbols(list(names)))
    v = sp.Matrix(sp.symbols(list(names.values())))
    impulse = sp.Matrix([kinetic.diff(one) for one in v])
    push = sp.Matrix([(kinetic - potential).diff(one) for one in q]) + sp.Matrix(forces)
    rates = impulse.jacobian(v).LUsolve(push - impulse.jacobian(q) * v)
    return dict(zip(v, rates, strict=True))


def agree(found: Mapping[sp.Symbol, sp.Expr], expected: Mapping[sp.Symbol, sp.Expr]) -> None:
    """The same at three points, in forty digits."""
    for seed in range(3):
        names = {s for expr in (*found.values(), *expected.values()) for s in expr.free_symbols}
        point = {name: abs(value) for name, value in rationals(names, seed).items()}
        for name, rate in expected.items():
            one, other = (sp.N(expr.xreplace(point), 40) for expr in (found[name], rate))
            assert abs(one - other) <= 1e-30 * abs(other), name


def double_pendulum() -> nx.DiGraph:
    """Two arms with inertias and masses at their ends; angles from hanging, where y points down."""
    nodes = [bg.One("r1"), bg.I("J1", "J_1", flow="w1"), bg.Df("a1", integrate="th1"), bg.One("r2"),
             bg.I("J2", "J_2", flow="w2"), bg.Df("a2", integrate="th2"), bg.Se("g1", "-m1*g"),
             bg.Se("g2", "-m2*g")]  # fmt: skip
    bonds = "r1>J1 r1>a1 r2>J2 r2>a2 g1>v1y g2>v2y"
    for axis, turns in (("x", "cos"), ("y", "sin")):
        nodes += [bg.TF(f"t1{axis}", f"l1*{turns}(th1)"), bg.TF(f"t2{axis}", f"l2*{turns}(th2)"),
                  bg.One(f"v1{axis}"), bg.I(f"m1{axis}", "m1", priority=-1), bg.Zero(f"s{axis}"),
                  bg.One(f"v2{axis}"), bg.I(f"m2{axis}", "m2", priority=-1)]  # fmt: skip
        bonds += f" r1>t1{axis}>v1{axis}>m1{axis} v1{axis}>s{axis}>v2{axis}>m2{axis}"
        bonds += f" r2>t2{axis}>s{axis}"
    return bond_graph(nodes, bonds)


@pytest.fixture(scope="module")
def two_arms() -> bg.ExplicitRates:
    return bg.explicit(bg.derive(double_pendulum()))


def test_double_pendulum_has_lagranges_rates(two_arms: bg.ExplicitRates) -> None:
    m1, m2, l1, l2, J1, J2 = sp.symbols("m1 m2 l1 l2 J_1 J_2")
    th1, th2, w1, w2 = sp.symbols("th1 th2 w1 w2")
    first = sp.Matrix([l1 * sp.sin(th1), -l1 * sp.cos(th1)])
    second = first + sp.Matrix([l2 * sp.sin(th2), -l2 * sp.cos(th2)])
    angles, rates = sp.Matrix([th1, th2]), sp.Matrix([w1, w2])
    speeds = [place.jacobian(angles) * rates for place in (first, second)]
    kinetic = (
        J1 * w1**2 + J2 * w2**2 + m1 * speeds[0].dot(speeds[0]) + m2 * speeds[1].dot(speeds[1])
    ) / 2
    potential = m1 * g * first[1] + m2 * g * second[1]
    expected = lagrange(kinetic, potential, {"th1": "w1", "th2": "w2"}, [sp.S.Zero, sp.S.Zero])
    agree(two_arms, {**expected, th1: w1, th2: w2})


def test_double_pendulum_is_as_short_as_in_a_textbook(two_arms: bg.ExplicitRates) -> None:
    """In the difference of the angles, over one determinant, which is told once."""
    assert not two_arms.where
    assert sp.cos(sp.Symbol("th1") - sp.Symbol("th2")) in two_arms[sp.Symbol("w1")].atoms(sp.cos)
    assert sum(map(sp.count_ops, two_arms.values())) < 250
    lines = str(two_arms).splitlines()
    assert [line.endswith("/Delta") for line in lines[:2]] == [True, True]
    *_, last = lines
    assert last == (
        "  Delta = -l1**2*l2**2*m2**2*cos(th1 - th2)**2 + (J_2 + l2**2*m2)*(J_1 + l1**2*m1 + l1**2*m2)"
    )


def test_double_pendulum_is_shown_whole() -> None:
    text = str(bg.derive(double_pendulum()))
    assert [name for name in ("w1", "w2", "th1", "th2") if f"{name}'" not in text] == []


def cart_pendulum() -> nx.DiGraph:
    """A cart that a force drives, and a mass on a rod that hangs from it; theta from hanging."""
    nodes = [bg.Se("force", "F"), bg.One("cart"), bg.I("M", "M", flow="v"), bg.Df("way", integrate="x"),
             bg.One("turn"), bg.I("J", "J", flow="w"), bg.Df("angle", integrate="theta"),
             bg.TF("tx", "l*cos(theta)"), bg.TF("ty", "l*sin(theta)"), bg.Zero("sum"), bg.One("vx"),
             bg.I("mx", "m", priority=-1), bg.One("vy"), bg.I("my", "m", priority=-1),
             bg.Se("weight", "-m*g")]  # fmt: skip
    return bond_graph(
        nodes,
        "force>cart>M cart>way cart>sum turn>J turn>angle turn>tx>sum>vx>mx turn>ty>vy>my weight>vy",
    )


def test_cart_pendulum_has_the_textbooks_rates() -> None:
    """Without the rod's inertia: ``x'' (M + m sin^2) = F + m sin (l w^2 + g cos)``."""
    M, m, arm, J, F = sp.symbols("M m l J F")
    theta, w, v, x = sp.symbols("theta w v x")
    found = bg.explicit(bg.derive(cart_pendulum()))
    kinetic = (
        M * v**2
        + J * w**2
        + m * ((v + arm * w * sp.cos(theta)) ** 2 + (arm * w * sp.sin(theta)) ** 2)
    ) / 2
    expected = lagrange(
        kinetic, -m * g * arm * sp.cos(theta), {"x": "v", "theta": "w"}, [F, sp.S.Zero]
    )
    agree(found, {**expected, x: v, theta: w})
    light = {
        v: (F + m * sp.sin(theta) * (arm * w**2 + g * sp.cos(theta))) / (M + m * sp.sin(theta) ** 2)
    }
    agree({v: found[v].xreplace({J: sp.S.Zero})}, light)


def test_squares_of_sines_and_cosines_are_put_together() -> None:
    """A mass on a turning arm as two dependent ones: what turns is ``J + m l^2``."""
    nodes = [bg.Se("T", "T"), bg.One("turn"), bg.I("J", "J", flow="w"), bg.Df("angle", integrate="theta"),
             bg.TF("tx", "l*cos(theta)"), bg.TF("ty", "l*sin(theta)"), bg.One("vx"), bg.One("vy"),
             bg.I("mx", "m", priority=-1), bg.I("my", "m", priority=-1)]  # fmt: skip
    found = bg.explicit(bg.derive(bond_graph(
        nodes, "T>turn>J turn>angle turn>tx>vx>mx turn>ty>vy>my"
    )))  # fmt: skip
    T, J, m, arm, w = sp.symbols("T J m l w")
    assert found == {w: T / (J + arm**2 * m), sp.Symbol("theta"): w}

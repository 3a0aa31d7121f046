"""Nonlinear storages with derivative causality: a law and its inverse, against hand derivations."""

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp, Sine, simulator

C1, q0, E0, e = sp.symbols("C1 q0 E0 e")
JUNCTION = {"law": "E0*log(1 + q_diode/q0)", "inverse": "q0*(exp(e_diode/E0) - 1)"}


def _graph(**more: object) -> nx.DiGraph:
    """A capacitance and a diode's nonlinear one on one node: only one of them can be a state."""
    nodes = [bg.Sf("i", "i"), bg.Zero("n"), bg.C("c", "C1", effort="e", priority=1),
             bg.C("diode", **JUNCTION, **more)]  # fmt: skip
    return bond_graph(nodes, "i>n>c n>diode")


def _parallel() -> bg.StateEquations:
    return bg.derive(_graph(), outputs=[])


def test_a_dependent_nonlinear_capacitance_adds_its_slope_to_a() -> None:
    """(C1 + dq/de) e' = i, dq/de = q0/E0 exp(e/E0)."""
    equations = _parallel()
    assert equations.states == (e,)
    assert sp.simplify(equations.A[0] - C1 - q0 / E0 * sp.exp(e / E0)) == 0
    assert (equations.J.todok(), equations.B.tolist()) == ({}, [[1]])
    assert equations.varying == (e,)


def test_the_higher_priority_becomes_the_state() -> None:
    assert bg.assign_causality(_graph()).integral == ("c",)
    assert bg.assign_causality(_graph(priority=2)).integral == ("diode",)


def test_the_charge_on_both_is_what_the_source_gave() -> None:
    numbers = {"C1": 0.3, "q0": 0.2, "E0": 0.5}
    times = np.linspace(0, 2, 41)
    dependent = simulator(_parallel(), numbers).run(times, inputs={"i": Sine(0.4, 0.7)})
    # The charge i puts on both: C1 e + q0 (exp(e/E0) - 1).
    w = 2 * np.pi * 0.7
    charge = 0.4 * (1 - np.cos(w * times)) / w
    e_ = dependent["e"]
    assert 0.3 * e_ + 0.2 * (np.exp(e_ / 0.5) - 1) == pytest.approx(charge, abs=1e-9)
    assert dependent.power("i") == pytest.approx(
        dependent.power("c") + dependent.power("diode"), abs=1e-12
    )


def test_a_relativistic_mass_behind_a_lever() -> None:
    """p = m v/sqrt(1 - v^2/c^2), v = n w: dp/dv = m/(1 - v^2/c^2)^(3/2) is the mass that w feels."""
    law, inverse = "p_fast/sqrt(m**2 + p_fast**2/c**2)", "m*f_fast/sqrt(1 - f_fast**2/c**2)"
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1), bg.TF("lever", "n"),
             bg.One("b"), bg.I("fast", law=law, inverse=inverse)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "T>a>J a>lever>b>fast"), outputs=[])
    J, m, n, w, c = sp.symbols("J m n w c", positive=True)
    felt = m / (1 - (n * w / c) ** 2) ** sp.Rational(3, 2)
    found = equations.A[0].subs({sp.Symbol(s.name): s for s in (J, m, n, w, c)})
    assert sp.simplify(found - J - n**2 * felt) == 0


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"law": "k*q_c", "inverse": "k*e_c"}, "e_c[*]k is not the inverse of k[*]q_c"),
        ({"value": "c", "inverse": "e_c"}, "an inverse belongs to the law or the energy"),
    ],
)
def test_what_is_no_inverse_is_refused(attributes: dict, message: str) -> None:
    nodes = [bg.Sf("i", "i"), bg.Zero("n"), bg.C("c", **attributes)]
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(bond_graph(nodes, "i>n>c"))


def test_what_a_law_holds_is_read_whatever_the_causality() -> None:
    """A value, a law, friction's level and a switch that read a dependent storage's displacement.

    At u = 2 the compliance ``e = q + q**3`` holds q = 1, at u = 10 it holds 2.
    """
    nodes = [bg.Se("u", "u"), bg.Zero("n"), bg.C("c", law="q_c + q_c**3"), bg.One("w"),
             bg.R("R", "1 + q_c"), bg.R("by_law", law="(1 + q_c)*f_law", flow="f_law", effort="e_law"),
             bg.One("v"), bg.TF("gear", "q_c"), bg.R("load", "1"),
             bg.One("moved"), bg.I("m", "1", flow="y"), bg.R("rub", law=bg.DryFriction("3*q_c"))]  # fmt: skip
    graph = bond_graph(nodes, "u>n>c n>w>R n>v>by_law n>gear>load n>moved>m moved>rub")
    ready = simulator(bg.derive(graph), {})
    for u, q in ((2.0, 1.0), (10.0, 2.0)):
        run = ready.run([0.0, 0.1], inputs={"u": u})
        assert run["f_R"][0] == pytest.approx(u / (1 + q))
        assert run["f_law"][0] == pytest.approx(u / (1 + q))
        assert run["e_load"][0] == pytest.approx(u / q)
        # Held up to 3 q: at u = 2, not at 10.
        assert run["y"][-1] == pytest.approx(max(0.0, 0.1 * (u - 3 * q)), abs=1e-9)


def test_a_switch_may_read_what_a_dependent_law_holds() -> None:
    """Off until q passes 1, where ``q + q**3`` is 2: at t = 2 of a ramp."""
    nodes = [bg.Se("u", "u"), bg.Zero("n"), bg.C("c", law="q_c + q_c**3"), bg.One("w"),
             bg.R("R", "1"), bg.Sw("s", on="q_c - 1", off="0.5 - q_c")]  # fmt: skip
    ready = simulator(bg.derive(bond_graph(nodes, "u>n>c n>w>R w>s")), {})
    run = ready.run(np.linspace(0, 3, 31), inputs={"u": Ramp(0.0, 1.0)})
    assert [event.time for event in run.events] == pytest.approx([2.0], abs=1e-9)

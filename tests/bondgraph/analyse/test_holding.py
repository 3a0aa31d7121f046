"""`holding_efforts` and `linearize(stuck=...)`: against Newton, Lagrange, and graphs of merged shafts."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences, leading_minors, rationals

import bondgraph as bg
from codegen import simulator

I_1, I_2, I_c, I_r, I_s, P, T_1, T_2 = sp.symbols("I_1 I_2 I_c I_r I_s P T_1 T_2")
b, k, m, n, r, s = sp.symbols("b k m n r s")


def _two_inertias(*more: str) -> bg.StateEquations:
    """T_1 on I_1, T_2 against I_2, and a clutch between them."""
    nodes = [
        bg.Se("e", "T_1"), bg.One("one"), bg.I("i_1", "I_1", flow="w_1"), bg.Zero("z"),
        bg.R("clutch", effort="T_c"), bg.One("two"), bg.I("i_2", "I_2", flow="w_2"),
        bg.Se("l", "T_2"), *(bg.R(name) for name in more),
    ]  # fmt: skip
    bonds = " ".join(f"one>{name}" for name in more)
    return bg.derive(bond_graph(nodes, f"e>one>i_1 one>z>clutch z>two>i_2 two>l {bonds}"))


def _planetary() -> bg.StateEquations:
    """w_s + k w_r = (1 + k) w_c, torques T_1 on the sun and T_2 on the carrier, a brake on the ring."""
    nodes = [
        bg.Se("e", "T_1"), bg.One("sun"), bg.I("i_s", "I_s", flow="w_s"), bg.Zero("sum"),
        bg.Se("l", "T_2"), bg.One("carrier", flow="w_c"), bg.I("i_c", "I_c", priority=-1),
        bg.TF("arm", "1 + k"), bg.TF("teeth", "1/k"), bg.One("ring"), bg.I("i_r", "I_r", flow="w_r"),
        bg.R("brake", effort="T_b"),
    ]  # fmt: skip
    bonds = "e>sun>i_s l>carrier>i_c carrier>arm>sum sum>sun sum>teeth>ring ring>i_r ring>brake"
    return bg.derive(bond_graph(nodes, bonds))


def _stack() -> bg.StateEquations:
    """A block m pushed by P on a block n that lies on the ground; friction between and below."""
    nodes = [
        bg.Se("push", "P"), bg.One("top"), bg.I("m", "m", flow="v"), bg.Zero("z"),
        bg.R("between", effort="F_b"), bg.One("low"), bg.I("n", "n", flow="w"),
        bg.R("ground", effort="F_g"),
    ]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>top>m top>z>between z>low>n low>ground"))


def _holds(equations: bg.StateEquations, stuck: list[str], **expected: object) -> None:
    found = bg.holding_efforts(equations, stuck)
    assert {str(name) for name in found} == expected.keys()
    for name, effort in expected.items():
        assert sp.simplify(found[sp.Symbol(name)] - effort) == 0, name


def test_ground_holds_a_block_on_a_spring_and_a_damper() -> None:
    nodes = [
        bg.Se("push", "P"), bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", "1/k", effort="F_k"),
        bg.R("b", "b"), bg.R("ground", effort="F"),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>j j>m j>k j>b j>ground"))
    v, F_k = sp.symbols("v F_k")
    _holds(equations, ["ground"], F=P - F_k - b * v)
    _holds(equations, [])
    model = bg.linearize(equations, stuck=["ground"], outputs=["F_k", "v"])
    assert (model.states, model.inputs) == ((F_k,), (P,))
    for matrix, expected in ((model.A, [[1 / k]]), (model.J, [[0]]), (model.F, [[1], [0]])):
        assert differences(matrix, expected) == {}


def test_blocks_on_one_another_are_held_together_and_alone() -> None:
    F_b, F_g = sp.symbols("F_b F_g")
    _holds(_stack(), ["between", "ground"], F_b=P, F_g=P)
    _holds(_stack(), ["between"], F_b=(n * P + m * F_g) / (m + n))
    _holds(_stack(), ["ground"], F_g=F_b)


def test_locked_clutch_carries_what_the_other_inertia_needs() -> None:
    """(I_1 + I_2) w' = T_1 - T_2 and I_2 w' = T_c - T_2."""
    together = (I_2 * T_1 + I_1 * T_2) / (I_1 + I_2)
    _holds(_two_inertias(), ["clutch"], T_c=together)
    model = bg.linearize(_two_inertias(), stuck=["clutch"], outputs=["w_1", "w_2", "f_clutch"])
    whole = 1 / (s * (I_1 + I_2))
    expected = [[whole, -whole], [whole, -whole], [0, 0]]
    assert differences(model.transfer_function(), expected) == {}


def test_brake_on_the_ring_of_a_planetary_gear() -> None:
    """Lagrange over w_s and w_r, with w_c = (w_s + k w_r)/(1 + k); the ring at rest."""
    to_carrier = sp.Matrix([1, k]) / (1 + k)
    M = sp.diag(I_s, I_r) + I_c * to_carrier * to_carrier.T
    torque = sp.Matrix([T_1, 0]) + T_2 * to_carrier
    rate = torque[0] / M[0, 0]
    _holds(_planetary(), ["brake"], T_b=torque[1] - M[1, 0] * rate)
    model = bg.linearize(_planetary(), stuck=["brake"], outputs=["w_s", "w_r", "w_c"])
    w_s = sp.Matrix([[1, 1 / (1 + k)]]) / (s * M[0, 0])
    expected = sp.Matrix.vstack(w_s, sp.zeros(1, 2), w_s / (1 + k))
    assert differences(model.transfer_function(), expected) == {}


def test_port_beside_a_resistance_is_held_at_once() -> None:
    """No slip at p: all of the speed of the mass goes through r."""
    nodes = [bg.One("j"), bg.I("m", "m", flow="w"), bg.Zero("z"), bg.R("p"), bg.R("r", "r")]
    equations = bg.derive(bond_graph(nodes, "j>m j>z z>p z>r"))
    _holds(equations, ["p"], e_p=r * sp.Symbol("w"))
    held = bg.linearize(equations, stuck=["p"], outputs=["w"])
    assert (held.states, held.J.tolist()) == ((sp.Symbol("w"),), [[-r]])


def test_efforts_are_those_of_a_simulator_that_sticks() -> None:
    values, pushes = {"m": 2.0, "n": 3.0, "hold": 50.0}, {"P": 20.0, "F_g": 4.0}
    run = simulator(_stack(), values, laws={"between": bg.DryFriction("hold")})
    result = run.run(np.linspace(0, 1, 5), {"v": 1.0, "w": 1.0}, inputs=pushes)
    held = bg.holding_efforts(_stack(), ["between"])[sp.Symbol("F_b")]
    assert result["F_b"] == pytest.approx(float(held.subs({**values, **pushes})), rel=1e-9)
    model = bg.linearize(_stack(), stuck=["between"]).numeric(values)
    assert model.inputs == run.inputs == ("P", "F_g")
    rate = float((model.Q @ [20.0, 4.0])[0])
    assert run.rhs(0, [1, 1], [20, 4]) == pytest.approx([rate, rate], rel=1e-9)


@pytest.mark.parametrize("law", [bg.DryFriction("T_h", "1 + exp(-slip)"), "c*f_clutch**2"])
def test_stuck_port_needs_neither_its_law_nor_its_slip(law: object) -> None:
    free = bg.linearize(_two_inertias(), stuck=["clutch"])
    assert bg.linearize(_two_inertias(), laws={"clutch": law}, stuck=["clutch"]) == free


def _driveline(locked: bool) -> bg.StateEquations:
    """Two shafts joined by a clutch, or made one, then a spring with a damper, a gear, a load."""
    nodes = [
        bg.Se("e", "T_1"), bg.One("one"), bg.I("i_1", "I_1", flow="w_1"), bg.R("b", "b"),
        bg.Zero("z"), bg.R("clutch"), bg.One("two"), bg.I("i_2", "I_2"), bg.Zero("y"), bg.One("x"),
        bg.C("spring", "1/k"), bg.R("d", "c"), bg.TF("gear", "r"), bg.One("load"),
        bg.I("m", "m", flow="w"), bg.Se("l", "T_2"),
    ]  # fmt: skip
    rest = "e>one>i_1 one>b y>x x>spring x>d y>gear>load>m load>l"
    if not locked:
        return bg.derive(bond_graph(nodes, f"{rest} one>z>clutch z>two>i_2 two>y"))
    kept = [node for node in nodes if node[0] not in ("z", "clutch", "two")]
    return bg.derive(bond_graph(kept, f"{rest} one>i_2 one>y"))


def test_locked_driveline_is_the_one_built_with_merged_shafts() -> None:
    outputs = ["w_1", "w", "e_spring"]
    stuck = bg.linearize(_driveline(False), stuck=["clutch"], outputs=outputs)
    merged = bg.linearize(_driveline(True), outputs=outputs)
    assert len(stuck.states) == len(merged.states) == 3
    found = stuck.transfer_function()
    assert differences(found, merged.transfer_function()) == {}
    assert found[0, 0].subs(s, 0) != 0


@pytest.mark.parametrize(
    ("equations", "stuck", "left"),
    [
        (_driveline(False), ["clutch"], 3), (_planetary(), ["brake"], 1), (_stack(), ["between"], 1),
        (_two_inertias("a", "o"), ["clutch"], 1), (_two_inertias("a"), ["clutch", "a"], 0),
        (_two_inertias("a", "o"), ["a", "o"], 1),
    ],
)  # fmt: skip
def test_what_is_left_has_a_positive_energy(
    equations: bg.StateEquations, stuck: list[str], left: int
) -> None:
    model = bg.linearize(equations, stuck=stuck)
    assert len(model.states) == left
    assert model.A == model.A.T
    values = {str(name): Fraction(3 + at, 7) for at, name in enumerate(model.parameters)}
    assert all(minor > 0 for minor in leading_minors(rationals(model.A, values)))


@pytest.mark.parametrize("act", [bg.holding_efforts, lambda e, s: bg.linearize(e, stuck=s)])
@pytest.mark.parametrize(
    ("stuck", "message"),
    [("clutch", "stuck must be a list of nodes, not 'clutch'"), (3, "a list of nodes, not 3"),
     (["e"], "no open port is called 'e' that could stick; there are clutch, a"),
     (["i_1"], "no open port is called 'i_1'"), (["T_c"], "no open port is called 'T_c'")],
)  # fmt: skip
def test_only_open_ports_stick(act: object, stuck: object, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        act(_two_inertias("a"), stuck)


def test_ports_that_hold_one_another_are_refused() -> None:
    with pytest.raises(bg.StructureError, match=r"'a', 'o' hold one another.*not unique"):
        bg.holding_efforts(_two_inertias("a", "o"), ["a", "o"])
    with pytest.raises(
        bg.SignalError, match="shows what one of 'a', 'o' gives, which hold together"
    ):
        bg.linearize(_two_inertias("a", "o"), stuck=["a", "o"], outputs=["e_a"])


def test_what_holds_a_port_is_an_output_of_a_linear_model() -> None:
    """As above: (I_1 + I_2) w' = T_1 - T_2 and I_2 w' = T_c - T_2; a brake takes T_1 - T_c."""
    model = bg.linearize(_two_inertias(), stuck=["clutch"], outputs=["T_c", "w_2"])
    expected = [
        [I_2 / (I_1 + I_2), I_1 / (I_1 + I_2)],
        [1 / (s * (I_1 + I_2)), -1 / (s * (I_1 + I_2))],
    ]
    assert differences(model.transfer_function(), expected) == {}
    both = bg.linearize(_two_inertias("a"), stuck=["a", "clutch"], outputs=["T_c", "e_a"])
    assert differences(both.transfer_function(), [[0, 1], [1, -1]]) == {}


def test_port_that_needs_the_rate_of_an_input_is_told_over_it() -> None:
    """The slip between a driven shaft and an inertia is w - v, so n w' holds it."""
    nodes = [bg.Sf("w", "w"), bg.Zero("z"), bg.R("p"), bg.One("k"), bg.I("n", "n", flow="v")]
    equations = bg.derive(bond_graph(nodes, "w>z z>p z>k>n"))
    _holds(equations, ["p"], e_p=n * sp.Symbol("d_w"))


def test_port_that_holds_against_an_imposed_speed_makes_it_that_of_the_inertia() -> None:
    """v = w, so the port carries n w' and no state is left."""
    nodes = [
        bg.Sf("w", "w"),
        bg.Zero("z"),
        bg.R("p"),
        bg.One("k"),
        bg.I("n", "n", flow="v"),
        bg.R("b", "b"),
    ]
    equations = bg.derive(bond_graph(nodes, "w>z z>p z>k>n k>b"))
    model = bg.linearize(equations, stuck=["p"], outputs=["v", "e_p", "f_p"])
    assert model.states == ()
    assert differences(model.D, [[1], [b], [0]]) == {}
    assert differences(model.G, [[0], [n], [0]]) == {}


def test_a_port_whose_effort_is_undone_does_not_hold() -> None:
    """m v' = -e_s - e_p with a law that gives -e_p."""
    nodes = [bg.R("s", law="-e_p"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("p")]
    equations = bg.derive(bond_graph(nodes, "j>s j>m j>p"))
    with pytest.raises(bg.DependentSourceError, match="what is given at 'p' does not hold"):
        bg.linearize(equations, stuck=["p"])


def test_two_imposed_speeds_are_not_held_together() -> None:
    nodes = [bg.Sf("one", "w_1"), bg.Zero("z"), bg.R("p"), bg.One("k"), bg.Sf("two", "w_2")]
    equations = bg.derive(bond_graph(nodes, "one>z z>p z>k two>k"))
    with pytest.raises(
        bg.DependentSourceError, match="inputs alone rule what is to be held at 'p'"
    ):
        bg.linearize(equations, stuck=["p"])

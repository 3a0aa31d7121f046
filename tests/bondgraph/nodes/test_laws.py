"""What closes a port: expressions, and dry friction after Eq. (17) of the paper."""

import dataclasses

import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from bondgraph.nodes.laws import law
from codegen import simulator

slip, v_s = sp.symbols("slip v_s")


def test_coulomb_friction_has_one_level() -> None:
    friction = bg.DryFriction("tau_h")
    assert (friction.level, friction.curve, friction.breakaway) == (sp.Symbol("tau_h"), 1, 1)
    assert friction.free_symbols == {sp.Symbol("tau_h")}


def test_breakaway_is_the_curve_at_standstill() -> None:
    """The normalised Stribeck curve: T_S/T_C at zero slip."""
    friction = bg.DryFriction("tau_h", "1 + (T_S/T_C - 1)*exp(-slip/v_s)")
    T_S, T_C = sp.symbols("T_S T_C")
    assert sp.simplify(friction.breakaway - T_S / T_C) == 0
    assert friction.free_symbols == {sp.Symbol("tau_h"), v_s, T_S, T_C}


def test_breakaway_may_lie_above_the_curve() -> None:
    assert bg.DryFriction(100, breakaway=1.25).breakaway == sp.Rational(5, 4)


def test_breakaway_below_the_curve_is_refused() -> None:
    with pytest.raises(bg.ExpressionError, match="breakaway 9/10 is below the curve"):
        bg.DryFriction(100, "1 + 0*slip", 0.9)


@pytest.mark.parametrize("curve", ["1/slip", "log(slip)"])
def test_curve_that_is_infinite_at_standstill_is_refused(curve: str) -> None:
    with pytest.raises(bg.ExpressionError, match="not finite at slip = 0"):
        bg.DryFriction(100, curve)


@pytest.mark.parametrize("level", [None, "open('f')", float("inf"), [1]])
def test_level_that_is_no_expression_is_refused(level: object) -> None:
    with pytest.raises(bg.ExpressionError, match="level of dry friction"):
        bg.DryFriction(level)


def test_constant_level_below_zero_is_refused() -> None:
    """Friction that drives is no friction."""
    with pytest.raises(bg.ExpressionError, match="level of dry friction"):
        bg.DryFriction(-1)


def test_friction_is_a_frozen_value() -> None:
    friction = bg.DryFriction("mu")
    assert friction == bg.DryFriction("mu", 1, 1)
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign"):
        friction.level = sp.Integer(2)  # type: ignore[misc]


def test_law_of_text_number_or_expression() -> None:
    assert law("2*x", "here") == bg.ExpressionLaw(2 * sp.Symbol("x"))
    assert law(0.5, "here") == bg.ExpressionLaw(sp.Rational(1, 2))
    assert law(slip**2, "here") == bg.ExpressionLaw(slip**2)


def test_ready_law_is_kept() -> None:
    for ready in (bg.DryFriction("mu"), bg.ExpressionLaw(slip)):
        assert law(ready, "here") is ready


def test_law_with_a_state_names_it() -> None:
    twist = sp.Symbol("q_k")
    assert law("k*q_k", "node 'k'", twist).free_symbols == {sp.Symbol("k"), twist}
    for ready in (bg.DryFriction("mu"), bg.ExpressionLaw(slip), bg.ExpressionLaw(slip, slip)):
        with pytest.raises(bg.ExpressionError, match=r"node 'k': a storage takes .* q_k"):
            law(ready, "node 'k'", twist)


OWN = {
    "level": bg.DryFriction("tau_b"),
    "curve": bg.DryFriction(5, "1 + tau_b**2*exp(-slip)"),
    "breakaway": bg.DryFriction("L", 1, "1 + tau_b/10"),
}


def _braked(law: object) -> bg.StateEquations:
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("brake", law=law, effort="tau_b")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>brake"))


@pytest.mark.parametrize("part", OWN)
def test_friction_told_by_its_own_effort_is_refused(part: str) -> None:
    """Declared, and put over the port later, by its node or by the effort."""
    message = rf"'brake': the {part} of dry friction uses tau_b, .* itself; .* another name"
    with pytest.raises(bg.StructureError, match=message):
        _braked(OWN[part])
    plain = _braked(bg.DryFriction("L"))
    for key in ("brake", "tau_b"):
        with pytest.raises(bg.StructureError, match=message):
            simulator(plain, {"m": 1.0, "L": 2.0}, {key: OWN[part]})


def test_the_effort_may_not_come_under_another_name_either() -> None:
    """At a 0-junction on one bond the effort of the junction is that of the brake."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("b"),
             bg.R("brake", law=bg.DryFriction("e_b"), effort="tau_b")]  # fmt: skip
    with pytest.raises(bg.StructureError, match="'brake': the level of dry friction uses e_b"):
        bg.derive(bond_graph(nodes, "push>n>m n>b>brake"))


def test_friction_may_be_told_by_what_it_receives_and_by_other_efforts() -> None:
    equations = _braked(bg.DryFriction("L + P/2", "1 + exp(-slip)", "2 + v**2"))
    assert simulator(equations, {"m": 1.0, "L": 2.0}).inputs == ("P",)

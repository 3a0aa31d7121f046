"""`holding_efforts` where friction gives its flow, and where rates of inputs count: by hand."""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp, simulator

F, F_1, F_2, P, c, k, m, n, r, v, w = sp.symbols("F F_1 F_2 P c k m n r v w")
d_P, d_s, d_w = sp.symbols("d_P d_s d_w")
FRICTION = bg.DryFriction("N")


def _holds(equations: bg.StateEquations, stuck: list[str], **expected: Any) -> None:
    found = bg.holding_efforts(equations, stuck)
    assert list(map(str, found)) == list(expected)
    for name, effort in expected.items():
        assert sp.simplify(found[sp.Symbol(name)] - effort) == 0, name


def _iwan(**more: Any) -> bg.StateEquations:
    """Two springs under one speed, each on a slider: F_1' = k_1 (v - s_1)."""
    nodes = [bg.Sf("pull", "v"), bg.One("rod")]
    for at in (1, 2):
        nodes += [bg.Zero(f"z{at}"), bg.C(f"k{at}", f"1/k_{at}", effort=f"F_{at}"),
                  bg.R(f"slider{at}", effort=f"T_{at}", flow=f"s_{at}", **more)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "pull>rod rod>z1>k1 z1>slider1 rod>z2>k2 z2>slider2"))


@pytest.mark.parametrize("more", [{"law": FRICTION}, {"gives": "effort"}])
def test_a_slider_on_a_spring_is_held_by_the_spring(more: dict) -> None:
    """Its slip is nothing, so the spring's effort is what it has to bear, whatever the other does."""
    _holds(_iwan(**more), ["slider2", "slider1"], T_2=F_2, T_1=F_1)
    _holds(_iwan(**more), ["slider1"], T_1=F_1)


def _pushed(*sliding: Any) -> bg.StateEquations:
    """P pushes m, which a clutch ties to n; n pulls at a spring on a slider."""
    nodes = [bg.Se("push", "P"), bg.One("first"), bg.I("m", "m", flow="v"), bg.Zero("between"),
             bg.R("clutch", effort="T"), bg.One("second"), bg.I("n", "n", flow="w"), bg.Zero("z"),
             bg.C("k", "1/k", effort="F"), bg.R("slider", effort="S", flow="s", **dict(sliding))]  # fmt: skip
    bonds = "push>first>m first>between>clutch between>second>n second>z>k z>slider"
    return bg.derive(bond_graph(nodes, bonds))


@pytest.mark.parametrize("law", [(), [("law", FRICTION)]])
def test_a_clutch_and_a_slider_stick_together(law: Any) -> None:
    """(m + n) v' = P - F and n w' = T - F."""
    together = (n * P + m * F) / (m + n)
    _holds(_pushed(*law), ["clutch", "slider"], T=together, S=F)
    _holds(_pushed(*law), ["slider", "clutch"], S=F, T=together)


def _in_series(**more: Any) -> bg.StateEquations:
    """P pushes m against two frictions in series: v = f + s, one effort on both."""
    nodes = [bg.Se("push", "P"), bg.One("block"), bg.I("m", "m", flow="v"), bg.Zero("z"),
             bg.R("first", effort="F_1", flow="f"), bg.R("second", effort="F_2", flow="s",
                                                         **{"gives": "flow", **more})]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>block>m block>z>first z>second"))


def test_of_two_in_series_one_gives_its_slip_and_the_other_its_effort() -> None:
    """Both stuck, v = 0 and P is on both; one alone: F_2 = F_1, or v = s and m s' = P - F_1."""
    _holds(_in_series(), ["first", "second"], F_1=P, F_2=P)
    _holds(_in_series(), ["second", "first"], F_2=P, F_1=P)
    _holds(_in_series(), ["second"], F_2=F_1)
    _holds(_in_series(), ["first"], F_1=P - m * d_s)


def test_a_port_that_gives_its_flow_beside_a_resistance_receives_what_that_takes() -> None:
    """All of v goes through r."""
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("z"), bg.R("r", "r"),
             bg.R("p", gives="flow")]  # fmt: skip
    _holds(bg.derive(bond_graph(nodes, "j>m j>z>r z>p")), ["p"], e_p=r * v)


def _driven(source: Any, *others: Any, bonds: str = "") -> bg.StateEquations:
    """A clutch between what imposes a speed and n: n v' = e_p."""
    nodes = [source, bg.Zero("z"), bg.R("p"), bg.One("k"), bg.I("n", "n", flow="v"), *others]
    return bg.derive(bond_graph(nodes, f"w>z>p z>k>n {bonds}"))


def _other() -> list[Any]:
    """P pushes m, beside: m x' = P."""
    return [bg.Se("push", "P"), bg.One("o"), bg.I("m", "m", flow="x")]


def _pump(law: str) -> Any:
    return bg.R("w", law=law, gives="flow", flow="q")


@pytest.mark.parametrize(
    ("speed", "rate"),
    [("3*t", 3), ("c*P", c * d_P), ("c*x", c * P / m), ("c*e_m", c * d_P),
     ("c*x*t", c * (sp.Symbol("x") + sp.Symbol("t") * P / m))],
)  # fmt: skip
def test_the_rate_of_what_a_law_imposes_is_told_over_what_it_reads(speed: str, rate: Any) -> None:
    """The pump draws what the law says: v = -q there, so n v' = -n q'."""
    others = _other() if speed != "3*t" else []
    equations = _driven(_pump(speed), *others, bonds="push>o>m" if others else "")
    _holds(equations, ["p"], e_p=-n * rate)


def test_a_speed_that_the_held_inertia_rules_itself_moves_nothing() -> None:
    """The slip is (1 + c) v, which stays at zero by itself."""
    _holds(_driven(_pump("c*v")), ["p"], e_p=0)


def test_a_known_speed_needs_what_a_run_gives() -> None:
    """3 t on an inertia of 1 takes 3."""
    equations = _driven(bg.Sf("w", "3*t"))
    _holds(equations, ["p"], e_p=3 * n)
    told = bg.holding_efforts(_driven(bg.Sf("w", "w")), ["p"])[sp.Symbol("e_p")]
    run = simulator(_driven(bg.Sf("w", "w")), {"n": 1, "N": 50}, {"p": FRICTION}).run(
        np.linspace(0, 1, 5), inputs={"w": Ramp(0, 3)}
    )
    assert run["e_p"] == pytest.approx(float(told.subs({"n": 1, d_w: 3})), rel=1e-9)


def test_a_source_on_a_dependent_inertia_pushes_by_its_rate() -> None:
    """n turns with v + w, so m v' + n (v' + w') = P - F, and v' = 0."""
    nodes = [bg.Se("push", "P"), bg.One("block"), bg.I("m", "m", flow="v"), bg.R("ground", effort="F"),
             bg.Zero("z"), bg.Sf("w", "w"), bg.One("k"), bg.I("n", "n", priority=-1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>block>m block>ground block>z w>z z>k>n"))
    _holds(equations, ["ground"], F=P - n * d_w)


def test_inputs_that_rule_a_slip_alone_leave_nothing_to_hold() -> None:
    equations = _driven(bg.Sf("w", "w"), bg.Sf("other", "u"), bonds="other>k")
    assert equations.states == ()
    with pytest.raises(
        bg.DependentSourceError, match="inputs alone rule what is to be held at 'p'"
    ):
        bg.holding_efforts(equations, ["p"])


def test_rates_that_cannot_be_told_are_refused_by_name() -> None:
    with pytest.raises(
        bg.DependentSourceError, match="the law at 'second' gives, which cannot be told"
    ):
        bg.holding_efforts(_in_series(law=FRICTION), ["first"])
    shown = _driven(_pump("c*e_d"), bg.Sf("s", "P"), bg.One("o"), bg.I("d", "d"), bonds="s>o>d")
    with pytest.raises(bg.DependentSourceError, match="the law at 'w' gives, which cannot be told"):
        bg.holding_efforts(shown, ["p"])

"""Clutch curve, tires and backlash against eqs. (17) to (19), Fig. 5 and Pacejka's formula."""

import math

import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
import codegen
import differentials
from differentials.laws import backlash
from differentials.parts import assemble, compliant_shaft, engine, inertia, shaft, tire

k_t, r, C_t, D_t, E_t, w, w_0 = sp.symbols("k_t r C_t D_t E_t omega_t1 omega_t1_0")
SHORT = differentials.Scenario(80.0, 0.5, 150.0, (100.0, 0.0), 0.01, 0.02, 0.15)


def test_stribeck_falls_from_static_to_coulomb_torque() -> None:
    clutch = differentials.stribeck_clutch("tau_h", 1.3, 0.2)
    curve = sp.lambdify(sp.Symbol("slip"), clutch.curve)
    assert clutch.breakaway == sp.Rational(13, 10)
    assert curve(0.0) == pytest.approx(1.3)
    assert curve(0.2) == pytest.approx(1 + 0.3 * math.exp(-1))
    assert curve(50.0) == pytest.approx(1.0)
    assert (np.diff([curve(slip) for slip in np.linspace(0, 1, 50)]) < 0).all()


def test_equal_static_and_coulomb_torque_is_coulomb_friction() -> None:
    assert differentials.stribeck_clutch("tau_h", 1, 0.1) == differentials.coulomb_clutch("tau_h")


@pytest.mark.parametrize(
    ("ratio", "speed", "message"),
    [(0.9, 0.1, "holds at least what it slips with"), (1.2, 0, "must be positive"), (1.2, -1, "positive")],
)  # fmt: skip
def test_a_clutch_that_holds_less_than_it_slips_with_is_refused(
    ratio: float, speed: float, message: str
) -> None:
    with pytest.raises(bg.ParameterError, match=message):
        differentials.stribeck_clutch("tau_h", ratio, speed)


def test_linear_tire_is_eq_18_with_eq_19() -> None:
    """tau_t = r b_t (w - w_0), b_t = k_t r/v, v = r w_0."""
    v = r * w_0
    law = bg.expression(differentials.linear_tire(1), "tire")
    assert sp.simplify(law - r * (k_t * r / v) * (w - w_0)) == 0


def test_magic_formula_has_the_linear_tires_slope_and_its_own_peak() -> None:
    law = bg.expression(differentials.magic_formula_tire(1), "tire")
    slope = sp.diff(law, w).subs(w, w_0)
    linear = sp.diff(bg.expression(differentials.linear_tire(1), "tire"), w)
    assert sp.simplify(slope - linear) == 0
    numbers = {k_t: 2e5, r: 0.3, C_t: 1.65, D_t: 4000.0, E_t: -1.0, w_0: 80.0}
    torque = sp.lambdify(w, law.subs(numbers))
    slip = np.linspace(-0.3, 0.3, 2001)
    values = torque(80.0 * (1 + slip))
    assert values.max() == pytest.approx(0.3 * 4000.0, rel=1e-5)
    assert values == pytest.approx(-values[::-1], abs=1e-9)
    # Pacejka, by hand at 2 % slip: B s = 200000/(1.65*4000)*0.02.
    x = 2e5 / (1.65 * 4000) * 0.02
    by_hand = 0.3 * 4000 * math.sin(1.65 * math.atan(x + (x - math.atan(x))))
    assert torque(80.0 * 1.02) == pytest.approx(by_hand)


def test_small_slips_of_the_magic_formula_give_the_linear_run() -> None:
    laws = {f"tire_{j}": differentials.magic_formula_tire(j) for j in (1, 2)}
    small = differentials.Scenario(80.0, 0.05, 1.5, (1.0, 0.0), 0.01, 0.02, 0.08)
    linear = differentials.simulate("stationary_tvd", small)
    magic = differentials.simulate("stationary_tvd", small, laws=laws)
    assert magic["tau_hs1"] == pytest.approx(
        linear["tau_hs1"], abs=1e-6 * np.ptp(linear["tau_hs1"])
    )


def test_the_magic_formula_limits_what_a_spinning_wheel_can_take() -> None:
    laws = {f"tire_{j}": differentials.magic_formula_tire(j) for j in (1, 2)}
    run = differentials.simulate("stationary_tvd", SHORT, {"D_t": 300.0}, laws=laws)
    assert abs(run["tau_t1"]).max() <= 0.3 * 300.0 * (1 + 1e-9)
    assert run["omega_t1"][-1] > run["omega_t1"][0] + 1


def test_backlash_is_fig_5() -> None:
    law = sp.lambdify(sp.Symbol("q"), backlash("q", "f", "100", None, "0.2"))
    twist = np.array([-0.5, -0.1, -0.05, 0.0, 0.1, 0.3])
    assert [law(q) for q in twist] == pytest.approx([-40.0, 0, 0, 0, 0, 20.0])


def test_faces_push_and_never_pull() -> None:
    q, f = sp.symbols("q f")
    torque = sp.lambdify((q, f), backlash("q", "f", "100", "5", "0.2"))
    assert torque(0.3, 1.0) == pytest.approx(25.0)
    assert torque(0.3, -10.0) == 0
    assert torque(-0.3, -1.0) == pytest.approx(-25.0)
    assert torque(0.05, 9.0) == 0


def _rattle(gap: str | None) -> codegen.Result:
    """An inertia behind a shaft with play: it flies through the gap, then the spring turns it back."""
    graph = assemble(
        shaft("a"), shaft("b"), engine("motor", "T", at="a"),
        inertia("J_a", 1.0, at="a", speed="w_a"), inertia("J_b", 1.0, at="b", speed="w_b"),
        compliant_shaft("link", "a", "b", "k", gap=gap, torque="tau"), tire(1, at="b"),
    )  # fmt: skip
    laws = {"tire_1": "0*omega_t1"}
    ready = codegen.simulator(bg.derive(graph), {"k": 400.0, "gap": 0.1}, laws=laws)
    return ready.run(np.linspace(0, 0.5, 2001), {"w_a": 1.0, "w_b": -1.0}, {"T": 0.0})


def test_play_is_crossed_freely_and_contact_is_half_an_oscillation() -> None:
    """From the middle at 2 rad/s: 0.025 s through half the gap, pi/sqrt(2 k) in contact, and back."""
    run = _rattle("gap")
    contact = np.pi / np.sqrt(2 * 400.0)
    inside = abs(run["q_link_spring"]) <= 0.05
    assert abs(run["tau"][inside]).max() < 1e-9
    begins, ends = 0.025, 0.025 + contact
    touching = run.time[abs(run["tau"]) > 1e-6]
    assert touching[0] == pytest.approx(begins, abs=5e-4)
    assert touching[touching < 0.1][-1] == pytest.approx(min(ends, 0.1), abs=5e-4)
    height = 2.0 * np.sqrt(400.0 / 2)
    assert run["tau"].max() == pytest.approx(height, rel=1e-4)
    assert run["w_a"] + run["w_b"] == pytest.approx(np.zeros(2001), abs=1e-9)


def test_no_gap_is_the_shaft_without_play() -> None:
    assert _rattle("0")["tau"] == pytest.approx(_rattle(None)["tau"], abs=1e-6)


@pytest.mark.parametrize("name", ["passive", "alsd", "passive_input_shaft"])
def test_the_catalogs_play_lets_torque_through_only_beyond_it(name: str) -> None:
    case = differentials.scenarios[differentials.catalog[name].scenario]
    case = differentials.Scenario(80.0, -0.5, 350.0, case.clutch_torques, 0.02, 0.05, 0.1)
    run = differentials.simulate(name, case, {"gap": 0.04}, backlash=True)
    node, torque = (
        ("input_shaft", "tau_is") if name == "passive_input_shaft" else ("halfshaft_1", "tau_hs1")
    )
    twist = run[f"q_{node}_spring"]
    assert abs(run[torque][abs(twist) < 0.02]).max(initial=0.0) < 1e-9
    assert abs(run[torque]).max() > 10

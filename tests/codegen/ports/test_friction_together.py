"""Ports that lock or let go in the same instant, and ports behind gears and dependent masses."""

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp, Result, Step, simulator

TIMES = np.linspace(0, 2, 161)


def _pair() -> bg.StateEquations:
    """Two masses joined by a spring, each rubbing on the ground, pushed by P_1 and P_2."""
    nodes = [bg.One("n1"), bg.One("n2"), bg.Zero("z"), bg.C("k", "1/k", effort="F"),
             bg.I("m1", "m", flow="v_1"), bg.I("m2", "m", flow="v_2"), bg.Se("p1", "P_1"), bg.Se("p2", "P_2"),
             bg.R("rub1", law=bg.DryFriction("L"), effort="f_1", flow="s_1"),
             bg.R("rub2", law=bg.DryFriction("L"), effort="f_2", flow="s_2")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "n1>m1 n1>rub1 n2>m2 n2>rub2 n1>z>n2 z>k p1>n1 p2>n2"))


def _run(start, push=(0.0, 0.0), times=TIMES) -> Result:
    run = simulator(_pair(), {"m": 2.0, "k": 50.0, "L": 3.0})
    return run.run(times, start, {"P_1": push[0], "P_2": push[1]})


def test_two_masses_that_stop_side_by_side_lock_in_one_instant() -> None:
    result = _run({"v_1": 1.2, "v_2": 1.2})
    assert [(e.port, e.kind) for e in result.events] == [("rub1", "stick"), ("rub2", "stick")]
    assert [e.time for e in result.events] == pytest.approx([0.8, 0.8], abs=1e-10)
    for v in ("v_1", "v_2"):
        assert result[v] == pytest.approx(np.maximum(1.2 - 1.5 * TIMES, 0.0), abs=1e-10)
    assert np.abs(result["F"]).max() < 1e-9


def test_two_masses_that_swing_against_each_other_cross_and_lock_together() -> None:
    """Each has half the spring, 2 k to the middle: w = sqrt(2 k/m), dead zone L."""
    start = 17.3 * 3.0
    result = _run({"F": start}, times=np.linspace(0, 4, 81))
    w = np.sqrt(2 * 50.0 / 2.0)
    kinds = ["cross"] * 2 * 8 + ["stick"] * 2
    assert [e.kind for e in result.events] == kinds
    assert [e.time for e in result.events[::2]] == pytest.approx(
        np.pi / w * np.arange(1, 10), abs=1e-8
    )
    assert [e.time for e in result.events[1::2]] == pytest.approx(
        np.pi / w * np.arange(1, 10), abs=1e-8
    )
    assert result["v_1"] == pytest.approx(-result["v_2"], abs=1e-8)
    assert result["F"][-1] == pytest.approx(0.7 * 3.0, abs=1e-6)


def test_two_masses_let_go_in_one_instant() -> None:
    result = _run({}, (Ramp(0.0, 6.0), Ramp(0.0, -6.0)))
    assert sorted((e.port, e.kind) for e in result.events) == [("rub1", "slip"), ("rub2", "slip")]
    assert [e.time for e in result.events] == pytest.approx([0.5, 0.5], abs=1e-10)
    # m v' = 6 (t - 1/2) - F, F' = 2 k v, antisymmetric: v = 6/(m w^2) (1 - cos w (t - 1/2)).
    w = np.sqrt(50.0)
    after = np.maximum(TIMES - 0.5, 0.0)
    assert result["v_1"] == pytest.approx(3 / 50 * (1 - np.cos(w * after)), abs=1e-8)
    assert result["v_2"] == pytest.approx(-result["v_1"], abs=1e-8)


def test_one_locks_and_the_other_goes_on() -> None:
    """Mass 2 never moves, since the spring stays within its level; mass 1 alone is an oscillator."""
    result = _run({"v_1": 0.3}, times=np.linspace(0, 1, 101))
    # 2 v' = -F - 3, F' = 50 v from v = 0.3: F = 3 (cos 5 t - 1) + 3 sin 5 t, at most 3 (sqrt(2) - 1).
    t = result.time
    stop = np.arctan(0.3 * 5 * 2 / 3) / 5
    F = np.where(t < stop, 3 * (np.cos(5 * t) - 1) + 3 * np.sin(5 * t), 0.0)
    F[t >= stop] = 3 * (np.cos(5 * stop) - 1) + 3 * np.sin(5 * stop)
    assert [(e.port, e.kind) for e in result.events] == [("rub1", "stick")]
    assert result.events[0].time == pytest.approx(stop, abs=1e-10)
    assert result["F"] == pytest.approx(F, abs=1e-8)
    assert not result["v_2"].any()


def _geared(ratio: float) -> bg.StateEquations:
    """A brake on a shaft behind a gear, whose own inertia is dependent: m + r^2 J on the road side."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.TF("gear", "r"), bg.One("o"),
             bg.I("j", "J"), bg.R("brake", law=bg.DryFriction("L"), effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>gear>o>j o>brake"))


@pytest.mark.parametrize("ratio", [3.0, -0.4])
def test_a_brake_behind_a_gear_acts_with_the_ratio(ratio: float) -> None:
    """v' = (P - |r| L)/(m + r^2 J) while P = 9 to 1.0, then -|r| L/(m + r^2 J) to rest."""
    m, J, L = 2.0, 0.5, 1.5
    run = simulator(_geared(ratio), {"m": m, "J": J, "L": L, "r": ratio})
    result = run.run(TIMES * 3, inputs={"P": Step(1.0, 0.0, 9.0)})
    mass, drag = m + ratio**2 * J, abs(ratio) * L
    peak = (9.0 - drag) / mass
    stop = 1.0 + peak * mass / drag
    expected = np.interp(TIMES * 3, [0, 1, stop], [0, peak, 0])
    assert result["v"] == pytest.approx(expected, abs=1e-9)
    assert result["s"] == pytest.approx(ratio * expected, abs=1e-9)
    kept = [(e.time, e.kind) for e in result.events]
    assert kept == ([(pytest.approx(stop, abs=1e-9), "stick")] if stop < 6 else [])


def _constrained(r: float) -> bg.StateEquations:
    """Two brakes on one shaft, the second behind a gear of ratio r: both lock one and the same motion."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.TF("gear", "r"),
             bg.R("b1", law=bg.DryFriction("L_1"), effort="f_1", flow="s_1"),
             bg.R("b2", law=bg.DryFriction("L_2"), effort="f_2", flow="s_2")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>b1 n>gear>b2"))


@pytest.mark.parametrize("ratio", [2.0, -0.5, 0.1])
def test_redundant_brakes_in_different_gears_share_by_level(ratio: float) -> None:
    """f_1 + r f_2 = P with f_1/L_1 = |f_2|/L_2: let go together at P = L_1 + |r| L_2."""
    run = simulator(_constrained(ratio), {"m": 2.0, "L_1": 3.0, "L_2": 1.0, "r": ratio})
    result = run.run(TIMES, inputs={"P": Ramp(0.0, 4.0)})
    total = 3.0 + abs(ratio)
    locked = total - 1e-9 > 4 * TIMES
    fraction = 4 * TIMES[locked] / total
    assert result["f_1"][locked] == pytest.approx(3.0 * fraction, abs=1e-9)
    assert result["f_2"][locked] == pytest.approx(np.sign(ratio) * fraction, abs=1e-9)
    assert sorted((e.port, e.kind) for e in result.events) == [("b1", "slip"), ("b2", "slip")]
    assert [e.time for e in result.events] == pytest.approx([total / 4] * 2, abs=1e-9)
    after = np.maximum(TIMES - total / 4, 0.0)
    assert result["v"] == pytest.approx(after**2, abs=1e-9)


def _lever() -> bg.StateEquations:
    """A speed V shared between two masses, v_1 + v_2 = V, of which one rubs on the ground.

    (m_1 + m_2) v_1' = m_2 V' - f: the imposed speed acts through the dependent mass.
    """
    nodes = [bg.Sf("drive", "V"), bg.Zero("beam"), bg.One("n1"), bg.I("m1", "m_1", flow="v_1", priority=1),
             bg.I("m2", "m_2", flow="v_2"),
             bg.R("rub", law=bg.DryFriction("L"), effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "drive>beam>n1>m1 n1>rub beam>m2"))


def test_a_step_through_a_dependent_mass_tears_a_port_loose() -> None:
    """v_1 jumps by m_2/(m_1 + m_2) of the step and is braked by L/(m_1 + m_2) until it holds again."""
    equations = _lever()
    assert equations.E.todok()
    run = simulator(equations, {"m_1": 1.0, "m_2": 3.0, "L": 6.0})
    result = run.run(TIMES, inputs={"V": Step(0.5, 1.2) + Step(1.5, -0.4)})
    expected = np.interp(TIMES, [0.5, 1.1], [0.9, 0]) * (TIMES >= 0.5)
    expected += np.interp(TIMES, [1.5, 1.7], [-0.3, 0]) * (TIMES >= 1.5)
    assert result["v_1"] == pytest.approx(expected, abs=1e-9)
    assert [(e.time, e.kind) for e in result.events] == [
        (0.5, "slip"), (pytest.approx(1.1, abs=1e-9), "stick"),
        (1.5, "slip"), (pytest.approx(1.7, abs=1e-9), "stick"),
    ]  # fmt: skip


@pytest.mark.parametrize(("slope", "held"), [(1.9, True), (-1.9, True), (2.1, False)])
def test_a_slope_through_a_dependent_mass_pulls_at_a_port_that_holds(
    slope: float, held: bool
) -> None:
    """f = m_2 V' while it holds, up to L = 6."""
    run = simulator(_lever(), {"m_1": 1.0, "m_2": 3.0, "L": 6.0})
    result = run.run(TIMES, inputs={"V": Ramp(0.5, slope)})
    after = TIMES >= 0.5
    acceleration = 0.0 if held else (3 * slope - 6.0) / 4.0
    assert result["f"][after] == pytest.approx(
        np.full(after.sum(), 3 * slope if held else 6.0), abs=1e-9
    )
    assert result["v_1"] == pytest.approx(acceleration * np.maximum(TIMES - 0.5, 0.0), abs=1e-9)

"""Two blocks on top of each other: two friction ports, all nine situations of stick and slip."""

import numpy as np
import pytest
from oracles.contact import piecewise_linear
from oracles.energy import misfit
from oracles.models import stacked_blocks

import bondgraph as bg
from codegen import Constant, Ramp, Result, Signal, Sine, Step, simulator

NUMBERS = {"m_1": 2.0, "m_2": 1.0, "L_1": 3.0, "L_2": 1.0, "r_1": 1, "r_2": 1}
M = np.diag([2.0, 1.0])
W = np.array([[1.0, 0.0], [-1.0, 1.0]])
LEVELS = np.array([3.0, 1.0])

PUSHES = [
    (0.0, 2.0, 0.5), (1.0, 4.5, 0.6), (2.0, 8.0, -2.0), (3.0, 1.0, 2.5), (4.0, -9.0, 0.0),
    (5.0, 0.5, 0.1), (6.5, -4.4, -0.7), (7.5, 0.0, -1.7), (8.5, 3.9, 1.3), (9.5, 0.0, 0.0),
    (12.0, -2.9, -0.05), (13.0, 0.2, 2.2), (14.0, 0.0, 0.0),
]  # fmt: skip


def _steps(values: list[tuple[float, float]]) -> Signal:
    total: Signal = Constant(0.0)
    before = 0.0
    for time, value in values:
        total, before = total + Step(time, value - before), value
    return total


def _run(times: np.ndarray, numbers=NUMBERS, pushes=PUSHES) -> Result:
    inputs = {
        "P_1": _steps([(t, one) for t, one, _ in pushes]),
        "P_2": _steps([(t, other) for t, _, other in pushes]),
    }
    return simulator(bg.derive(stacked_blocks()), numbers).run(times, inputs=inputs)


def _forces(t: float) -> np.ndarray:
    return np.array([entry for entry in PUSHES if entry[0] <= t][-1][1:])


TIMES = np.linspace(0, 16, 641)


def _by_hand(times: np.ndarray) -> np.ndarray:
    kinks = piecewise_linear(M, W, LEVELS, _forces, [t for t, *_ in PUSHES], 16.0)
    starts = np.array([t for t, *_ in kinks])
    at = np.searchsorted(starts, times + 1e-12, side="right") - 1
    return np.array(
        [kinks[i][1] + kinks[i][2] * (t - starts[i]) for i, t in zip(at, times, strict=True)]
    )


def test_velocities_follow_gauss_principle() -> None:
    result = _run(TIMES)
    expected = _by_hand(TIMES)
    assert result["v_1"] == pytest.approx(expected[:, 0], abs=1e-9)
    assert result["v_2"] == pytest.approx(expected[:, 1], abs=1e-9)


def test_all_nine_situations_are_visited() -> None:
    result = _run(TIMES)
    slips = np.column_stack([result["s_1"], result["s_2"]])
    signs = np.where(np.abs(slips) < 1e-9, 0, np.sign(slips)).astype(int)
    assert len({tuple(row) for row in signs.tolist()}) == 9


def test_friction_is_at_its_level_where_it_slips_and_below_where_it_sticks() -> None:
    result = _run(TIMES)
    for port, level in (("1", 3.0), ("2", 1.0)):
        f, s = result[f"f_{port}"], result[f"s_{port}"]
        moving = np.abs(s) > 1e-8
        assert f[moving] == pytest.approx(level * np.sign(s[moving]), rel=1e-12)
        assert np.abs(f).max() <= level * (1 + 1e-9)


def test_held_efforts_are_those_of_statics_and_of_carried_blocks() -> None:
    """At rest each port carries the pushes above it; carried, block 2 needs m_2 times the acceleration."""
    result = _run(np.array([0.0, 0.5, 1.5, 16.0]))
    assert result["f_2"][1] == pytest.approx(0.5, abs=1e-9)
    assert result["f_1"][1] == pytest.approx(2.5, abs=1e-9)
    # 1 < t < 2: pushes 4.5 and 0.6 against 3 move both blocks as one.
    shared = (4.5 + 0.6 - 3.0) / 3.0
    assert result["f_2"][2] == pytest.approx(0.6 - shared, abs=1e-9)
    assert result["v_1"][2] == pytest.approx(0.5 * shared, abs=1e-9)


def _rising(P_1: float) -> Result:
    """Breakaways 4.2 at the ground and 1.8 at the contact; P_2 = t."""
    run = simulator(bg.derive(stacked_blocks()), NUMBERS | {"r_1": 1.4, "r_2": 1.8})
    return run.run(np.linspace(0, 3, 301), inputs={"P_1": P_1, "P_2": Ramp(0.0, 1.0)})


def test_the_ground_lets_go_when_it_has_reached_its_own_breakaway() -> None:
    """2.5 + t = 4.2, the contact holding 1.7 < 1.8; then (2 t + 1/2)/3 at the contact reaches 1.8."""
    result = _rising(2.5)
    assert [(e.port, e.kind) for e in result.events] == [("ground", "slip"), ("contact", "slip")]
    assert [e.time for e in result.events] == pytest.approx([1.7, 2.45], abs=1e-9)
    together = (result.time > 1.7) & (result.time < 2.45)
    t = result.time[together]
    v = ((t - 0.5) ** 2 - 1.2**2) / 6
    assert result["v_1"][together] == pytest.approx(v, abs=1e-9)
    assert result["v_2"][together] == pytest.approx(v, abs=1e-9)


def test_the_contact_lets_go_when_it_has_reached_its_own_breakaway() -> None:
    """At t = 1.8 the ground holds 3.8 < 4.2; from then on it carries 2 + L_2 = 3."""
    result = _rising(2.0)
    assert [e[:3] for e in result.events] == [(pytest.approx(1.8, abs=1e-9), "contact", "slip")]
    after = np.maximum(result.time, 1.8)
    assert result["v_2"] == pytest.approx(((after - 1) ** 2 - 0.8**2) / 2, abs=1e-9)
    assert np.abs(result["v_1"]).max() < 1e-12
    assert result["f_1"][-1] == pytest.approx(3.0, abs=1e-9)


def test_power_is_balanced_through_all_situations() -> None:
    run = simulator(bg.derive(stacked_blocks()), NUMBERS)
    inputs = {"P_1": _steps([(t, p) for t, p, _ in PUSHES]), "P_2": Sine(2.0, 0.3)}
    departure = misfit(
        lambda times: run.run(times, inputs=inputs), [*(t for t, *_ in PUSHES), 16.0],
        lambda r: r["v_1"] ** 2 + r["v_2"] ** 2 / 2,
        lambda r: r["P_1"] * r["v_1"] + r["P_2"] * r["v_2"] - r["f_1"] * r["s_1"] - r["f_2"] * r["s_2"],
    )  # fmt: skip
    assert departure < 1e-9

"""Friction beside or behind a resistance: its slip depends at once on its own effort (D not zero)."""

import shutil
from itertools import pairwise

import numpy as np
import pytest
from oracles.energy import misfit
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Sampled, Sine, Step, simulator

TIMES = np.linspace(0, 3, 241)


def _slider(law: object = bg.DryFriction("L")) -> bg.StateEquations:
    """A plate without mass: a force P against friction and a damper b side by side, b s = P - f."""
    nodes = [bg.Se("push", "P"), bg.One("plate"), bg.R("damper", "b"),
             bg.R("rub", law=law, effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>plate>damper plate>rub"))


def _dead_zone(P: np.ndarray, L: float) -> np.ndarray:
    return np.sign(P) * np.maximum(np.abs(P) - L, 0.0)


def test_a_plate_without_mass_moves_by_the_excess_of_the_force() -> None:
    """s = dead zone(P)/b at every instant; the friction holds what is below its level."""
    result = simulator(_slider(), {"b": 4.0, "L": 2.0}).run(
        TIMES, inputs={"P": Sine(5.0, 0.9, 0.3)}
    )
    P = result["P"]
    assert result["s"] == pytest.approx(_dead_zone(P, 2.0) / 4, abs=1e-9)
    assert result["f"] == pytest.approx(np.clip(P, -2, 2), abs=1e-9)


def test_a_plate_without_mass_whose_friction_rises_with_its_slip() -> None:
    """P = (b + L c) s + L beyond L: friction and slip determine each other."""
    law = bg.DryFriction("L", "1 + c*slip")
    result = simulator(_slider(law), {"b": 4.0, "L": 2.0, "c": 0.5}).run(
        TIMES, inputs={"P": Sine(5.0, 0.9, 0.3)}
    )
    assert result["s"] == pytest.approx(_dead_zone(result["P"], 2.0) / 5, abs=1e-9)


def test_events_of_a_plate_without_mass_are_where_the_force_passes_the_level() -> None:
    result = simulator(_slider(), {"b": 4.0, "L": 2.0}).run(TIMES, inputs={"P": Sine(5.0, 0.5)})
    up = np.arcsin(0.4) / np.pi
    expected = [(up, "slip"), (1 - up, "stick"), (1 + up, "slip"), (2 - up, "stick"), (2 + up, "slip"),
                (3 - up, "stick")]  # fmt: skip
    assert [e.kind for e in result.events] == [kind for _, kind in expected]
    assert [e.time for e in result.events] == pytest.approx([t for t, _ in expected], abs=1e-9)


def test_a_plate_without_mass_follows_a_force_that_steps() -> None:
    drive = Step(0.5, 3.0) + Step(1.0, -7.0) + Step(1.5, 3.5) + Step(2.0, 4.5)
    result = simulator(_slider(), {"b": 4.0, "L": 2.0}).run(TIMES, inputs={"P": drive})
    assert result["s"] == pytest.approx(_dead_zone(result["P"], 2.0) / 4, abs=1e-12)
    assert [(e.time, e.kind) for e in result.events] == [
        (0.5, "slip"), (1.0, "cross"), (1.5, "stick"), (2.0, "slip"),
    ]  # fmt: skip


def test_breakaway_leaves_a_plate_without_mass_with_hysteresis() -> None:
    """Held to 1.5 L on the way up; once sliding it follows (P - L)/b down to P = L."""
    law = bg.DryFriction("L", 1, 1.5)
    drive = Sampled([0.0, 1.5, 3.0], [0.0, 4.5, 0.0])
    result = simulator(_slider(law), {"b": 4.0, "L": 2.0}).run(TIMES, inputs={"P": drive})
    assert [e.kind for e in result.events] == ["slip", "stick"]
    assert [e.time for e in result.events] == pytest.approx([1.0, 3 - 2 / 3], abs=1e-9)
    P, sliding = result["P"], (TIMES >= 1.0) & (TIMES <= 3 - 2 / 3)
    clear = np.abs(TIMES - 1.0) > 1e-9
    expected = np.where(sliding, (P - 2.0) / 4, 0.0)
    assert result["s"][clear] == pytest.approx(expected[clear], abs=1e-9)


def _slip_damper(*more: tuple, ratio: object = 1) -> bg.StateEquations:
    """A mass held through a damper b and friction in series: f = b (v - s)."""
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.Zero("arm"),
             bg.R("damper", "b"), bg.R("rub", law=bg.DryFriction("L", 1, ratio), effort="f", flow="s"),
             *more]  # fmt: skip
    extra = " ".join(f"mass>{name}" for name, _ in more)
    return bg.derive(bond_graph(nodes, f"push>mass>m mass>arm arm>damper arm>rub {extra}"))


def _tight(rate, start, breaks=()) -> np.ndarray:
    edges, y, rows = [0.0, *breaks, 3.0], np.array(start, dtype=float), []
    for a, b in pairwise(edges):
        inside = TIMES[(a <= TIMES) & (b > TIMES)]
        found = solve_ivp(rate, (a, b), y, "DOP853", rtol=1e-11, atol=1e-13, max_step=2e-3,
                          dense_output=True)  # fmt: skip
        rows.append(found.sol(inside))
        y = found.y[:, -1]
    return np.column_stack([*rows, y])


def test_friction_behind_a_damper_is_a_damper_that_saturates() -> None:
    """f = clip(b v, -L, L): piecewise linear and continuous, so a fine adaptive integration does it."""
    values = {"m": 0.5, "b": 6.0, "L": 2.0}
    spring = bg.C("spring", "1/k", effort="F")
    result = simulator(_slip_damper(spring), values | {"k": 30.0}).run(
        TIMES, {"v": 1.0}, {"P": Sine(4.0, 1.1)}
    )

    def rate(t: float, y: np.ndarray) -> list[float]:
        push = 4 * np.sin(2 * np.pi * 1.1 * t) - y[1] - np.clip(6.0 * y[0], -2.0, 2.0)
        return [push / 0.5, 30.0 * y[0]]

    v, F = _tight(rate, [1.0, 0.0])
    assert result["v"] == pytest.approx(v, abs=1e-7)
    assert result["F"] == pytest.approx(F, abs=1e-6)
    assert result["f"] == pytest.approx(np.clip(6.0 * v, -2.0, 2.0), abs=1e-6)
    assert result["s"] == pytest.approx(v - result["f"] / 6.0, abs=1e-7)
    assert {event.kind for event in result.events} == {"stick", "slip"}


NEEDS_CC = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")


@pytest.mark.parametrize(
    ("backend", "method"),
    [("numpy", "DOP853"), ("numpy", "exact"), pytest.param("c", "exact", marks=NEEDS_CC)],
)
def test_friction_behind_a_damper_breaks_away_and_is_caught_at_its_level(
    backend: str, method: str
) -> None:
    """b v rises to 1.5 L at t_1, slides with f = L until b v has come back to L."""
    m, b, L, P = 2.0, 4.0, 2.0, 6.0
    drive = Step(1.0, -P, P)
    ready = simulator(_slip_damper(ratio=1.5), {"m": m, "b": b, "L": L}, backend=backend)
    result = ready.run(TIMES, inputs={"P": drive}, method=method)
    # m v' = P - b v to v = 3 L/(2 b); m v' = P - L until 1.0; m v' = -P - L down to v = L/b; ...
    t_1 = -m / b * np.log(1 - 1.5 * L / P)
    peak = 1.5 * L / b + (P - L) / m * (1 - t_1)
    t_2 = 1.0 + (peak - L / b) * m / (P + L)
    # ... then m v' = -P - b v from L/b to -3 L/(2 b), sliding again from there.
    t_3 = t_2 + m / b * np.log((L + P) / (P - 1.5 * L))
    assert [e.kind for e in result.events] == ["slip", "stick", "slip"]
    assert [e.time for e in result.events] == pytest.approx([t_1, t_2, t_3], abs=1e-9)
    last = t_3 < TIMES
    expected = -1.5 * L / b - (P - L) / m * (TIMES[last] - t_3)
    assert result["v"][last] == pytest.approx(expected, abs=1e-8)


def test_friction_in_series_with_a_spring_is_an_elastic_slider() -> None:
    """Jenkin's element: the spring's force F' = k (V - s), held within +-L without any mass."""
    nodes = [bg.Sf("drive", "V"), bg.Zero("node"), bg.C("spring", "1/k", effort="F"),
             bg.R("rub", law=bg.DryFriction("L"), effort="f", flow="s")]  # fmt: skip
    graph = bond_graph(nodes, "drive>node>spring node>rub")
    times = np.linspace(0, 1, 21)
    run = simulator(bg.derive(graph), {"k": 50.0, "L": 2.0}).run(times, {}, {"V": 0.1})
    assert run["F"] == pytest.approx(np.minimum(5 * times, 2.0), abs=1e-12)


def test_power_is_balanced_beside_resistances() -> None:
    run = simulator(
        _slip_damper(bg.C("spring", "1/k", effort="F")), {"m": 0.5, "b": 6.0, "L": 2.0, "k": 30.0}
    )
    departure = misfit(
        lambda times: run.run(times, {"v": 1.0}, {"P": Sine(4.0, 1.1) + Step(1.0, 3.0)}),
        [0.0, 1.0, 3.0],
        lambda r: 0.25 * r["v"] ** 2 + r["F"] ** 2 / 60,
        lambda r: r["P"] * r["v"] - r["f"] * r["s"] - (r["v"] - r["s"]) * r["f"],
    )
    assert departure < 1e-9


def test_a_law_that_reads_friction_is_solved_with_it() -> None:
    """A heater, say, that brakes with a tenth of the friction's effort: m v' = P - 1.1 f."""
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"),
             bg.R("rub", law=bg.DryFriction("L"), effort="f", flow="s"),
             bg.R("more", law="f/10")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>mass>m mass>rub mass>more"))
    drive = Step(1.0, -0.8, 4.2)
    result = simulator(equations, {"m": 2.0, "L": 3.0}).run(TIMES, inputs={"P": drive})
    # 4.2 against 3.3, then -0.8 - 3.3 until rest at 1 + 0.45/2.05, then held: f = -0.8/1.1.
    stop = 1.0 + 0.45 / 2.05
    assert [(e.time, e.kind) for e in result.events] == [(pytest.approx(stop, abs=1e-9), "stick")]
    assert result["v"] == pytest.approx(np.interp(TIMES, [0, 1, stop], [0, 0.45, 0]), abs=1e-9)
    assert result["f"][-1] == pytest.approx(-0.8 / 1.1, abs=1e-8)


def test_a_port_behind_a_damper_and_one_on_the_ground_stick_each_in_its_way() -> None:
    """One hold follows from D at once, the other rules the state: m v' = P - L_1 sign(v) - clip(b v, L_2)."""
    nodes = [bg.R("ground", law=bg.DryFriction(1.5), effort="f_1", flow="s_1")]
    m, b, L_1, L_2, P = 2.0, 4.0, 1.5, 2.0, 6.0
    run = simulator(_slip_damper(*nodes), {"m": m, "b": b, "L": L_2})
    result = run.run(TIMES, inputs={"P": Step(1.0, 0.0, P)})
    tau, fast = m / b, L_2 / b
    t_1 = -tau * np.log(1 - fast * b / (P - L_1))
    peak = fast + (P - L_1 - L_2) / m * (1 - t_1)
    t_2 = 1 + (peak - fast) * m / (L_1 + L_2)
    t_3 = t_2 + tau * np.log((fast + L_1 / b) / (L_1 / b))
    assert [(e.port, e.kind) for e in result.events] == [
        ("rub", "slip"), ("rub", "stick"), ("ground", "stick"),
    ]  # fmt: skip
    assert [e.time for e in result.events] == pytest.approx([t_1, t_2, t_3], abs=1e-9)
    rise = (P - L_1) / b * (1 - np.exp(-TIMES / tau))
    fall = (fast + L_1 / b) * np.exp(-(TIMES - t_2) / tau) - L_1 / b
    ends = [t_1 > TIMES, t_2 > TIMES, t_3 > TIMES]
    middle = np.interp(TIMES, [t_1, 1, t_2], [fast, peak, fast])
    assert result["v"] == pytest.approx(np.select(ends, [rise, middle, fall], 0.0), abs=1e-9)
    assert np.abs(result["v"][t_3 < TIMES]).max() < 1e-12

"""Known sources of time, and inputs that drive dependent storages: jumps, rates, impulses."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Lag, Ramp, Sampled, Sine, Step, simulator

TIMES = np.linspace(0.0, 2.0, 81)
C_1, C_2, R = 0.3, 0.2, 1.4
TAU = R * (C_1 + C_2)
NUMBERS = {"C_1": C_1, "C_2": C_2, "R": R}


def _divider_graph(value: object = "V", first: str = "lower") -> nx.DiGraph:
    """A source on two capacitances in series, one with a resistance beside it: V = v_1 + v_2.

    (C_1 + C_2) v_2' = C_1 V' - v_2/R.
    """
    priority = {"lower": 1.0} if first == "lower" else {"upper": 1.0}
    nodes = [bg.Se("s", value), bg.One("n"), bg.Zero("z"), bg.R("r", "R"),
             bg.C("upper", "C_1", effort="v_1", priority=priority.get("upper", 0)),
             bg.C("lower", "C_2", effort="v_2", priority=priority.get("lower", 0))]  # fmt: skip
    return bond_graph(nodes, "s>n>upper n>z>lower z>r")


def _divider(value: object = "V", first: str = "lower") -> bg.StateEquations:
    return bg.derive(_divider_graph(value, first), outputs=["z"])


def _jump_and_decay(at: float, height: float) -> np.ndarray:
    after = np.maximum(TIMES - at, 0.0)
    return np.where(at <= TIMES, height * C_1 / (C_1 + C_2) * np.exp(-after / TAU), 0.0)


def _lower_voltage(result, first: str) -> np.ndarray:
    return result["v_2"] if first == "lower" else result["V"] - result["v_1"]


@pytest.mark.parametrize("first", ["lower", "upper"])
def test_a_step_makes_a_dependent_storage_jump_by_its_share(first: str) -> None:
    """Whichever capacitance is the state; at the step a sample shows the instant just after."""
    equations = _divider(first=first)
    assert equations.E.todok()
    start = {"v_2": 0.0} if first == "lower" else {"v_1": 0.0}
    result = simulator(equations, NUMBERS).run(
        TIMES, start, {"V": Step(0.5, 10.0) + Step(1.2, -4.0)}
    )
    expected = _jump_and_decay(0.5, 10.0) + _jump_and_decay(1.2, -4.0)
    assert _lower_voltage(result, first) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("first", ["lower", "upper"])
def test_the_initial_state_is_that_just_after_a_step_at_the_start(first: str) -> None:
    run = simulator(_divider(first=first), NUMBERS)
    start = {"v_2": 3.0} if first == "lower" else {"v_1": 7.0}
    result = run.run(TIMES, start, {"V": Step(0.0, 10.0)})
    assert _lower_voltage(result, first) == pytest.approx(3.0 * np.exp(-TIMES / TAU), abs=1e-9)


def test_a_ramp_drives_by_its_slope() -> None:
    result = simulator(_divider(), NUMBERS).run(TIMES, inputs={"V": Ramp(0.5, 4.0)})
    after = np.maximum(TIMES - 0.5, 0.0)
    assert result["v_2"] == pytest.approx(R * C_1 * 4.0 * (1 - np.exp(-after / TAU)), abs=1e-9)


def test_the_current_into_a_divider_depends_on_the_rate_of_its_state() -> None:
    """i = C_1 (V' - v_2'), an output of x'; after the corner v_2' = a C_1/(C_1 + C_2) exp(-t/tau)."""
    equations = bg.derive(_divider_graph(), outputs=["s"])
    result = simulator(equations, NUMBERS).run(TIMES, inputs={"V": Ramp(0.5, 4.0)})
    after = np.maximum(TIMES - 0.5, 0.0)
    rate = 4.0 * C_1 / (C_1 + C_2) * np.exp(-after / TAU)
    expected = np.where(TIMES >= 0.5, C_1 * (4.0 - rate), 0.0)
    assert result["f_s"] == pytest.approx(expected, abs=1e-9)


def _sine_response(w: float, V: float) -> np.ndarray:
    """v_2' + v_2/tau = a w cos(w t), from v_2 = 0."""
    a = V * C_1 / (C_1 + C_2)
    gain = 1j * w / (1j * w + 1 / TAU)
    steady = (a * gain * -1j * np.exp(1j * w * TIMES)).real
    return steady - steady[0] * np.exp(-TIMES / TAU)


def test_a_sine_drives_by_its_rate() -> None:
    result = simulator(_divider(), NUMBERS).run(TIMES, inputs={"V": Sine(5.0, 0.8)})
    assert result["v_2"] == pytest.approx(_sine_response(2 * np.pi * 0.8, 5.0), abs=1e-8)


@pytest.mark.parametrize("value", ["V_0*sin(w*t)", "V_0*u"])
def test_a_known_source_drives_by_the_rate_of_its_law(value: str) -> None:
    """Its law may hold the time, or an input whose rate then counts."""
    w = 2 * np.pi * 0.8
    run = simulator(_divider(value), NUMBERS | {"V_0": 5.0, "w": w})
    inputs = {"u": Sine(1.0, 0.8)} if "u" in run.inputs else {}
    result = run.run(TIMES, inputs=inputs)
    assert result["v_2"] == pytest.approx(_sine_response(w, 5.0), abs=1e-8)
    assert result["e_s"] == pytest.approx(5 * np.sin(w * TIMES), abs=1e-12)


def test_an_input_of_a_known_source_may_step_through_a_dependent_storage() -> None:
    run = simulator(_divider("2*u"), NUMBERS)
    result = run.run(TIMES, inputs={"u": Step(0.5, 5.0)})
    assert result["v_2"] == pytest.approx(_jump_and_decay(0.5, 10.0), abs=1e-9)


def test_a_flow_source_makes_an_inertia_jump() -> None:
    """The dual: (L_1 + L_2) i_2' = L_1 i' - R i_2."""
    nodes = [bg.Sf("s", "i"), bg.Zero("z"), bg.I("l1", "L_1"), bg.One("n"),
             bg.I("l2", "L_2", flow="i_2", priority=1), bg.R("r", "R")]  # fmt: skip
    run = simulator(
        bg.derive(bond_graph(nodes, "s>z>l1 z>n>l2 n>r")), {"L_1": 0.3, "L_2": 0.2, "R": 0.7}
    )
    result = run.run(TIMES, inputs={"i": Step(0.5, 10.0)})
    after = np.maximum(TIMES - 0.5, 0.0)
    expected = np.where(TIMES >= 0.5, 6.0 * np.exp(-after * 0.7 / 0.5), 0.0)
    assert result["i_2"] == pytest.approx(expected, abs=1e-9)


def test_known_force_as_a_function_of_time() -> None:
    """m v' = P_0 exp(-t) t: v = P_0/m (1 - (1 + t) exp(-t))."""
    nodes = [bg.Se("s", "P_0*t*exp(-t)"), bg.One("n"), bg.I("m", "m", flow="v")]
    run = simulator(bg.derive(bond_graph(nodes, "s>n>m")), {"P_0": 6.0, "m": 2.0})
    assert run.inputs == ()
    result = run.run(TIMES)
    assert result["v"] == pytest.approx(3 * (1 - (1 + TIMES) * np.exp(-TIMES)), abs=1e-10)


def _charged(value: object = "V") -> bg.StateEquations:
    """A source right on a capacitance and a resistance: its current is C V' + V/R."""
    nodes = [bg.Se("s", value), bg.Zero("z"), bg.C("c", "C_1"), bg.R("r", "R")]
    return bg.derive(bond_graph(nodes, "s>z>c z>r"), outputs=["s"])


@pytest.mark.parametrize(("value", "gain", "slope"), [("V", 1, 0), ("3*V + 4*t", 3, 4)])
def test_an_output_may_show_the_rate_of_a_smooth_input(
    value: str, gain: float, slope: float
) -> None:
    run = simulator(_charged(value), {"C_1": C_1, "R": R})
    result = run.run(TIMES, inputs={"V": Lag(Step(0.5, 10.0), 0.2)})
    decay = np.where(TIMES >= 0.5, np.exp(-np.maximum(TIMES - 0.5, 0) / 0.2), 0.0)
    V = np.where(TIMES >= 0.5, 10 * (1 - decay), 0.0)
    expected = C_1 * (gain * 10 / 0.2 * decay + slope) + (gain * V + slope * TIMES) / R
    assert result["f_s"] == pytest.approx(expected, abs=1e-9)


def test_corners_are_no_impulses() -> None:
    run = simulator(_charged(), {"C_1": C_1, "R": R})
    result = run.run(TIMES, inputs={"V": Sampled([0.0, 1.0, 2.0], [0.0, 3.0, 1.0])})
    assert result["f_s"][20] == pytest.approx(C_1 * 3 + 1.5 / R, rel=1e-12)
    assert result["f_s"][60] == pytest.approx(C_1 * -2 + 2.0 / R, rel=1e-12)


MESSAGE = r"input 'V' steps at t = 0\.5.* would be an impulse; smooth it"


@pytest.mark.parametrize("value", ["V", "2*V", "V + sin(t)"])
def test_a_step_of_an_input_whose_rate_is_shown_is_refused(value: str) -> None:
    run = simulator(_charged(value), {"C_1": C_1, "R": R})
    with pytest.raises(bg.SimulationError, match=MESSAGE):
        run.run(TIMES, inputs={"V": Step(0.5, 10.0)})
    with pytest.raises(bg.SimulationError, match=MESSAGE):
        run.run(TIMES, inputs={"V": Lag(Step(0.2, 1.0), 0.1) + Step(0.5, 10.0)})


@pytest.mark.parametrize(
    "signal", [Step(0.0, 10.0), Step(-1.0, 10.0), Step(2.5, 10.0), Step(1.0, 0.0)]
)
def test_steps_outside_the_run_or_of_no_height_are_none(signal: Step) -> None:
    run = simulator(_charged(), {"C_1": C_1, "R": R})
    result = run.run(TIMES, inputs={"V": signal})
    assert result["f_s"] == pytest.approx(np.array([signal(t) for t in TIMES]) / R, rel=1e-12)

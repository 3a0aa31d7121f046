"""Linear circuits and mechanics against closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from oracles.models import series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Lag, Ramp, Sampled, Sine, Step, simulator

CIRCUIT = bg.derive(series_circuit(), outputs=["resistor", "source"])
L, C = 0.5, 0.02
CRITICAL = 2 * np.sqrt(L / C)
TIMES = np.linspace(0.0, 1.5, 61)


def _step_response(R: float, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Voltage at the plates and current after a unit step, for any damping, by complex roots."""
    t = np.maximum(t, 0.0)
    half = R / (2 * L)
    if R == CRITICAL:
        return 1 - np.exp(-half * t) * (1 + half * t), C * half**2 * t * np.exp(-half * t)
    w = np.sqrt(complex(1 / (L * C) - half**2))
    v = 1 - np.exp(-half * t) * (np.cos(w * t) + half / w * np.sin(w * t))
    i = np.exp(-half * t) * np.sin(w * t) / (w * L)
    return v.real, i.real


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("R", [0.5, 2.0, CRITICAL, 40.0])
@pytest.mark.parametrize("method", ["auto", "DOP853", "Radau"])
def test_step_response_of_a_series_circuit(R: float, method: str) -> None:
    run = simulator(CIRCUIT, {"R": R, "L": L, "C": C})
    result = run.run(TIMES, inputs={"V": Step(0.2, 12.0)}, method=method)
    v, i = _step_response(R, TIMES - 0.2)
    assert result["v"] == pytest.approx(12 * v, abs=2e-8)
    assert result["i"] == pytest.approx(12 * i, abs=2e-8)
    assert result["V"] == pytest.approx(np.where(TIMES >= 0.2, 12.0, 0.0), abs=0)


def test_outputs_follow_from_states_and_inputs() -> None:
    run = simulator(CIRCUIT, {"R": 2.0, "L": L, "C": C})
    result = run.run(TIMES, {"i": 0.3, "v": -1.0}, {"V": 5.0})
    assert run.outputs == tuple(str(name) for name in CIRCUIT.outputs)
    assert result[run.outputs[0]] == pytest.approx(result["i"], rel=1e-14)
    assert result[run.outputs[1]] == pytest.approx(result["i"], rel=1e-14)


def test_free_decay_from_an_initial_state() -> None:
    """The plates start charged; the state left out starts at zero."""
    run = simulator(CIRCUIT, {"R": 2.0, "L": L, "C": C})
    result = run.run(TIMES, {"v": 3.0}, {"V": Constant(0)})
    v, i = _step_response(2.0, TIMES)
    assert result["v"] == pytest.approx(3 - 3 * v, abs=1e-8)
    assert result["i"] == pytest.approx(-3 * i, abs=1e-8)


def test_two_steps_add_up() -> None:
    run = simulator(CIRCUIT, {"R": 2.0, "L": L, "C": C})
    result = run.run(TIMES, inputs={"V": Step(0.1, 4.0) + Step(0.7, -9.0)})
    one, other = (_step_response(2.0, TIMES - at)[0] for at in (0.1, 0.7))
    assert result["v"] == pytest.approx(4 * one - 9 * other, abs=1e-8)


def _mass_spring_damper() -> bg.StateEquations:
    nodes = [bg.Se("force", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("d", "b"),
             bg.C("s", "1/k", effort="F")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "force>n>m n>d n>s"))


@pytest.mark.parametrize("frequency", [0.5, 1.0, 3.0])
def test_forced_vibration(frequency: float) -> None:
    """x = Re(X exp(i w t)) + decay, X = -i P/(k - m w^2 + i w b); F = k x."""
    m, k, b, P = 2.0, 80.0, 1.5, 10.0
    w = 2 * np.pi * frequency
    X = -1j * P / (k - m * w**2 + 1j * w * b)
    x, v = (X * np.exp(1j * w * TIMES)).real, (1j * w * X * np.exp(1j * w * TIMES)).real
    d, w_d = b / (2 * m), np.sqrt(k / m - (b / (2 * m)) ** 2)
    x_0, v_0 = -x[0], -v[0]
    s = (v_0 + d * x_0) / w_d
    x += np.exp(-d * TIMES) * (x_0 * np.cos(w_d * TIMES) + s * np.sin(w_d * TIMES))
    run = simulator(_mass_spring_damper(), {"m": m, "k": k, "b": b})
    result = run.run(TIMES, inputs={"P": Sine(P, frequency)})
    assert result["F"] == pytest.approx(k * x, abs=1e-7)


DRIVES = [Ramp(0.2, 5.0, end=0.9), Lag(Step(0.3, 2.0), 0.1), Lag(Lag(Step(0.3, 2.0), 0.1), 0.1),
          Sampled([0.1, 0.4, 0.45, 1.0], [0.0, 3.0, -3.0, 1.0])]  # fmt: skip


@pytest.mark.parametrize("drive", DRIVES, ids=str)
def test_a_mass_alone_integrates_its_force(drive) -> None:
    """Gauss-Legendre between breakpoints: exact to rounding for these forces."""
    nodes = [bg.Se("force", "P"), bg.One("n"), bg.I("m", 2.0, flow="v")]
    result = simulator(bg.derive(bond_graph(nodes, "force>n>m")), {}).run(
        TIMES, inputs={"P": drive}
    )
    points, weights = np.polynomial.legendre.leggauss(20)
    edges = np.unique([*TIMES, *drive.breakpoints])
    momentum, expected = 0.0, {0.0: 0.0}
    for a, b in pairwise(edges):
        middle, half = (a + b) / 2, (b - a) / 2
        momentum += half * sum(
            w * drive(middle + half * p) for p, w in zip(points, weights, strict=True)
        )
        expected[float(b)] = momentum / 2
    assert result["v"] == pytest.approx([expected[t] for t in TIMES.tolist()], abs=1e-10)


def test_a_model_without_states_shows_its_outputs() -> None:
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r1", 2.0), bg.R("r2", 3.0)]
    equations = bg.derive(bond_graph(nodes, "s>n>r1 n>r2"), outputs=["s"])
    result = simulator(equations, {}).run(TIMES, inputs={"V": Ramp(0.5, 10.0)})
    assert result["f_s"] == pytest.approx(2.0 * np.maximum(TIMES - 0.5, 0.0), rel=1e-13)


def test_stiff_circuits_take_the_implicit_method_and_stay_exact() -> None:
    """Time constants a million apart; without an inductance worth the name v follows R C."""
    run = simulator(CIRCUIT, {"R": 1.0, "L": 1e-6, "C": 1.0})
    result = run.run(np.linspace(0, 5, 11), inputs={"V": Step(0.5, 1.0)})
    slow = -0.5 * (1e6 - np.sqrt(1e12 - 4e6))
    fast = 1e6 / slow
    t = np.maximum(result.time - 0.5, 0.0)
    v = 1 - (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)
    assert result["v"] == pytest.approx(v, abs=1e-7)


def test_between_the_steps_of_an_explicit_method_samples_keep_the_tolerance() -> None:
    """A pole of 3750/s under a slow input: at the stability limit an interpolant would be noise.

    i = Re(-j X exp(j w t)) less what decays, X = (j w - A)^-1 B.
    """
    A, w = np.array([[-3750.0, -1.0], [100.0, 0.0]]), 2 * np.pi
    X = -1j * np.linalg.solve(1j * w * np.eye(2) - A, [1.0, 0.0])
    rates, modes = np.linalg.eig(A)
    parts = np.linalg.solve(modes, X.real)
    times = np.linspace(0.0, 1.0, 1001)
    steady = np.outer(np.exp(1j * w * times), X).real
    expected = steady - (np.exp(np.outer(times, rates)) * parts) @ modes.T
    run = simulator(CIRCUIT, {"R": 3750.0, "L": 1.0, "C": 0.01})
    result = run.run(times, inputs={"V": Sine(1.0, 1.0)}, method="DOP853")
    assert result["i"] == pytest.approx(expected[:, 0], abs=3e-11)
    assert result["v"] == pytest.approx(expected[:, 1], abs=1e-9)

"""Lags against closed forms and against adaptive integration, resonant chains among them."""

import mpmath
import numpy as np
import pytest
from oracles.lags import lagged

from codegen import Constant, Lag, Ramp, Sampled, Signal, Sine, Step

T = 0.04
AFTER = np.linspace(0.0, 0.6, 25)


def _values(signal: Signal, times: np.ndarray) -> np.ndarray:
    return np.array([signal(t) for t in times.tolist()])


def test_lag_of_a_step() -> None:
    expected = 1.5 + 2.0 * (1 - np.exp(-AFTER / T))
    assert _values(Lag(Step(0.1, 3.5, 1.5), T), AFTER + 0.1) == pytest.approx(expected, rel=1e-13)
    assert Lag(Step(0.1, 3.5, 1.5), T)(-7.0) == 1.5


def test_lag_of_a_constant_is_the_constant() -> None:
    assert Lag(Constant(2.5), T)(0.3) == 2.5


def test_lag_of_a_ramp_trails_by_the_time_constant() -> None:
    expected = 3.0 * (AFTER - T * (1 - np.exp(-AFTER / T)))
    assert _values(Lag(Ramp(0.1, 3.0), T), AFTER + 0.1) == pytest.approx(expected, abs=1e-13)


def test_lag_of_a_sine_is_its_steady_state() -> None:
    w = 2 * np.pi * 5.0
    expected = 0.3 + 2 / np.hypot(1, w * T) * np.sin(w * AFTER + 0.4 - np.arctan(w * T))
    lag = Lag(Sine(2.0, 5.0, 0.4, 0.3), T)
    assert lag.breakpoints == ()
    assert _values(lag, AFTER) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("order", [2, 3, 6])
def test_chain_of_equal_lags_answers_a_step_with_powers_of_time(order: int) -> None:
    """Every lag but the first is driven at its own rate: y = 1 - exp(-s) sum_k s^k/k!, s = t/T."""
    chain: Signal = Step(0.0, 1.0)
    for _ in range(order):
        chain = Lag(chain, T)
    s = AFTER / T
    series = sum(s**k / mpmath.factorial(k) for k in range(order))
    expected = [float(1 - mpmath.exp(-at) * part) for at, part in zip(s, series, strict=True)]
    assert _values(chain, AFTER) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("apart", [1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-11, 1e-13, 1e-15])
def test_lags_of_nearly_the_same_time_constant(apart: float) -> None:
    """y = 1 - (T_1 exp(-t/T_1) - T_2 exp(-t/T_2))/(T_1 - T_2), in 60 digits."""
    with mpmath.workdps(60):
        one, other = mpmath.mpf(T), mpmath.mpf(T * (1 + apart))
        expected = [
            float(1 - (one * mpmath.exp(-t / one) - other * mpmath.exp(-t / other)) / (one - other))
            for t in map(mpmath.mpf, AFTER.tolist())
        ]
    chain = Lag(Lag(Step(0.0, 1.0), T), T * (1 + apart))
    assert _values(chain, AFTER) == pytest.approx(expected, abs=1e-10)


DRIVEN = [
    Ramp(0.1, 3.0, 1.0, 0.35),
    Sampled([0.0, 0.1, 0.25, 0.4], [1.0, -2.0, 3.0, 3.0]),
    Step(0.1, 1.0) + Step(0.3, -2.5) + Ramp(0.2, 4.0, end=0.45),
    Step(0.1, 1.0, 0.5) + Ramp(0.3, -2.0),
]


@pytest.mark.parametrize("driven", DRIVEN, ids=str)
@pytest.mark.parametrize("constants", [(0.04,), (0.04, 0.04), (0.1, 0.02), (0.03, 0.05, 0.03)])
def test_lags_agree_with_adaptive_integration(driven: Signal, constants: tuple[float, ...]) -> None:
    chain = driven
    for constant in constants:
        chain = Lag(chain, constant)
    times = np.linspace(-0.05, 0.8, 70)
    before = driven(-0.05)
    expected = lagged(driven, driven.breakpoints, constants, [before] * len(constants), times)
    assert chain(-0.05) == before
    assert _values(chain, times) == pytest.approx(expected, abs=1e-11)


def test_lag_of_a_sine_that_is_switched_on_starts_from_the_steady_state_before() -> None:
    """The part that decays is what the sine's own steady state lacks at the switch."""
    driven = Step(0.1, 1.0) + Sine(2.0, 3.0)
    w = 2 * np.pi * 3.0
    steady = 2 / np.hypot(1, w * T) * np.sin(w * (AFTER + 0.1) - np.arctan(w * T))
    expected = steady + 1 - np.exp(-AFTER / T)
    assert _values(Lag(driven, T), AFTER + 0.1) == pytest.approx(expected, abs=1e-13)


def test_a_lag_is_continuous_where_its_signal_steps() -> None:
    lag = Lag(Step(0.1, 5.0) + Step(0.2, -9.0), T)
    for one, other, at in zip(lag.pieces, lag.pieces[1:], lag.breakpoints, strict=False):
        assert one(at) == pytest.approx(other(at), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize("constant", [1e-9, 1e-300, 1e9])
def test_extreme_time_constants(constant: float) -> None:
    lag = Lag(Step(0.1, 5.0), constant)
    assert lag(0.1) == pytest.approx(0.0, abs=1e-12)
    assert lag(10.1) == pytest.approx(5.0 * -np.expm1(-10.0 / constant), rel=1e-6)
    assert np.isfinite(lag.pieces[1].derivative(0.2))

"""Runs of the passive variants against eqs. (6) to (10), typed in and integrated tightly."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import differentials
from codegen import Result

i, I_i, I_w, k, k_is, b_is = 2.8, 0.1604, 0.808, 8600.0, 20_000.0, 10.0
STARTS = np.array([80.0, 80.5])
#: k_t r^2/v with v = r omega_0, per wheel.
TIRES = 2e5 * 0.3 / STARTS


def lagged(t: float, step: float, level: float) -> float:
    return level * (1 - np.exp(-(t - step) / 0.04)) if t > step else 0.0


def tire_torques(speeds: np.ndarray) -> np.ndarray:
    return TIRES * (speeds - STARTS)


def tight(rhs: Callable, start: list[float], begin: float, end: float) -> Callable:
    run = solve_ivp(
        rhs, (begin, end), start, method="DOP853", rtol=1e-12, atol=1e-12, max_step=1e-3,
        dense_output=True,
    )  # fmt: skip
    return run.sol


def over_steps(rhs: Callable, start: list[float], stops: list[float]) -> np.ndarray:
    """The states every millisecond, each smooth stretch integrated on its own."""
    times, values = np.linspace(0, 1, 1001), []
    for begin, end in zip([0.0, *stops], [*stops, 1.0], strict=True):
        sol = tight(rhs, start, begin, end)
        inside = times[(times >= begin) & ((times < end) | (end == 1.0))]
        values.append(sol(inside))
        start = sol(end)
    return np.hstack(values)


def agree(run: Result, names: list[str], expected: np.ndarray) -> None:
    for name, values in zip(names, expected, strict=True):
        assert abs(run[name] - values).max() < 1e-9 * np.ptp(values), name


def test_the_compliant_input_shaft_follows_eq_9() -> None:
    def rhs(t: float, x: np.ndarray) -> list[float]:
        omega_e, *speeds, tau = x
        slip = omega_e - i * sum(speeds) / 2
        shaft = tau + b_is * slip
        wheels = (i * shaft / 2 - tire_torques(np.array(speeds))) / I_w
        return [(lagged(t, 0.1, 350.0) - shaft) / I_i, *wheels, k_is * slip]

    expected = over_steps(rhs, [i * STARTS.mean(), *STARTS, 0.0], [0.1])
    run = differentials.simulate("passive_input_shaft", "engine_step")
    agree(run, ["omega_e", "omega_1", "omega_2", "tau_kis"], expected)


def test_the_halfshafts_in_series_follow_eq_10() -> None:
    k_e = k * k / (k + k)

    def rhs(t: float, x: np.ndarray) -> list[float]:
        omega_e, tau, *speeds = x
        wheels = (tau - tire_torques(np.array(speeds))) / I_w
        twist = k_e * (2 * omega_e / i - sum(speeds))
        return [(lagged(t, 0.1, 350.0) - 2 * tau / i) / I_i, twist, *wheels]

    expected = over_steps(rhs, [i * STARTS.mean(), 0.0, *STARTS], [0.1])
    run = differentials.simulate("passive_halfshafts", "engine_step")
    agree(run, ["omega_e", "tau_k1", "omega_t1", "omega_t2"], expected)
    assert run["tau_hs2"] == pytest.approx(run["tau_hs1"], abs=1e-6)


def test_the_input_clutch_slips_by_eq_7_and_holds_by_eq_8() -> None:
    """It opens with the first engine torque, closes at 0.1 s and locks."""

    def slipping(t: float, x: np.ndarray) -> list[float]:
        torque = lagged(t, 0.1, 300.0)
        wheels = (i * torque / 2 - tire_torques(x[1:])) / I_w
        return [(lagged(t, 0.02, 50.0) - torque) / I_i, *wheels]

    case = differentials.scenarios["input_clutch"]
    soon = replace(case, engine_step=0.02, clutch_step=0.1, duration=0.4)
    run = differentials.simulate("passive_input_clutch", soon)
    assert [event.kind for event in run.events] == ["slip", "stick"]
    release, lock = (event.time for event in run.events)
    assert release == pytest.approx(0.02, abs=1e-12)
    open_ = tight(slipping, [i * STARTS.mean(), *STARTS], 0.02, 0.1)
    closing = tight(slipping, open_(0.1), 0.1, 0.2)
    slips = closing(lock)[0] - i * closing(lock)[1:].mean()
    acceleration = abs(slipping(lock, closing(lock))[0])
    assert abs(slips) < 1e-6 * acceleration
    during = (run.time > 0.1) & (run.time < lock)
    agree_names = ["omega_e", "omega_1", "omega_2"]
    for name, values in zip(agree_names, closing(run.time[during]), strict=True):
        assert abs(run[name][during] - values).max() < 1e-9 * np.ptp(values), name
    held = run.time > lock
    tires = np.array([run["tau_t1"][held], run["tau_t2"][held]]).sum(axis=0)
    share = i * I_i / (2 * I_w)
    torque = (run["tau_e"][held] + share * tires) / (1 + i * share)
    assert run["tau_f"][held] == pytest.approx(torque, rel=1e-9)
    assert abs(run["omega_f"][held]).max() < 1e-9
    audit = run.audit()
    assert abs(audit.residual) < 1e-9 * audit.turned_over

"""What the text says about Figs. 11 to 14, found in the simulated signals."""

from functools import cache

import numpy as np
import pytest
from references.spectra import oscillations

import differentials
from codegen import Result


@cache
def run(name: str, scenario: str) -> Result:
    return differentials.simulate(name, scenario)


def frequency(result: Result, values: np.ndarray, begin: float, end: float) -> float:
    """The largest oscillation [Hz] between two times."""
    window = (result.time >= begin) & (result.time <= end)
    return oscillations(values[window], 1e-3)[0][0]


def difference(result: Result) -> np.ndarray:
    return result["tau_hs1"] - result["tau_hs2"]


def arrival(result: Result, fraction: float) -> float:
    """When the torque difference first reaches a fraction of 1000 N m."""
    reached = np.flatnonzero(difference(result) >= fraction * 1000)
    return float(result.time[reached[0]]) if len(reached) else np.inf


def test_fig11_shows_18_6_hz_after_the_engine_step_where_the_paper_prints_18_9() -> None:
    result = run("alsd", "fig11")
    total = result["tau_hs1"] + result["tau_hs2"]
    assert frequency(result, total, 0.12, 0.49) == pytest.approx(18.6, abs=0.1)


def test_fig11_shows_165_hz_in_the_speeds_after_the_clutch_step_and_hardly_in_the_torques() -> None:
    result = run("alsd", "fig11")
    speeds = result["omega_1"] - result["omega_2"]
    assert frequency(result, speeds, 0.6, 0.9) == pytest.approx(165, abs=1.0)
    late = result.time > 0.8
    assert np.ptp(difference(result)[late]) < 0.01 * 1000
    assert np.ptp(speeds[late]) > 0.1


def test_fig11_lasts_some_70_ms_in_the_locked_window() -> None:
    stick, slip = run("alsd", "fig11").events
    assert slip.time - stick.time == pytest.approx(0.0672, abs=1e-4)


@pytest.mark.parametrize("speed", [20, 80])
def test_fig12_stiffer_shafts_are_faster(speed: int) -> None:
    runs = [run("alsd", f"fig12_{speed}_{k:g}") for k in (0.5, 1, 2, 5)]
    at = round(0.02 / 1e-3)
    values = [difference(result)[at] for result in runs]
    assert values == sorted(values)
    assert values[-1] > 3 * values[0]


def test_fig12_at_20_rad_s_half_the_stiffness_does_not_arrive_in_the_window() -> None:
    slow = run("alsd", "fig12_20_0.5")
    assert difference(slow)[-1] == pytest.approx(764, abs=1)
    assert [event.kind for event in slow.events] == ["stick"]
    assert arrival(slow, 0.9) > 0.5 > arrival(run("alsd", "fig12_20_1"), 0.9) > 0.3


def test_fig12_stiffness_changes_nothing_in_the_steady_state() -> None:
    for speed, level in ((20, 1000), (80, 374)):
        ends = [difference(run("alsd", f"fig12_{speed}_{k:g}"))[-50:].mean() for k in (2, 5)]
        assert ends == pytest.approx([level, level], abs=1.0)


def test_fig12_at_80_rad_s_the_clutch_stays_locked_and_the_torque_far_too_low() -> None:
    for k in ("0.5", "1", "2", "5"):
        result = run("alsd", f"fig12_80_{k}")
        assert [event.kind for event in result.events] == ["stick"]
        assert difference(result).max() < 400


def test_fig12_is_faster_at_80_rad_s_measured_by_where_it_ends() -> None:
    slow, fast = run("alsd", "fig12_20_1"), run("alsd", "fig12_80_1")
    assert arrival(fast, 0.63 * 0.374) < 0.6 * arrival(slow, 0.63)


def test_fig13_moves_torque_to_the_faster_wheel_at_once_and_eightfold() -> None:
    result = run("stationary_tvd", "fig13")
    assert (result["omega_t1"] > result["omega_t2"]).all()
    assert difference(result)[-90:].mean() == pytest.approx(8 * 100, rel=0.02)
    at = round(0.55 / 1e-3)
    assert difference(result)[at] > 500


def test_fig13_brakes_never_lock() -> None:
    result = run("stationary_tvd", "fig13")
    assert result.events == ()
    carriers = np.array([result["omega_f1"], result["omega_f2"]])
    assert carriers.min() > 60
    assert carriers.max() < 100


def test_fig13_shows_11_4_hz_after_the_clutch_step_and_18_2_hz_after_the_engine_step() -> None:
    result = run("stationary_tvd", "fig13")
    speeds = result["omega_1"] - result["omega_2"]
    assert frequency(result, speeds, 0.52, 1.0) == pytest.approx(11.4, abs=0.1)
    total = result["tau_hs1"] + result["tau_hs2"]
    assert frequency(result, total, 0.12, 0.49) == pytest.approx(18.2, abs=0.1)


def test_the_superposition_tvd_is_as_fast_and_rings_at_165_hz() -> None:
    one, other = run("stationary_tvd", "fig13"), run("superposition_tvd", "fig13_superposition")
    assert difference(other)[-50:].mean() == pytest.approx(1000, rel=2e-3)
    half = [result.time[np.flatnonzero(difference(result) >= level)[0]]
            for result, level in ((one, 400), (other, 500))]  # fmt: skip
    assert abs(half[0] - half[1]) < 0.015
    speeds = other["omega_1"] - other["omega_2"]
    assert frequency(other, speeds, 0.55, 0.9) == pytest.approx(165, abs=1.0)
    assert other.events == ()


def test_fig14_suns_turn_at_minus_14_4_rad_s_when_all_wheels_turn_alike() -> None:
    even = differentials.Scenario(80.0, 0.0, 0.0, (0.0, 0.0), 0.0, 0.0, 0.01)
    result = differentials.simulate("four_wheel_drive_tvd", even)
    assert result["omega_f1"] == pytest.approx(-14.4, abs=1e-9)
    assert result["omega_f2"] == pytest.approx(-14.4, abs=1e-9)


def test_fig14_drives_one_rear_wheel_and_brakes_the_front_axle_with_5_percent_more() -> None:
    result = run("four_wheel_drive_tvd", "fig14")
    front = result["tau_hs3"] + result["tau_hs4"]
    before, after = result.time < 0.5, result.time > 0.95
    before &= result.time > 0.45
    rear = result["tau_hs1"][after].mean()
    assert rear == pytest.approx((1 + 2.6) * 250, rel=0.01)
    assert result["tau_hs2"][after].mean() == pytest.approx(0, abs=5)
    assert (front[before].mean() - front[after].mean()) / rear == pytest.approx(1.05, abs=0.01)


def test_fig14_shows_the_clutch_mode_at_the_rear_and_the_shuffle_mode_in_front() -> None:
    result = run("four_wheel_drive_tvd", "fig14")
    rear = result["omega_1"] - result["omega_2"]
    assert frequency(result, rear, 0.6, 1.0) == pytest.approx(41, abs=0.5)
    front = result["tau_hs3"] + result["tau_hs4"]
    assert frequency(result, front, 0.12, 0.49) == pytest.approx(16.7, abs=0.2)

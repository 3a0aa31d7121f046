import dataclasses

import numpy as np
import pytest

import bondgraph as bg
import differentials
from differentials import Scenario

SHORT = dataclasses.replace(
    differentials.scenarios["fig11"], engine_step=0.01, clutch_step=0.02, duration=0.05
)


def test_a_start_in_steady_motion_stays_there_until_the_first_step() -> None:
    run = differentials.simulate("alsd", SHORT)
    before = run.time <= SHORT.engine_step
    for name, speed in (("omega_1", 80), ("omega_t1", 80), ("omega_2", 82), ("omega_t2", 82)):
        assert abs(run[name][before] - speed).max() < 1e-9
    assert abs(run["tau_hs1"][before]).max() < 1e-6


def test_it_is_sampled_every_millisecond() -> None:
    assert np.diff(differentials.simulate("alsd", SHORT).time) == pytest.approx(1e-3, abs=1e-12)


def test_damping_adds_to_the_halfshaft_torque() -> None:
    """tau_hs = tau_k + b (w - w_t), eq. (16)."""
    run = differentials.simulate("alsd", SHORT, {"b": 30.0})
    twist_rate = run["omega_1"] - run["omega_t1"]
    assert run["tau_hs1"] == pytest.approx(run["tau_k1"] + 30.0 * twist_rate, abs=1e-9)
    assert abs(twist_rate).max() > 0.1


def test_a_mirrored_start_gives_the_mirrored_run_of_a_symmetric_driveline() -> None:
    """Exchanging the wheels exchanges left and right where the clutch does nothing."""
    free = dataclasses.replace(SHORT, clutch_torques=(0.0,))
    mirrored = dataclasses.replace(free, wheel_speed=82.0, speed_difference=2.0)
    one, other = (differentials.simulate("alsd", case) for case in (free, mirrored))
    assert one["omega_1"] == pytest.approx(other["omega_2"], abs=1e-8)
    assert one["tau_hs2"] == pytest.approx(other["tau_hs1"], abs=1e-5)


@pytest.mark.parametrize(
    ("scenario", "parameters", "error", "message"),
    [
        ("fig99", {}, bg.SignalError, "no scenario is called 'fig99'"),
        (dataclasses.replace(SHORT, clutch_torques=()), {}, bg.SignalError, "1 clutch"),
        (dataclasses.replace(SHORT, wheel_speed=0.0), {}, bg.SignalError, "wheel 1 starts at 0.0"),
        (SHORT, {"kk": 1.0}, bg.ParameterError, "no parameter 'kk'"),
        (SHORT, {"k": "stiff"}, bg.ParameterError, "parameter 'k'"),
        (SHORT, {"k": 0.0}, bg.ParameterError, "1/k"),
    ],
)
def test_what_does_not_fit_is_refused(
    scenario: str | Scenario, parameters: dict, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        differentials.simulate("alsd", scenario, parameters)

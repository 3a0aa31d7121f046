"""Closed loops of all active differentials against an integration by hand and a textbook's steady states."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from references.closed_loops import (
    CAR,
    Drive,
    closed_loop,
    steady_moment,
    steady_yaw_rate,
    understeer,
)

import bondgraph as bg
import codegen
import differentials
from differentials.control.controllers import RATIOS

INERTIAS = {"I_1": 0.008, "I_2": 0.008, "I_3": 0.008, "I_4": 0.008, "I_c1": 0.026, "I_c2": 0.026,
            "I_s1": 0.0094, "I_s2": 0.0094}  # fmt: skip
GAINS = {"yaw_rate": {"K_p": 1e4, "K_i": 1e5}, "slip": {"K_p": 20.0, "K_i": 450.0}}
ICE = {"four_wheel_drive_tvd": {"k_t3": 1e4, "k_t4": 1e4}}

every = pytest.mark.parametrize("name", RATIOS)


def by_hand(name: str, manoeuvre: str, **changed: float) -> dict[str, np.ndarray]:
    case = differentials.manoeuvres[manoeuvre]
    drive = Drive(case.control, case.closed, case.steering, case.engine_torque)
    ice = ICE.get(name, {"k_t1": 1e4}) if manoeuvre.startswith("ice") else {}
    follow = {"K_ref": 0.004 if name == "alsd" else 0.001}
    return closed_loop(name, drive, INERTIAS | GAINS[case.control] | follow | ice | changed)


@cache
def run(name: str, manoeuvre: str) -> codegen.Result:
    return differentials.simulate(name, manoeuvre)


@every
@pytest.mark.parametrize("manoeuvre", differentials.manoeuvres)
def test_is_what_an_integration_by_hand_gives(name: str, manoeuvre: str) -> None:
    """Every state at every sample, to 1e-8 of its range; of a speed that hardly moves of 1 rad/s or m/s, of
    a torque of 100 N m."""
    right, found = by_hand(name, manoeuvre), run(name, manoeuvre)
    assert set(found.states) <= {*right, "demand", "demand_1", "demand_2"}
    for state, values in right.items():
        off = np.abs(found[state] - values).max()
        least = 1.0 if state.startswith(("omega", "v", "dw")) else 100.0
        assert off < 1e-8 * max(float(np.ptp(values)), least), f"{state} is off by {off:.1e}"


@every
def test_without_control_the_car_turns_as_the_textbook_has_it(name: str) -> None:
    case = dataclasses.replace(differentials.manoeuvres["step_steer_open"], duration=4.0)
    found = differentials.simulate(name, case)
    # An open differential moves no torque, so that no yaw moment is left.
    assert found["omega_z"][-1] == pytest.approx(steady_yaw_rate(CAR, 0.02), rel=1e-6)
    assert found["tau_hs2"][-1] - found["tau_hs1"][-1] == pytest.approx(0, abs=1e-3)


@every
def test_with_control_it_turns_as_the_car_to_follow(name: str) -> None:
    """The torque asked for is what Abe's balances need at that yaw rate; more turns a TVD alone."""
    case = dataclasses.replace(differentials.manoeuvres["step_steer"], duration=6.0)
    found = differentials.simulate(name, case)
    follow = 0.004 if name == "alsd" else 0.001
    wanted = CAR["v"] * 0.02 / (2.7 + follow * CAR["v"] ** 2)
    assert found["omega_z"][-1] == pytest.approx(wanted, rel=1e-6)
    assert (wanted > steady_yaw_rate(CAR, 0.02)) == (name != "alsd") == (follow < understeer(CAR))
    moment = steady_moment(CAR, 0.02, wanted)
    asked = abs(moment) / (CAR["track"] / 2) * 0.3
    # The 4WD's front axle loses as much on both sides; so do the others' cases.
    assert found["asked"][-1] == pytest.approx(asked, rel=2e-5)
    assert np.sign(moment) == (-1 if name == "alsd" else 1)


@every
def test_bounds_and_rates_are_kept_without_winding_up(name: str) -> None:
    """On ice with too weak a clutch: at its bound for most of the time, and as by hand."""
    tight = {"tau_max": 300.0, "rate_max": 1500.0}
    right, found = by_hand(name, "ice", **tight), differentials.simulate(name, "ice", tight)
    asked = found["asked"]
    assert asked.max() == 300.0
    assert np.abs(np.diff(asked)).max() == pytest.approx(1500 * 0.01, rel=1e-12)
    assert np.abs(asked - right["asked"]).max() < 1e-6
    assert np.abs(found["integral"] - right["integral"]).max() < 1e-6
    # Told back, the sum is the bound less the rest of the law, and no integral of the time at it.
    assert found["integral"].max() < 300 + 450 * 0.01 * found["dw"].max()


def test_it_leaves_its_bound_as_the_engine_lets_go() -> None:
    """Within two periods and the wheel's own time; a wound up sum of 0.5 s would take as long again."""
    ready = differentials.closed_loop("alsd", "ice", {"tau_max": 300.0})
    pulse = codegen.Lag(codegen.Pulse(0.1, 0.8, 350.0), 0.04)
    inputs = {**ready.inputs, "tau_e": pulse}
    simulator = codegen.simulator(ready.equations, ready.parameters, ready.laws)
    found = simulator.run(ready.times, ready.initial, inputs)
    let_go = found.time[np.flatnonzero(np.abs(found["dw"]) > 1.0)[-1]]
    bound = found.time[np.flatnonzero(found["asked"] == 300.0)[-1]]
    assert 0.8 < bound < let_go + 0.02
    assert found["asked"][-1] < 100


@every
def test_every_power_is_accounted_for(name: str) -> None:
    found = run(name, "ice")
    audit = found.audit()
    assert abs(audit.residual) < 1e-9 * audit.turned_over
    assert audit.took["I_z"] == pytest.approx(CAR["I_z"] * found["omega_z"][-1] ** 2 / 2, abs=1e-9)
    assert audit.took["m"] == pytest.approx(CAR["m"] * found["v_y"][-1] ** 2 / 2, abs=1e-9)
    forces = sum(found[f"F_x{j}"] for j in range(1, 5) if f"F_x{j}" in found.columns)
    ahead = np.trapezoid(CAR["v"] * forces, found.time)
    assert audit.gave["speed"] == pytest.approx(-ahead, rel=1e-4)


@every
def test_slip_is_what_is_left_of_it(name: str) -> None:
    """Open, it is that of statics, i tau_e/2 on ice and on the road; closed, the least that is wanted."""
    both = 2.8 * 350 / 2
    ice, road = (both * CAR["v"] / (slope * 0.3**2) for slope in (1e4, 2e5))
    open_slip = ice if name == "four_wheel_drive_tvd" else ice - road
    assert run(name, "ice_open")["dw"][-1] == pytest.approx(open_slip, rel=1e-5)
    left = 1.0 if name in ("alsd", "four_wheel_drive_tvd") else 0.0
    assert run(name, "ice")["dw"][-1] == pytest.approx(left, abs=2e-3)


def test_other_laws_and_backlash() -> None:
    stribeck = {"clutch": differentials.stribeck_clutch("tau_h", 1.2, 0.1)}
    found = differentials.simulate("alsd", "ice", laws=stribeck)
    # A friction that falls with slip makes the loop hunt: the clutch sticks and slips about what is wanted.
    kinds = [event.kind for event in found.events[1:]]
    assert kinds[:6] == ["stick", "slip"] * 3
    assert abs(found["dw"][found.time > 0.6] - 1).max() < 2
    loose = differentials.closed_loop("alsd", "step_steer", backlash=True)
    assert "q_halfshaft_1_spring" in {str(one) for one in loose.equations.further_states}


@pytest.mark.parametrize(
    ("name", "manoeuvre", "more", "error", "message"),
    [
        ("passive", "ice", {}, bg.StructureError, "passive has no clutch that moves torque"),
        ("alsd", "icy", {}, bg.SignalError, "'icy'"),
        ("alsd", "ice", {"parameters": {"K_pp": 1.0}}, bg.ParameterError, "no parameter 'K_pp'"),
        ("alsd", "ice", {"laws": {"tire_3": "0"}}, bg.StructureError, "no clutch or tire 'tire_3'"),
        ("alsd", differentials.Manoeuvre("yaw"), {}, bg.StructureError, "there is yaw_rate, slip"),
    ],
)
def test_what_does_not_fit_is_refused(
    name: str, manoeuvre: str, more: dict, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        differentials.closed_loop(name, manoeuvre, **more)


def test_the_names_there_are_end_a_refusal() -> None:
    with pytest.raises(bg.SignalError, match=r"there is fig11, .*step_steer, step_steer_open, ice"):
        differentials.simulate("alsd", "fig99")
    with pytest.raises(bg.SignalError, match=r"no manoeuvre is called 'icee' .did you mean 'ice'"):
        differentials.closed_loop("alsd", "icee")

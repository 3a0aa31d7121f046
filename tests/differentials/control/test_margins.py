"""Poles and margins of closed loops, against the loop by hand and against python-control."""

from functools import cache

import control
import numpy as np
import pytest
from control.matlab import c2d
from references.closed_loops import Drive, Loop
from scipy.linalg import expm

import bondgraph as bg
import differentials
from bondgraph.sampling.space import SampledSpace
from differentials.control.controllers import RATIOS, demands

PERIOD = 0.01
GAINS = {"yaw_rate": (1e4, 1e5), "slip": (20.0, 450.0)}

every = pytest.mark.parametrize("name", RATIOS)
driven = pytest.mark.parametrize("manoeuvre", ["step_steer", "ice"])


@cache
def closed(name: str, manoeuvre: str) -> SampledSpace:
    return differentials.sampled_loop(name, manoeuvre)


@cache
def opened(name: str, manoeuvre: str) -> SampledSpace:
    return differentials.open_loop(name, manoeuvre)


@every
@driven
def test_all_poles_are_inside_the_unit_circle(name: str, manoeuvre: str) -> None:
    assert abs(closed(name, manoeuvre).poles()[0]) < 1


@every
@driven
def test_python_control_finds_ample_margins(name: str, manoeuvre: str) -> None:
    """More than 45 degrees, and a factor of 4; the distance from -1 is beyond a half."""
    hertz = np.geomspace(0.05, 49.9, 4000)
    response = opened(name, manoeuvre).frequency_response(hertz)[:, 0, 0]
    gain, phase, *_ = control.margin(control.frd(response, 2 * np.pi * hertz))
    assert gain > 4
    assert phase > 45
    assert abs(1 + response).min() > 0.5
    assert opened(name, manoeuvre).transfer(1 + 1e-9)[0, 0].real > 1e6


@every
def test_the_open_loop_is_plant_times_controller(name: str) -> None:
    """The plant with its demand open, held by python-control's c2d, times K_p + K_i T/(z - 1)."""
    ready = differentials.closed_loop(name, "step_steer")
    run = differentials.simulate(name, "step_steer")
    plant = bg.derive(differentials.loop_graph(name), outputs=["dw"])
    slips = {one: float(run[one][-1]) for one in run.columns if one.startswith("omega_f")}
    led = demands(name)[-1]
    at = {str(one): float(run[str(one)][-1]) for one in plant.states} | slips
    model = bg.linearize(plant, at, inputs=[led], outputs=["omega_z"])
    space = model.numeric(ready.parameters)
    held = c2d(space.to_control()[0, space.inputs.index(led)], PERIOD, "zoh")
    ratio = {"stationary_tvd": 8.0, "four_wheel_drive_tvd": 3.6}.get(name, 1.0)
    sign = -1 if name == "alsd" else 1
    K_p, K_i = GAINS["yaw_rate"]
    for hertz in (0.1, 1.0, 2.0, 7.0, 20.0, 45.0):
        z = np.exp(2j * np.pi * hertz * PERIOD)
        right = sign * complex(held(z)) / ratio * (K_p + K_i * PERIOD / (z - 1))
        found = opened(name, "step_steer").transfer(z)[0, 0]
        assert abs(found - right) < 1e-8 * abs(right)


@every
def test_poles_are_those_of_the_loop_by_hand(name: str) -> None:
    """One period of the hand-written loop, its tick made a matrix by differences about the same state."""
    run = differentials.simulate(name, "step_steer")
    inertias = {"I_1": 0.008, "I_2": 0.008, "I_3": 0.008, "I_4": 0.008, "I_c1": 0.026,
                "I_c2": 0.026, "I_s1": 0.0094, "I_s2": 0.0094}  # fmt: skip
    K_p, K_i = GAINS["yaw_rate"]
    numbers = {"K_p": K_p, "K_i": K_i, "K_ref": 0.004 if name == "alsd" else 0.001}
    loop = Loop(name, Drive("yaw_rate", True, delta=0.02), inertias | numbers)
    z = loop.start()
    z[: loop.n] = [run[f"omega_{j + 1}"][-1] for j in range(loop.n)]
    z[loop.omega_z], z[loop.ref] = run["omega_z"][-1], run["omega_ref"][-1]
    whole = np.array([*z, run["asked"][-1], run["integral"][-1]])

    def period(s: np.ndarray) -> np.ndarray:
        after, asked, integral = loop.tick(s[:-2], s[-2], s[-1])
        return np.array([*after, asked, integral])

    tick = np.array([
        (period(whole + h) - period(whole - h)) / 2e-5 for h in 1e-5 * np.eye(len(whole))
    ]).T  # fmt: skip
    flow = np.eye(len(whole))
    signs = np.sign(loop.inner.F @ z[: loop.n])
    flow[:-2, :-2] = expm(loop.matrix(signs, True) * PERIOD)
    right = np.linalg.eigvals(flow @ tick)
    # The lags of steering and engine, and the constant, are the judge's own.
    for pole in closed(name, "step_steer").poles():
        assert abs(right - pole).min() < 2e-4


def test_a_loop_that_is_open_is_refused() -> None:
    with pytest.raises(bg.SignalError, match="no controller in this manoeuvre"):
        differentials.sampled_loop("alsd", "ice_open")
    with pytest.raises(
        bg.SignalError, match=r"asks for 300 N m, at a bound; there the loop is open"
    ):
        differentials.open_loop("alsd", "ice", {"tau_max": 300.0})
    with pytest.raises(bg.SignalError, match=r"a clutch sticks, omega_f = "):
        differentials.sampled_loop("alsd", "step_steer", {"K_ref": 0.02, "tau_max": 1e5})

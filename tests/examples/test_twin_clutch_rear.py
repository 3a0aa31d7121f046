"""The twin-clutch rear unit: torques as pressed for, a rigid axle when both clutches hold."""

import numpy as np
import sympy as sp

import bondgraph as bg
import codegen
from differentials.laws import linear_tire
from examples import twin_clutch_rear

i, I_i, I_r, I_w = sp.symbols("i I_i I_r I_w")


def test_equations_follow_from_newton() -> None:
    """(I_r + i^2 I_i) w_r' = i tau_e - tau_f1 - tau_f2, I_w w_j' = tau_fj - tau_tj."""
    found = bg.derive(twin_clutch_rear.graph(), outputs=["clutch_1", "clutch_2"])
    assert [str(s) for s in found.states] == ["omega_r", "omega_1", "omega_2"]
    assert sp.Matrix(found.A).expand() == sp.diag(I_r + i**2 * I_i, I_w, I_w)
    assert sp.Matrix([[i, -1, -1, 0, 0], [0, 1, 0, -1, 0], [0, 0, 1, 0, -1]]) == found.B
    assert sp.Matrix([[1, -1, 0], [1, 0, -1]]) == found.F


def test_both_locked_it_is_one_shaft() -> None:
    found = bg.derive(twin_clutch_rear.graph(), outputs=[])
    locked = bg.linearize(found, stuck=["clutch_1", "clutch_2"])
    assert sp.expand(locked.A[0, 0]) == I_r + i**2 * I_i + 2 * I_w
    assert locked.B.tolist() == [[i, -1, -1]]


def test_each_wheel_gets_what_its_clutch_is_pressed_for() -> None:
    run = twin_clutch_rear.run(left=400.0, right=150.0)
    assert not run.events
    assert abs(run["tau_t1"][-1] - 400) < 1e-6
    assert abs(run["tau_t2"][-1] - 150) < 1e-6


def test_pressed_hard_they_lock_one_after_the_other_and_share_the_torque() -> None:
    """Rigid axle at equal tires: both wheels end at one speed, halfway between their starts."""
    equations = bg.derive(twin_clutch_rear.graph(), outputs=["clutch_1", "clutch_2"])
    values = {"i": 2.5, "I_i": 0.16, "I_r": 0.02, "I_w": 0.8, "k_t": 2e5, "r": 0.3}
    laws = {"clutch_1": bg.DryFriction("tau_h"), "clutch_2": bg.DryFriction("tau_h"),
            "tire_1": linear_tire(1), "tire_2": linear_tire(2)}  # fmt: skip
    simulator = codegen.simulator(
        equations, values | {"omega_t1_0": 60, "omega_t2_0": 57}, laws=laws
    )
    start = {"omega_r": 63, "omega_1": 60, "omega_2": 57}
    run = simulator.run(np.linspace(0, 1, 101), start, {"tau_e": 0.0, "tau_h": 5000.0})
    assert {event.port for event in run.events if event.kind == "stick"} == {"clutch_1", "clutch_2"}
    c_1, c_2 = (2e5 * 0.3 / speed for speed in (60, 57))
    common = (c_1 * 60 + c_2 * 57) / (c_1 + c_2)
    assert abs(run["omega_1"][-1] - common) < 1e-7
    assert abs(run["omega_2"][-1] - common) < 1e-7

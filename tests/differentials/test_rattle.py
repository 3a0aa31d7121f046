"""Play that rattles, against the closed form of every contact and every flight through the gap."""

from functools import cache

import numpy as np
import pytest

import bondgraph as bg
import codegen
from differentials.parts import assemble, compliant_shaft, engine, inertia, shaft, tire

K, GAP, SPEED, END = 400.0, 0.1, 2.0, 1.2


def _closed_form(
    times: np.ndarray, damper: float, speed: float = SPEED
) -> tuple[np.ndarray, np.ndarray, int]:
    """Twist and its rate from the middle of the gap on, and how often the faces have met.

    Two inertias of 1: a depth d in contact obeys d'' = -2 (k d + b d'), so it is v/w exp(-b t) sin(w t) with
    w^2 = 2 k - b^2. The faces part where k d + b d' = 0, before d is zero again; then both fly on freely.
    """
    w = np.sqrt(2 * K - damper**2)
    touched = (np.pi - np.arctan2(damper * w, K - damper**2)) / w
    twist, rate = np.empty_like(times), np.empty_like(times)
    t, q, v, count = 0.0, 0.0, speed, 0
    while t < times[-1]:
        side = np.sign(v)
        flight = (side * GAP / 2 - q) / v
        flying = (times >= t) & (times <= t + flight)
        twist[flying], rate[flying] = q + v * (times[flying] - t), v
        t += flight
        count += t < times[-1]
        held = (times >= t) & (times <= t + touched)
        twist[held], rate[held] = _contact(times[held] - t, v, w, damper)
        twist[held] += side * GAP / 2
        depth, after = _contact(touched, v, w, damper)
        t, q, v = t + touched, side * GAP / 2 + depth, after
    return twist, rate, count


def _contact(t, v: float, w: float, damper: float):
    """Depth and its rate a time after the faces have met at a speed v."""
    fall = v * np.exp(-damper * t)
    return fall * np.sin(w * t) / w, fall * (np.cos(w * t) - damper / w * np.sin(w * t))


@cache
def _driveline(b: str | None) -> bg.StateEquations:
    graph = assemble(
        shaft("a"), shaft("b"), engine("motor", "T", at="a"),
        inertia("J_a", 1.0, at="a", speed="w_a"), inertia("J_b", 1.0, at="b", speed="w_b"),
        compliant_shaft("link", "a", "b", "k", b, gap="gap"), tire(1, at="b"),
    )  # fmt: skip
    return bg.derive(graph)


def _ready(damper: float, backend: str) -> codegen.Simulator:
    equations = _driveline("b" if damper else None)
    numbers = {"k": K, "gap": GAP} | ({"b": damper} if damper else {})
    return codegen.simulator(equations, numbers, {"tire_1": "0*omega_t1"}, backend)


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("damper", [0.0, 3.0])
def test_no_corner_slips_through_an_explicit_step(damper: float) -> None:
    """Wherever in a step a corner is: one start in ten was off by more, one in a hundred a hundredfold."""
    times, ready = np.linspace(0, END, 101), _ready(damper, "c")
    for speed in SPEED + 1e-4 * np.arange(200):
        run = ready.run(times, {"w_a": speed / 2, "w_b": -speed / 2}, {"T": 0.0}, "DOP853")
        twist, _, _ = _closed_form(times, damper, speed)
        assert run["q_link_spring"] == pytest.approx(twist, abs=2e-8 * np.ptp(twist))


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("damper", [0.0, 3.0])
def test_contacts_keep_to_their_closed_form(damper: float, method: str, backend: str) -> None:
    """The torque has a corner where faces meet, with a damper it jumps; methods step over both."""
    times = np.linspace(0, 1.0 if damper else 0.7, 501)
    start = {"w_a": SPEED / 2, "w_b": -SPEED / 2}
    run = _ready(damper, backend).run(times, start, {"T": 0.0}, method)
    assert run.backend == backend
    twist, rate, count = _closed_form(times, damper)
    assert count == 5
    most = 2e-8 if method == "DOP853" else 1e-7
    assert run["q_link_spring"] == pytest.approx(twist, abs=most * np.ptp(twist))
    assert run["w_a"] - run["w_b"] == pytest.approx(rate, abs=most * np.ptp(rate))

"""What hides inside a step, and what is left of a slip at rest: by the engine and the loop over runs."""

import numpy as np
import pytest
from oracles.models import block
from scipy.optimize import brentq

import bondgraph as bg
from codegen import Constant, Family, Ramp, Sine, event_count, final, first_event, peak, sweep
from codegen.record.result import Result

BLOCK = bg.derive(block(bg.DryFriction("L")))


def _both(numbers, times, initial, inputs) -> tuple[Result, dict[str, float]]:
    """A single run, and what a sweep measures of one."""
    family = Family(BLOCK, numbers, None, "c")
    measures = {
        "stick": first_event("ground", "stick"), "slip": first_event("ground", "slip"),
        "sticks": event_count("ground", "stick"), "last": final("v"), "most": peak("v"),
    }  # fmt: skip
    found = sweep(
        family, {"m": [numbers["m"]]}, times, measures, initial, inputs, workers=0, progress=False
    )
    run = family.simulator().run(times, initial, inputs)
    return run, {name: float(found[name][0]) for name in measures}


def test_a_slip_that_dips_below_zero_between_samples_that_are_above() -> None:
    """m v' = P - L is c (t - t_m): v is a parabola whose least value lies inside a step, below zero.

    It sticks there until the push is as strong as the friction, which is at t_m.
    """
    c, middle, level, h = 4.0, 0.505, 2.0, 0.01
    dip = 0.3 * c * h**2 / 8
    push = Constant(level - c * middle) + Ramp(0.0, c)
    run, found = _both(
        {"m": 1.0, "L": level},
        np.linspace(0.0, 1.0, 101),
        {"v": c * middle**2 / 2 - dip},
        {"P": push},
    )
    stick = middle - np.sqrt(2 * dip / c)
    assert [event.kind for event in run.events] == ["stick", "slip"]
    assert [event.time for event in run.events] == pytest.approx([stick, middle], abs=1e-8)
    assert (found["stick"], found["slip"]) == pytest.approx((stick, middle), abs=1e-8)


def test_a_dip_that_no_cubic_shows() -> None:
    """v is 0.96 - cos(w s) - b s^2, where s is from the middle of the first step and b makes it level at
    both ends: there it is above zero with slopes of zero, in the middle below.
    """
    w, level = 2.4, 3.0
    b = w * np.sin(w / 2)
    start = 0.96 - np.cos(w / 2) - b / 4
    assert start > 0.01
    push = Constant(level + b) + Sine(w, w / (2 * np.pi), phase=-w / 2) + Ramp(0.0, -2 * b)
    run, found = _both(
        {"m": 1.0, "L": level}, np.linspace(0.0, 20.0, 21), {"v": start}, {"P": push}
    )
    root = brentq(lambda t: 0.96 - np.cos(w * (t - 0.5)) - b * (t - 0.5) ** 2, 0.0, 0.5, xtol=1e-15)
    assert run.events[0].kind == "stick"
    assert run.events[0].time == pytest.approx(root, abs=1e-9)
    assert found["stick"] == pytest.approx(root, abs=1e-9)


def test_a_slip_of_rounding_is_taken_away_where_it_sticks() -> None:
    """What is left of the slip when a port comes to rest does not stay as a creep."""
    run, found = _both(
        {"m": 1.0, "L": 1.0}, np.linspace(0.0, 1.0, 21), {"v": 1e-13}, {"P": Sine(0.5, 1.0)}
    )
    assert run.events == ()
    assert np.abs(run["v"]).max() <= 1e-25
    assert abs(found["last"]) <= 1e-25
    assert found["most"] <= 1e-25

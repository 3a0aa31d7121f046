"""Tables of the time: cut at their breaks into polynomials that are exact."""

import numpy as np
import pytest
import sympy as sp
from references.interpolated import interpolated, random_table

import bondgraph as bg
from bondgraph.errors import SimulationError
from codegen.inputs.known import known, known_signal
from codegen.numbers.cells import polynomial_at, steepest

t = sp.Symbol("t")


@pytest.mark.parametrize("outside", ["hold", "extend"])
@pytest.mark.parametrize("method", ["linear", "pchip", "akima"])
def test_pieces_are_the_interpolators_own(method: str, outside: str) -> None:
    table, parts = random_table(method, outside)
    x = parts[0]
    begin, end = x[0] - 1, x[-1] + 1
    found = known_signal(table(t), begin, end)
    times = np.random.default_rng(0).uniform(begin, end, 2000)
    right = interpolated(method, outside, parts, [times], (0,))
    assert np.abs(np.array([found(at) for at in times]) - right).max() < 1e-11
    assert set(found.breakpoints) <= set(x.tolist())
    assert set(x[1:-1].tolist()) <= set(found.breakpoints)


@pytest.mark.parametrize("method", ["bilinear", "bicubic"])
def test_of_two_axes_both_are_cut(method: str) -> None:
    table, parts = random_table(method, "hold")
    x, y, _ = parts
    middle, swing = y.mean(), 0.7 * (y[-1] - y[0])
    law = table(t, middle + swing * sp.sin(t))
    found = known_signal(law, x[0] - 1, x[-1] + 1)
    times = np.random.default_rng(0).uniform(x[0] - 1, x[-1] + 1, 500)
    places = [times, middle + swing * np.sin(times)]
    right = interpolated(method, "hold", parts, places, (0, 0))
    assert np.abs(np.array([found(at) for at in times]) - right).max() < 1e-9


def test_a_break_that_is_touched_is_no_cut() -> None:
    """At pi/2 the argument is at a point of the table, and turns."""
    table = bg.LookupTable("f", [0, 1, 2, 4], [0, 1, 3, 4], method="pchip")
    found = known_signal(table(2 * sp.sin(t)), 0.0, 3.0)
    for at in np.linspace(0.1, 3, 30):
        assert found(at) == pytest.approx(float(table(2 * np.sin(at))), abs=1e-12)


def test_a_table_that_refuses_tells_when_it_is_left() -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 1, 3], outside="refuse")
    assert known_signal(table(t), 0.0, 2.0)(1.5) == 2.0
    with pytest.raises(SimulationError, match=r"f\(t\) leaves table 'f'.*at t = 2 s"):
        known_signal(table(t), 0.0, 3.0)


def test_slopes_and_held_ends_have_polynomials_as_well() -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 1, 3])
    assert known(table(t) * sp.sin(t))
    assert polynomial_at(sp.diff(table(t), t), [1.5]) == 2
    assert polynomial_at(sp.diff(table(t), t), [2.5]) == 0
    assert polynomial_at(table(t), [2.5]) == 3


@pytest.mark.parametrize("method", ["linear", "pchip", "akima"])
def test_no_slope_is_steeper_than_told(method: str) -> None:
    table, parts = random_table(method, "extend")
    x = np.linspace(parts[0][0], parts[0][-1], 5000)
    slopes = np.abs(interpolated(method, "extend", parts, [x], (1,)))
    assert slopes.max() <= steepest(table) * (1 + 1e-12)

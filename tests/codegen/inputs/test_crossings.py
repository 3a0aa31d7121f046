"""Where functions of time rise through zero, against their closed forms."""

import math

import numpy as np
import pytest
import sympy as sp

from codegen.inputs.crossings import Rises
from codegen.inputs.known import known_signal
from codegen.inputs.pieces import Piece

t = sp.Symbol("t")


def _rises(expression: str, end: float, least: float = 0.0) -> list[float]:
    """All rises of an expression of time that is one piece, from 0 on."""
    signal = known_signal(sp.sympify(expression), 0.0, end)
    assert not signal.breakpoints
    rises, found, at = Rises(signal.piece(0.0), 0.0, least), list[float](), 0.0
    while (at := rises.after(at, end)) < math.inf:
        found.append(at)
    return found


@pytest.mark.parametrize("frequency", [0.3, 50.0, 2e4])
def test_a_sine_rises_once_a_period(frequency: float) -> None:
    """More periods than one block of steps holds."""
    expected = (np.arange(400) + 0.75) / frequency
    found = _rises(f"sin(2*pi*{frequency!r}*t + pi/2)", 400 / frequency)
    assert found == pytest.approx(expected.tolist(), rel=1e-15, abs=0)


def test_polynomials_rise_where_their_roots_are() -> None:
    """One turn inside a step, a root where the function begins, and one that only falls."""
    assert _rises("(t - 1)*(t - 2)", 3.0) == pytest.approx([2.0], abs=1e-15)
    assert _rises("(t - 1)*(t - 2)*(t - 5/2)", 3.0) == pytest.approx([1.0, 2.5], abs=1e-14)
    assert _rises("t*(t - 2)", 3.0) == pytest.approx([2.0], abs=1e-15)
    assert _rises("1 - t", 3.0) == []


def test_two_roots_close_together_are_both_found() -> None:
    """cos is below 1 - 1e-10 but for about 1.4e-5 on either side of each period's end."""
    found = _rises("cos(t) - 1 + 1/10**10", 20.0)
    near = math.sqrt(2e-10)
    assert found == pytest.approx([k * 2 * math.pi - near for k in (1, 2, 3)], abs=1e-10)


def test_a_touch_is_no_rise() -> None:
    assert _rises("sin(3*t) - 1", 20.0, 1e-10) == []
    assert len(_rises("sin(3*t) - 999/1000", 20.0, 1e-10)) == 10


def test_a_sum_of_waves_rises_where_its_sign_turns() -> None:
    """Against a dense look at the signs, and each instant against the function itself."""
    expression = "sin(7*t) + sin(11*t)*exp(-t/5)/2 + t/20 - 1/3"
    function = sp.lambdify(t, sp.sympify(expression))
    times = np.linspace(0, 30, 300001)
    signs = function(times) > 0
    found = _rises(expression, 30.0)
    assert len(found) == np.count_nonzero(signs[1:] & ~signs[:-1]) > 20
    assert np.abs(function(np.array(found))).max() < 1e-13


def test_what_begins_at_zero_has_risen_where_it_is_seen_to() -> None:
    rises = Rises(Piece(0.0, ((0, (0.0, 1e-3)),)), 0.0, 1e-9)
    assert rises.after(0.0, 1.0) == pytest.approx(2e-6)

"""Signals without memory: values, breakpoints, continuity from the right, sums."""

import numpy as np
import pytest

from codegen import Constant, Lag, Pulse, Ramp, Sampled, Signal, Sine, Step, ZeroOrderHold

TIMES = np.linspace(-1.0, 3.0, 81)


def _line(times: list[float], values: list[float], at: float) -> float:
    return float(np.interp(at, times, values))


VALUES = [
    (Constant(3), lambda t: 3.0),
    (Constant(-0.5), lambda t: -0.5),
    (Step(0.5, 4.0), lambda t: 4.0 if t >= 0.5 else 0.0),
    (Step(-0.3, -2.0, 1.5), lambda t: -2.0 if t >= -0.3 else 1.5),
    (Ramp(0.2, 3.0), lambda t: 3.0 * max(t - 0.2, 0.0)),
    (Ramp(0.2, -3.0, 1.0, 1.7), lambda t: 1.0 - 3.0 * (min(max(t, 0.2), 1.7) - 0.2)),
    (Ramp(-0.5, 2.0, end=0.0), lambda t: 2.0 * (min(max(t, -0.5), 0.0) + 0.5)),
    (Sine(2.0, 1.3), lambda t: 2.0 * np.sin(2 * np.pi * 1.3 * t)),
    (Sine(2.0, 0.7, 0.4, -1.0), lambda t: 2.0 * np.sin(2 * np.pi * 0.7 * t + 0.4) - 1.0),
    (Sine(2.0, 0.0, 0.4, 1.0), lambda t: 2.0 * np.sin(0.4) + 1.0),
    (-2.5 * Ramp(0.2, 3.0), lambda t: -7.5 * max(t - 0.2, 0.0)),
    (Sine(2.0, 1.3) * 3, lambda t: 6.0 * np.sin(2 * np.pi * 1.3 * t)),
    (Sampled([0, 1, 1.5], [2, -1, 4]), lambda t: _line([0, 1, 1.5], [2, -1, 4], t)),
    (Pulse(0.2, 1.2, 3.0, -1.0), lambda t: 3.0 if 0.2 <= t < 1.2 else -1.0),
    (ZeroOrderHold([0.5, 1, 1.5], [2, -1, 4]), lambda t: 2 if t < 1 else (-1 if t < 1.5 else 4)),
    (ZeroOrderHold([0.5], [2]), lambda t: 2.0),
]
SIGNALS = [signal for signal, _ in VALUES]
IDS = [str(signal) for signal in SIGNALS]


@pytest.mark.parametrize(("signal", "value"), VALUES, ids=IDS)
def test_values_are_those_of_the_definition(signal: Signal, value) -> None:
    # The grid holds every breakpoint of the cases, up to rounding of linspace.
    for t in TIMES.tolist():
        nearest = min(signal.breakpoints, key=lambda b: abs(b - t), default=np.inf)
        if t == nearest or abs(t - nearest) > 1e-9:
            assert signal(t) == pytest.approx(value(t), rel=1e-13, abs=1e-13)


@pytest.mark.parametrize("signal", SIGNALS, ids=IDS)
def test_continuous_from_the_right_with_a_piece_for_each_stretch(signal: Signal) -> None:
    assert list(signal.breakpoints) == sorted(signal.breakpoints)
    assert len(signal.pieces) == len(signal.breakpoints) + 1
    for before, after, at in zip(
        signal.pieces, signal.pieces[1:], signal.breakpoints, strict=False
    ):
        assert signal(at) == after(at)
        assert signal(np.nextafter(at, -np.inf)) == before(np.nextafter(at, -np.inf))
        assert signal(at + 1e-9) == pytest.approx(signal(at), abs=1e-7)
        if not isinstance(signal, Step | Pulse | ZeroOrderHold):
            assert before(at) == pytest.approx(after(at), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize("signal", [*SIGNALS, Lag(Step(0.5, 4.0), 0.3), Lag(Sine(1.0, 2.0), 0.1)])
def test_derivative_of_each_piece_is_its_slope(signal: Signal) -> None:
    h = 1e-4
    for piece in signal.pieces:
        for t in (0.61, 1.23, 2.71):
            # Five points: the error is h^4 f'''''/30, below 1e-10 for rates up to 20/s.
            slope = (
                (8 * (piece(t + h) - piece(t - h)) - piece(t + 2 * h) + piece(t - 2 * h)) / 12 / h
            )
            assert piece.derivative(t) == pytest.approx(slope, rel=1e-8, abs=1e-8)


def test_a_sum_is_the_sum_and_knows_all_breakpoints() -> None:
    parts = [Step(0.5, 4.0), Ramp(0.2, 3.0, end=0.5), Sine(2.0, 1.3, 0.1), Lag(Step(0.9, 1.0), 0.2)]
    total = parts[0] + parts[1] + parts[2] + parts[3]
    assert total.breakpoints == (0.2, 0.5, 0.9)
    for t in (*TIMES.tolist(), 0.2, 0.5, 0.9):
        assert total(t) == pytest.approx(sum(part(t) for part in parts), rel=1e-13, abs=1e-13)


def test_a_sum_of_signals_without_breakpoints_is_one_piece() -> None:
    total = Constant(2.0) + Sine(1.0, 0.5)
    assert total.breakpoints == ()
    assert total(0.5) == pytest.approx(3.0, rel=1e-15)


def test_far_from_its_start_a_signal_is_as_exact_as_near() -> None:
    assert Sine(1.0, 1.0, 0.25)(1000.0) == pytest.approx(np.sin(0.25), abs=1e-11)
    shifted = Step(1000.0, 1.0) + Sine(1.0, 1.0, 0.25)
    assert shifted(1000.0) == pytest.approx(1.0 + np.sin(0.25), abs=1e-11)
    assert shifted(0.0) == pytest.approx(np.sin(0.25), abs=1e-11)


def test_held_values_begin_at_whole_numbers_of_periods() -> None:
    """0.1 added up ten times is not 1: the times are products."""
    held = ZeroOrderHold(values=range(1001), period=0.1, start=-2.0)
    assert held.breakpoints == tuple(-2.0 + 0.1 * k for k in range(1, 1001))
    assert [held(t) for t in (-9.0, held.times[7], 1e9)] == [0.0, 7.0, 1000.0]

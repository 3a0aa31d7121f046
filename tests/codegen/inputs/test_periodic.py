"""Signals that repeat: values, instants that no length of time makes inexact, lags in their steady state."""

import math
from fractions import Fraction
from itertools import islice

import mpmath
import numpy as np
import pytest
import scipy
from references.pulsed import current, switchings

from bondgraph import SignalError
from codegen import PWM, Constant, Lag, Ramp, Sawtooth, Signal, Sine, Square, Step
from codegen.inputs.waves import Wave

RNG = np.random.default_rng
TIMES = np.linspace(-1.003, 2.001, 401)


def _drawn(seed: int) -> tuple[float, float, float]:
    """A frequency [Hz], a phase and a duty."""
    rng = RNG(seed)
    return 10 ** rng.uniform(1, 6), rng.uniform(-2, 2), rng.uniform(0.02, 0.98)


def test_square_and_sawtooth_are_those_of_scipy() -> None:
    """At angles that are no instants; a period begins at a quarter of one later."""
    for duty in (0.2, 0.5, 0.9):
        angle = 2 * np.pi * (3.0 * TIMES - 0.25)
        expected = 0.5 + 1.5 * scipy.signal.square(angle, duty)
        assert Square(3.0, -1.0, 2.0, duty, 0.25).sampled(TIMES) == pytest.approx(expected)
    for width in (0.0, 0.3, 0.5, 1.0):
        expected = 0.5 + 1.5 * scipy.signal.sawtooth(angle, width)
        found = Sawtooth(3.0, -1.0, 2.0, width, 0.25).sampled(TIMES)
        assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_instants_are_whole_numbers_over_the_frequency(seed: int) -> None:
    """Within a rounding of the rational numbers they stand for, even after a thousand million periods."""
    f, phase, duty = _drawn(seed)
    signal = PWM(f, duty, phase=phase)
    for far in (0.0, 1e9 / f):
        found = list(islice(signal.within(far, math.inf), 40))
        first = math.ceil(Fraction(found[0]) * Fraction(f) - Fraction(phase) - Fraction(duty) - 1)
        exact = sorted(
            (k + Fraction(phase) + more) / Fraction(f)
            for k in range(first - 2, first + 30) for more in (0, Fraction(duty))
        )  # fmt: skip
        at = min(range(len(exact)), key=lambda i: abs(exact[i] - Fraction(found[0])))
        for one, other in zip(found, exact[at:], strict=False):
            assert abs(Fraction(one) - other) <= 4 * Fraction(math.ulp(max(abs(one), 1 / f)))


def test_instants_are_the_doubles_nearest_to_what_they_stand_for() -> None:
    """A tenth added up, or times three, is another double than three tenths."""
    found = list(PWM(10.0, 0.5).within(0.0, 5.0))
    assert found == [k / 20 for k in range(1, 101)]
    assert found[5] == 0.3 != 3 * 0.1


@pytest.mark.parametrize("seed", range(20))
def test_so_many_switchings_as_there_are(seed: int) -> None:
    f, phase, duty = _drawn(seed)
    begin = RNG(seed).uniform(-1, 1)
    end = begin + 500.3 / f
    found = list(PWM(f, duty, phase=phase).within(begin, end))
    assert len(found) == switchings(begin, end, f, duty, phase)
    assert found == sorted({*found})


@pytest.mark.parametrize("seed", range(40))
def test_the_following_piece_is_the_next_one(seed: int) -> None:
    """Just before, at and just after each instant, however long the duty's part is."""
    rng, (f, phase, duty) = RNG(seed), _drawn(seed)
    duty = rng.choice([duty, 1e-15, 1e-9, 1 - 1e-16, 1 - 1e-9, 1 - 2**-53])
    signal = PWM(f, duty, -1.0, 1.0, phase)
    for far in rng.uniform(-100, 1e6, 20) / f:
        for at in islice(signal.within(float(far), math.inf), 4):
            before = math.nextafter(at, -math.inf)
            assert signal.preceding(at) == at
            assert signal.preceding(before) < at
            assert signal.following(before) == at
            assert signal.following(at) > at
            assert signal(at) == signal(math.nextafter(signal.following(at), -math.inf))


def test_parts_too_short_for_time_are_none() -> None:
    """Their two ends are one double; the other part then begins at once."""
    signal = PWM(1e6, 1e-12)
    found = list(signal.within(1e3, 1e3 + 3.5e-6))
    assert len(found) == 3
    assert [signal(t) for t in found] == [0.0] * 3


def test_what_repeats_faster_than_time_can_tell_is_refused() -> None:
    with pytest.raises(
        SignalError, match="a period of 1e-20 s is no more than the rounding of time"
    ):
        PWM(1e20, 0.5).following(1.0)


@pytest.mark.parametrize(("duty", "level"), [(0, 2.0), (1, 5.0)])
def test_a_duty_at_its_ends_switches_nothing(duty: float, level: float) -> None:
    signal = PWM(1e3, duty, 2.0, 5.0)
    assert list(signal.within(0.0, 1.0)) == []
    assert signal.sampled(TIMES).tolist() == [level] * len(TIMES)


@pytest.mark.parametrize(("duty", "level"), [(-3.0, 2.0), (1.5, 5.0)])
def test_a_duty_that_is_a_signal_is_clipped(duty: float, level: float) -> None:
    signal = PWM(1e3, Constant(duty), 2.0, 5.0)
    assert signal.sampled(TIMES).tolist() == [level] * len(TIMES)


def test_a_duty_is_read_at_the_start_of_each_period_and_clipped() -> None:
    duty = Ramp(0.0, 20.0, -0.25, 0.1)
    signal = PWM(100.0, duty, phase=0.5)
    expected = []
    for k in range(-1, 10):
        start = (k + 0.5) / 100
        share = min(max(duty(start), 0.0), 1.0)
        expected += [start] if share >= 1 else sorted({start, (k + (0.5 + share)) / 100})
    assert list(signal.within(-0.01, 0.1)) == [t for t in expected if -0.01 < t <= 0.1]
    # Below zero it begins nothing before the period's start.
    assert duty(0.005) < 0
    assert signal.preceding(0.007) == 0.005
    for t in np.linspace(0, 0.1, 1001).tolist():
        k = math.floor(100 * t - 0.5)
        share = duty((k + 0.5) / 100)
        if abs(100 * t - 0.5 - k - share) > 1e-9:
            assert signal(t) == float(100 * t - 0.5 - k < share)


MIXED = [
    PWM(30.0, 0.3, 1.0, -2.0, 0.1), PWM(30.0, Sine(0.7, 2.0, offset=0.5)), Sawtooth(7.0, 0, 2, 0.3),
    Lag(Square(11.0, 0.0, 1.0), 0.02), 3 * (PWM(9.0, 0.2) + Ramp(0.1, 2.0) + Lag(Square(4.0, 0, 1), 0.1)),
    Lag(PWM(30.0, Sine(0.4, 2.0, offset=0.5)) + Step(0.3, 1.0), 0.01),
]  # fmt: skip


@pytest.mark.parametrize("signal", MIXED, ids=range(len(MIXED)))
def test_many_values_at_once_are_those_one_by_one(signal: Signal) -> None:
    one_by_one = [signal(t) for t in TIMES.tolist()]
    assert signal.sampled(TIMES) == pytest.approx(one_by_one, rel=1e-13, abs=1e-13)
    rates = [signal.piece(t).derivative(t) for t in TIMES.tolist()]
    assert signal.sampled(TIMES, rates=True) == pytest.approx(rates, rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("signal", MIXED, ids=range(len(MIXED)))
def test_the_first_jump_is_found_without_a_list(signal: Signal) -> None:
    found = signal.first_jump(0.2, 0.7)
    jumps = [
        t for t in signal.within(0.2, 0.7)
        if abs(signal(t) - signal.piece(math.nextafter(t, -1))(t)) > 1e-9
    ]  # fmt: skip
    assert found == (jumps[0] if jumps else None)


@pytest.mark.parametrize("name", ["breakpoints", "pieces"])
def test_no_tuple_holds_what_has_no_end(name: str) -> None:
    with pytest.raises(SignalError, match=rf"PWM\(.*\) has {name} without end"):
        getattr(PWM(1e3, 0.5), name)


@pytest.mark.parametrize("seed", range(12))
def test_a_lag_is_in_its_periodic_state(seed: int) -> None:
    """y = i R/V of a coil; time constants from far below a period to far above."""
    f, phase, duty = _drawn(seed)
    T = 10 ** RNG(seed).uniform(-2, 4) / f
    lag = Lag(PWM(f, duty, phase=phase), T)
    for t in (RNG(seed).uniform(-50, 1000, 30) / f).tolist():
        assert lag(t) == pytest.approx(current(t, 1.0, 1.0, T, f, duty, phase), abs=1e-12)


def test_a_lag_of_a_triangle_by_its_series() -> None:
    """Its odd harmonics, each behind the lag."""
    f, T, t = 3.0, 0.05, 0.2345
    with mpmath.workdps(30):
        w = 2 * mpmath.pi * f
        n = range(1, 30_001, 2)
        total = mpmath.fsum(
            -8 / (mpmath.pi * k) ** 2 * mpmath.re(mpmath.expj(k * w * t) / (1 + 1j * k * w * T))
            for k in n
        )
    assert Lag(Sawtooth(f, -1.0, 1.0, 0.5), T)(t) == pytest.approx(float(total), abs=1e-9)


def test_lags_of_lags_and_of_sums_go_on_where_they_were() -> None:
    twice = Lag(Lag(PWM(50.0, 0.3), 0.01) + Step(0.05, 1.0), 0.01)
    for t in islice(twice.within(0.0, 1.0), 60):
        before = twice.piece(math.nextafter(t, -1))
        assert before(t) == pytest.approx(twice(t), abs=1e-14)
    T, d = 0.01, 1e-6
    inner = Lag(PWM(50.0, 0.3), 0.01) + Step(0.05, 1.0)
    for t in (0.0123, 0.0504, 0.333):
        slope = (twice(t + d) - twice(t - d)) / (2 * d)
        assert T * slope + twice(t) == pytest.approx(inner(t), abs=1e-7)


def test_a_lag_of_a_moving_duty_is_as_if_it_had_been_what_it_is_at_zero() -> None:
    """It steps at 0.05 s: until then it is the lag of the first duty; then period by period."""
    duty, f, T = Step(0.05, 0.8, 0.3), 100.0, 0.02
    lag = Lag(PWM(f, duty), T)
    still = Lag(PWM(f, 0.3), T)
    for t in (-0.013, 0.0, 0.0031, 0.05):
        assert lag(t) == pytest.approx(still(t), abs=1e-14)
    y = still(0.05)
    for k in range(5, 60):
        for last, level in ((0.8 / f, 1.0), (0.2 / f, 0.0)):
            y = level + (y - level) * math.exp(-last / T)
        assert lag((k + 1) / f) == pytest.approx(y, abs=1e-13)
    assert lag(0.0031) == pytest.approx(still(0.0031), abs=1e-14)


def test_what_a_lag_remembers_does_not_grow() -> None:
    lag = Lag(PWM(1e4, Sine(0.4, 50.0, offset=0.5)), 1e-3)
    (chase,) = lag.summands
    lag(0.2)
    assert len(chase._latest) == 64
    assert Lag(PWM(1e4, Sine(0.4, 50.0, offset=0.5)), 1e-3)(0.1) == lag(0.1)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PWM(0.0, 0.5), "PWM: the frequency must be positive, not 0.0"),
        (lambda: PWM(-1.0, 0.5), "PWM: the frequency must be positive"),
        (lambda: PWM(math.nan, 0.5), "PWM: nan is not finite"),
        (lambda: PWM(1.0, "0.5"), "PWM: '0.5' is not a number"),
        (lambda: PWM(1.0, 2), "PWM: the duty must be from 0 to 1, not 2"),
        (lambda: PWM(1.0, -0.1), "PWM: the duty must be from 0 to 1, not -0.1"),
        (lambda: PWM(1.0, 0.5, phase=math.inf), "PWM: inf is not finite"),
        (lambda: Square(1.0, 0.0, 1.0, 1.5), "Square: the duty must be from 0 to 1, not 1.5"),
        (lambda: Square(0, 0.0, 1.0), "Square: the frequency must be positive, not 0"),
        (lambda: Sawtooth(1.0, 0.0, 1.0, -0.1), "Sawtooth: the width must be from 0 to 1"),
        (lambda: Sawtooth(1.0, 0.0, None), "Sawtooth: None is not a number"),
    ],
)
def test_what_cannot_repeat_is_refused(make, message: str) -> None:
    with pytest.raises(SignalError, match=message):
        make()


def test_a_sum_keeps_what_it_is_made_of() -> None:
    total = PWM(1e3, 0.2) + Step(0.1, 2.0) + PWM(1e3, 1.0)
    kinds = [type(part) for part in total.summands]
    assert kinds == [Wave, Step, Constant]
    assert total(0.05) == 2.0
    assert total.following(0.0999) == pytest.approx(0.1, abs=1e-15)

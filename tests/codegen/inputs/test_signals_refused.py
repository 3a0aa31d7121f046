"""Signals that cannot be: every refusal is a `SignalError` that says what is wrong."""

import math

import numpy as np
import pytest

from bondgraph import SignalError
from codegen import Constant, Lag, Pulse, Ramp, Sampled, Sine, Step, ZeroOrderHold
from codegen.inputs.signals import as_signal

NOT_FINITE = [math.nan, math.inf, -math.inf]
MAKERS = [
    ("Constant", Constant), ("Step", lambda x: Step(x, 1.0)), ("Step", lambda x: Step(0.0, x)),
    ("Step", lambda x: Step(0.0, 1.0, x)), ("Ramp", lambda x: Ramp(x, 1.0)),
    ("Ramp", lambda x: Ramp(0.0, x)), ("Ramp", lambda x: Ramp(0.0, 1.0, x)),
    ("Ramp", lambda x: Ramp(0.0, 1.0, 0.0, x)), ("Sine", lambda x: Sine(x, 1.0)),
    ("Sine", lambda x: Sine(1.0, x)), ("Sine", lambda x: Sine(1.0, 1.0, x)),
    ("Sine", lambda x: Sine(1.0, 1.0, 0.0, x)), ("Lag", lambda x: Lag(Constant(1.0), x)),
    ("Pulse", lambda x: Pulse(x, 2.0, 1.0)), ("Pulse", lambda x: Pulse(0.0, x, 1.0)),
    ("Pulse", lambda x: Pulse(0.0, 1.0, x)), ("Pulse", lambda x: Pulse(0.0, 1.0, 1.0, x)),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "make"), MAKERS)
@pytest.mark.parametrize("value", NOT_FINITE)
def test_numbers_must_be_finite(kind: str, make, value: float) -> None:
    with pytest.raises(SignalError, match=f"{kind}: .*{value!r} is not finite"):
        make(value)


@pytest.mark.parametrize(("kind", "make"), MAKERS)
@pytest.mark.parametrize("value", ["1", True, 1j, np.complex128(1 + 5j), [1.0]])
def test_numbers_must_be_numbers(kind: str, make, value: object) -> None:
    with pytest.raises(SignalError, match=f"{kind}: .* is not a number"):
        make(value)


@pytest.mark.parametrize("value", [*NOT_FINITE, pytest.param(10**400, id="huge")])
def test_a_factor_must_be_finite(value: float) -> None:
    with pytest.raises(SignalError, match=f"times {value!r}: the factor is not finite"):
        value * Step(0.0, 1.0)


@pytest.mark.parametrize("value", ["1", True, 2j, np.complex128(2j), Step(0.0, 1.0)])
def test_a_factor_must_be_a_number(value: object) -> None:
    with pytest.raises(TypeError, match=r"multiply|unsupported operand"):
        Constant(2.0) * value


def test_numpy_numbers_are_numbers() -> None:
    assert Step(np.float64(0.1), np.int64(3))(0.1) == 3.0


@pytest.mark.parametrize("constant", [0, 0.0, -0.1])
def test_time_constant_must_be_positive(constant: float) -> None:
    with pytest.raises(SignalError, match=f"time constant must be positive, not {constant}"):
        Lag(Step(0.0, 1.0), constant)


def test_lag_must_follow_a_signal() -> None:
    with pytest.raises(SignalError, match=r"a lag follows a signal, not 3\.0"):
        Lag(3.0, 0.1)


@pytest.mark.parametrize("end", [0.1, 0.0, -1.0])
def test_ramp_must_end_after_it_begins(end: float) -> None:
    with pytest.raises(SignalError, match="a ramp must end after it begins"):
        Ramp(0.1, 1.0, end=end)


@pytest.mark.parametrize(
    ("times", "values", "message"),
    [
        ([0, 1], [1, 2, 3], r"one length, two or more, not \(2,\) and \(3,\)"),
        ([0], [1], r"one length, two or more"),
        ([], [], r"one length, two or more"),
        (0.0, 1.0, r"one length, two or more"),
        ([[0, 1]], [[1, 2]], r"one length, two or more"),
        ([0, 1, 1], [1, 2, 3], "the times must increase"),
        ([0, 2, 1], [1, 2, 3], "the times must increase"),
        ([0, math.nan], [1, 2], "a time or a value is not finite"),
        ([0, 1], [1, math.inf], "a time or a value is not finite"),
        (["zero", "one"], [1, 2], "samples.*must be numbers"),
        ([0, 1], [1, 2j], "samples.*must be numbers"),
        ([0, 1], np.array([1, 2j]), "samples.*must be numbers: these are complex128"),
        ([0, 1], ["1", "2"], "samples.*must be numbers"),
        ([0, [1, 2]], [1, 2], "samples"),
    ],
)
def test_samples_must_be_two_increasing_finite_columns(times, values, message: str) -> None:
    with pytest.raises(SignalError, match=message):
        Sampled(times, values)


def test_a_pulse_must_end_after_it_begins() -> None:
    with pytest.raises(SignalError, match="a pulse must end after it begins"):
        Pulse(0.2, 0.2, 1.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"times": [0, 1], "values": [1, 2, 3]}, "one length, not 2 and 3"),
        ({"times": [0, 0], "values": [1, 2]}, "the times must increase"),
        ({"values": [1, 2]}, "either times or a period"),
        ({"times": [0, 1], "values": [1, 2], "period": 1.0}, "either times or a period"),
        ({"values": [1, 2], "period": 0.0}, "the period must be positive, not 0.0"),
        ({"values": [1, 2], "period": math.inf}, "the period must be a finite number, not inf"),
        ({"values": [1, 2], "period": "1"}, "the period must be a finite number, not '1'"),
        ({"values": [1], "period": 1, "start": math.nan}, "the start must be a finite number"),
        ({"values": [], "period": 1.0}, "values must be one number or more in a row"),
        ({"times": [0, 1], "values": [1, math.nan]}, "one of the values is not finite"),
        ({"times": ["a"], "values": [1]}, "times must be numbers"),
    ],
)
def test_held_values_must_be_a_column_with_its_times(given, message: str) -> None:
    with pytest.raises(SignalError, match=f"held values.*{message}"):
        ZeroOrderHold(**given)


def test_adding_a_number_is_refused() -> None:
    with pytest.raises(TypeError, match="unsupported operand"):
        Step(0.0, 1.0) + 1.0


@pytest.mark.parametrize("value", ["5", None, True, 2j, [1.0], np.array([1.0, 2.0])])
def test_an_input_must_be_a_signal_or_a_number(value: object) -> None:
    with pytest.raises(SignalError, match=r"input 'tau': .* is neither a signal nor a number"):
        as_signal(value, "tau")


@pytest.mark.parametrize("value", [math.nan, math.inf, np.float64(-np.inf)])
def test_an_input_must_be_finite(value: float) -> None:
    with pytest.raises(SignalError, match=r"input 'tau': .* is not a finite number"):
        as_signal(value, "tau")


def test_numbers_become_constants_and_signals_stay() -> None:
    step = Step(0.0, 1.0)
    assert as_signal(step, "tau") is step
    assert as_signal(np.int64(3), "tau") == Constant(3.0)

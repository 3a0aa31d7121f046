"""Signals and laws out of text: what is read, and that nothing else is."""

import pytest

import bondgraph as bg
from codegen import PWM, Constant, Lag, Pulse, Ramp, Sawtooth, Sine, Square, Step
from differentials.commands.signals import law, signal


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("350", Constant(350.0)),
        ("-1e-3", Constant(-0.001)),
        ("1/8", Constant(0.125)),
        ("constant(2)", Constant(2.0)),
        ("step(0.1, 350)", Step(0.1, 350.0)),
        ("step(time=0.1, value=-350, initial=2)", Step(0.1, -350.0, 2.0)),
        ("ramp(0, 5, 1, 2)", Ramp(0.0, 5.0, 1.0, 2.0)),
        ("sine(10, 50)", Sine(10.0, 50.0)),
        ("sine(10, 50, offset=1)", Sine(10.0, 50.0, offset=1.0)),
        (" lag(lag(step(0, 1), 0.1), 0.2) ", Lag(Lag(Step(0.0, 1.0), 0.1), 0.2)),
        ("pulse(0.1, 0.2, 5)", Pulse(0.1, 0.2, 5.0)),
        ("square(2e3, -1, 1, phase=0.5)", Square(2000.0, -1.0, 1.0, phase=0.5)),
        ("sawtooth(50, 0, 1, 0.5)", Sawtooth(50.0, 0.0, 1.0, 0.5)),
        ("pwm(1e4, 0.3, high=24)", PWM(10_000.0, 0.3, high=24.0)),
        ("pwm(1e4, lag(step(0, 1), 0.1))", PWM(10_000.0, Lag(Step(0.0, 1.0), 0.1))),
    ],
)
def test_a_text_is_the_signal_it_says(text: str, expected: object) -> None:
    assert signal(text) == expected


def test_sums_add_up() -> None:
    assert signal("2 + step(1, 3) + 4")(0.5) == 6.0
    assert signal("2 + step(1, 3) + 4")(1.5) == 9.0


@pytest.mark.parametrize(
    "text",
    [
        "", "stp(0.1)", "step", "step(0.1)", "step(1, 2, 3, 4)", "step(1, time=2)", "step(a=1, b=2)",
        "step(*[1, 2])", "step(**{})", "lag(1, 0.1, 2)", "lag(0.1)", "step(step(0, 1), 2)", "tau",
        "1/0", "exp(1e9)", "10**400", "nan", "inf", "1j", "True", "'1'", "step(0, 1)*2", "pwm(0, 0.5)",
        "square(1, 0, 1, sine(1, 1))", "pwm(1e3)",
        "__import__('os').system('false')", "(lambda: 1)()", "step.__class__(1)", "[1]", "1; 2",
        "lag(step(0, 1), 0)", "(" * 300, "lag(" * 30 + "1" + ", 1)" * 30, "1 " * 1000, "\0",
    ],
)  # fmt: skip
def test_anything_else_is_refused_by_a_typed_error(text: str) -> None:
    with pytest.raises(bg.BondGraphError):
        signal(text)


def test_refusals_say_what_there_is() -> None:
    with pytest.raises(bg.SignalError, match=r"step\(time, value, \[initial\]\), ramp"):
        signal("stp(0.1, 350)")
    with pytest.raises(
        bg.SignalError, match=r"'step\(0.1\)' is not step\(time, value, \[initial\]\)"
    ):
        signal("step(0.1)")


def test_laws_are_expressions_or_friction() -> None:
    assert law("c*omega**2") == bg.expression("c*omega**2", "law")
    assert law("friction(tau_h)") == bg.DryFriction("tau_h")
    assert law("friction(10, 1 + slip, 2)") == bg.DryFriction(10, "1 + slip", 2)
    assert law("friction_1 + 1") == bg.expression("friction_1 + 1", "law")


@pytest.mark.parametrize(
    "text", ["friction()", "friction(1, 1, 1, 1)", "friction(level=1)", "open(1)"]
)
def test_other_laws_are_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError):
        law(text)

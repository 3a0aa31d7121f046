"""Known sources as signals: exact pieces, polynomials that bounds make exact, corners and jumps."""

import cmath
import math

import mpmath
import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
from codegen.inputs.branches import crossings, known
from codegen.inputs.discs import FUNCTIONS, disc_of
from codegen.inputs.harmonics import terms_of
from codegen.inputs.known import known_signal
from codegen.inputs.pieces import Piece

T = sp.Symbol("t")

EXACT = [
    "21/20*sin(157/25*t)**3", "t*exp(-t/3)*cos(2*pi*t + 1)", "2**t*sin(t)*cos(3*t)", "(1 + t)**3 - t",
    "sin(t)**2*cos(sqrt(2)*t)**2*exp(-t/7)", "sinh(t/4)*cosh(t/5)*sin(t)", "sin(3*t)**10",
]  # fmt: skip

SMOOTH = [
    "sin(t**2)", "sqrt(1 + sin(t) + 1/100)", "exp(-1000*(t - 3)**2)", "1/(1 + 10000*(t - 5)**2)",
    "tanh(20*sin(t))", "log(1 + t)*atan(t)", "asin(sin(t)/2)", "erf(10*sin(t))", "(1 + t)**(5/2)",
    "acos(cos(t)/3)*asinh(t)", "exp(sin(7*t))/(2 + cos(t))", "tan(sin(t))", "(1 + t)**sin(t)",
]  # fmt: skip


def _value(expr: sp.Expr, t: float) -> float:
    """In 30 digits, by mpmath."""
    with mpmath.workdps(30):
        return float(sp.lambdify(T, expr, "mpmath")(mpmath.mpf(t)))


@pytest.mark.parametrize("text", EXACT)
def test_products_and_sums_are_exact_pieces(text: str) -> None:
    expr = sp.sympify(text)
    signal = known_signal(expr, 0.0, 9.0)
    assert signal.breakpoints == ()
    times = np.random.default_rng(3).uniform(0, 9, 40).tolist()
    expected = [_value(expr, t) for t in times]
    assert [signal(t) for t in times] == pytest.approx(
        expected, abs=4e-14 * max(map(abs, expected))
    )
    slope = [_value(sp.diff(expr, T), t) for t in times]
    derivative = [signal.piece(t).derivative(t) for t in times]
    assert derivative == pytest.approx(slope, abs=1e-12 * max(map(abs, slope)))


def test_a_piece_that_grows_is_told_from_where_it_begins() -> None:
    """exp(1000 (t - 5)) at t = 0 is exp(-5000); its factor at zero could not be told."""
    terms = terms_of(sp.exp(1000 * (T - 5)), sp.Integer(5))
    assert terms == ((1000.0, (1.0,)),)
    signal = known_signal(sp.Heaviside(T - 5) * sp.exp(-1000 * (T - 5)), 0.0, 10.0)
    assert signal(5.001) == pytest.approx(math.exp(-1), rel=1e-11)
    assert signal(4.0) == 0.0


@pytest.mark.parametrize("text", SMOOTH)
def test_other_expressions_are_polynomials_exact_to_rounding(text: str) -> None:
    expr = sp.sympify(text)
    assert terms_of(expr) is None
    signal = known_signal(expr, 0.0, 10.0)
    random = np.random.default_rng(5)
    # Inside each piece, too, and not only somewhere.
    ends = np.array([0.0, *signal.breakpoints, 10.0])
    chosen = random.integers(0, len(ends) - 1, 60)
    times = (ends[chosen] + random.uniform(0, 1, 60) * (ends[chosen + 1] - ends[chosen])).tolist()
    expected = [_value(expr, t) for t in times]
    slopes = [abs(_value(sp.diff(expr, T), t)) for t in times]
    # The time itself is known to a rounding of 1e-15 s there.
    rounding = 2e-14 * max(map(abs, expected)) + 4e-15 * max(slopes)
    assert [signal(t) for t in times] == pytest.approx(expected, abs=rounding)


@pytest.mark.parametrize("function", FUNCTIONS, ids=str)
def test_discs_hold_what_functions_are_over_them(function: type) -> None:
    """Values of analytic functions on and in a disc of time, by mpmath."""
    random = np.random.default_rng(7)
    centres, radii = random.uniform(-0.9, 0.9, 40), 10 ** random.uniform(-3, 0, 40)
    if function in (sp.log, sp.cot, sp.csc):
        centres = centres + 1
    expr = sp.Function("f")(T).replace(sp.Function("f"), function)
    with np.errstate(all="ignore"):
        value, off = disc_of(expr, centres, radii)
    called = sp.lambdify(T, expr, "mpmath")
    assert np.isfinite(off).sum() > 10
    for c, r, v, bound in zip(centres, radii, value, off, strict=True):
        if not math.isfinite(bound):
            continue
        for angle in np.linspace(0, 2 * np.pi, 12):
            there = complex(called(mpmath.mpc(c + r * cmath.exp(1j * angle))))
            assert abs(there - v) <= bound * (1 + 1e-12) + 1e-15, (c, r)


def test_what_is_no_longer_analytic_has_no_bound() -> None:
    with np.errstate(all="ignore"):
        for text in ("1/t", "log(t)", "sqrt(t)", "tan(t + pi/2)", "atan(t/1e9 + 1e9*t)"):
            _, off = disc_of(sp.sympify(text), np.array([0.5]), np.array([0.51]))
            assert not math.isfinite(off[0]), text


CORNERED = [
    ("abs(sin(t))", [k * math.pi for k in range(1, 4)]),
    ("Max(0, sin(t))", [k * math.pi for k in range(1, 4)]),
    ("sign(sin(pi*t))", list(range(1, 10))),
    ("floor(t/2) + Mod(t, 3)", [2, 3, 4, 6, 8, 9]),
    ("frac(t) - ceiling(t)", list(range(1, 10))),
    ("Piecewise((1, t < 1), (exp(1 - t), t < 3), (t, True))", [1, 3]),
    ("Piecewise((1, (t > 2) & (t < 5/2)), (0, True))", [2, 2.5]),
    ("Min(t, 5, 8 - t)", [4]),
    ("Heaviside(t - 5)*abs(t - 7)", [5, 7]),
    ("abs(abs(t - 5) - 1)", [4, 5, 6]),
    ("abs(1 + cos(t))", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "corners"), CORNERED)
def test_corners_and_jumps_are_breakpoints(text: str, corners: list[float]) -> None:
    expr = sp.sympify(text)
    assert known(expr)
    signal = known_signal(expr, 0.0, 10.0)
    real = [b for b in signal.breakpoints if b not in signal.seams]
    assert [b for b in real if not any(abs(b - c) < 1e-9 for c in corners)] == []
    assert [c for c in corners if not any(abs(b - c) < 1e-13 * (1 + c) for b in real)] == []
    at = sp.lambdify(T, expr, "numpy")
    for t in np.random.default_rng(2).uniform(0, 10, 60).tolist():
        assert signal(t) == pytest.approx(float(at(t)), abs=1e-13)


def test_a_corner_at_the_seam_of_two_polynomials_is_one() -> None:
    """sin(3 pi t) is zero at t = 1, 2, 3, where polynomials meet: rounding may hide it in neither."""
    expr = sp.sin(3 * sp.pi * T) * (2 + sp.sin(T**2))
    assert crossings(expr, 0.1, 4.1) == pytest.approx([k / 3 for k in range(1, 13)], abs=1e-14)


@pytest.mark.parametrize("text", ["sin(t**2)", "sqrt(1 + sin(t))*sign(cos(t))", "abs(sin(t))"])
def test_pieces_do_not_depend_on_how_long_a_run_is(text: str) -> None:
    short, long = (known_signal(sp.sympify(text), 0.0, end) for end in (7.5, 77.7))
    known_so_far = [b for b in long.breakpoints if b < 7.5]
    assert short.breakpoints == pytest.approx(known_so_far, abs=1e-12)
    for t in np.linspace(0, 7.49, 50).tolist():
        assert short(t) == pytest.approx(long(t), abs=1e-14)


def test_where_there_is_no_value_the_time_is_told() -> None:
    with pytest.raises(
        bg.SimulationError, match=r"known source log\(t - 5\) has no finite real value"
    ):
        known_signal(sp.log(T - 5), 0.0, 4.0)


def test_a_root_at_the_end_of_a_part_has_a_value() -> None:
    signal = known_signal(sp.sqrt(sp.Abs(sp.sin(T))), 0.5, 7.0)
    assert signal(math.pi + 1e-3) == pytest.approx(math.sqrt(math.sin(1e-3)), rel=1e-12)
    assert signal(math.pi) < 1e-5


def test_a_functions_pace_is_that_of_its_polynomials() -> None:
    quick = known_signal(sp.sin(100 * T + sp.sin(T)), 0.0, 1.0)
    assert all(20 < piece.fastest < 2000 for piece in quick.pieces)
    assert Piece(0.0, ((0.0, (1.0,)),)).fastest == 0.0

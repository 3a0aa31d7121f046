"""Sums of polynomials times exponentials: evaluated, shifted, collected, differentiated, lagged."""

import cmath

import numpy as np
import pytest

from codegen.inputs.pieces import Piece, Term, collected, constant_piece, lagged_terms, moved

TIMES = (0.3, 0.7, 1.9)


def _random_terms(rng: np.random.Generator) -> tuple[Term, ...]:
    """Real and complex rates of moderate size, polynomials up to the third power."""
    rates = [0, complex(-rng.uniform(0.1, 4)), complex(rng.uniform(-2, 1), rng.uniform(-9, 9))]
    return tuple(
        (rate, tuple(complex(*rng.normal(size=2)) for _ in range(rng.integers(1, 5))))
        for rate in rates
    )


def _value(terms: tuple[Term, ...], tau: float) -> float:
    parts = [cmath.exp(r * tau) * sum(c * tau**k for k, c in enumerate(p)) for r, p in terms]
    return sum(parts).real


@pytest.fixture(params=range(12))
def piece(request: pytest.FixtureRequest) -> Piece:
    rng = np.random.default_rng(request.param)
    return Piece(float(rng.normal()), _random_terms(rng))


def test_value_is_that_of_the_formula(piece: Piece) -> None:
    for t in TIMES:
        assert piece(t) == pytest.approx(_value(piece.terms, t - piece.start), rel=1e-12, abs=1e-12)


def test_a_moved_piece_is_the_same_function(piece: Piece) -> None:
    other = moved(piece, piece.start + 0.83)
    assert other.start == piece.start + 0.83
    for t in TIMES:
        assert other(t) == pytest.approx(piece(t), rel=1e-11, abs=1e-11)
    assert moved(piece, piece.start) is piece


def test_derivative_by_a_complex_free_difference(piece: Piece) -> None:
    h = 1e-3
    for t in TIMES:
        # Richardson on central differences; rates to 10/s leave h^4 w^5 / 30, about 1e-8 relative.
        wide, close = ((piece(t + d) - piece(t - d)) / (2 * d) for d in (h, h / 2))
        scale = max(abs(piece(t)), 1.0) * 1e3
        assert piece.derivative(t) == pytest.approx((4 * close - wide) / 3, abs=1e-9 * scale)


def test_collecting_changes_no_value(piece: Piece) -> None:
    terms = (*piece.terms, *piece.terms[:2], (0, (1.0, 2.0, 3.0, 4.0, 5.0)))
    once = collected(terms)
    assert len({rate for rate, _ in once}) == len(once) == 3
    for t in TIMES:
        expected = _value(terms, t - piece.start)
        assert Piece(piece.start, once)(t) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("T", [0.05, 0.5, 3.0])
def test_lagged_terms_solve_the_equation_of_the_lag(piece: Piece, T: float) -> None:
    """``T y' + y`` is the driving piece again."""
    answer = Piece(piece.start, lagged_terms(piece, T))
    for t in TIMES:
        driven = T * answer.derivative(t) + answer(t)
        assert driven == pytest.approx(piece(t), rel=1e-10, abs=1e-10)


@pytest.mark.parametrize("power", [0, 1, 2])
def test_a_lag_driven_at_its_own_rate_answers_with_a_higher_power(power: int) -> None:
    T = 0.25
    driving = Piece(0.0, ((complex(-1 / T), tuple([0j] * power + [1 + 0j])),))
    answer = Piece(0.0, lagged_terms(driving, T))
    for t in TIMES:
        expected = t ** (power + 1) / (T * (power + 1)) * np.exp(-t / T)
        assert answer(t) == pytest.approx(expected, rel=1e-13)


def test_fastest_is_the_largest_rate() -> None:
    assert Piece(0.0, ((0, (1.0,)), (-3 + 0j, (1.0,)), (4j, (1.0,)))).fastest == 4.0
    assert constant_piece(0.0, 2.0).fastest == 0.0
    assert Piece(0.0, ()).fastest == 0.0


@pytest.mark.parametrize(
    ("piece", "t"),
    [
        (Piece(0.3, ((0, (1.3, -13.0)),)), 0.4),
        (Piece(0.0, ((2j * np.pi, (-1j,)),)), 0.5),
        (Piece(0.0, ((0, (1.0,)), (-1.0 + 0j, (-np.exp(2.0 / 3.0),)))), 2.0 / 3.0),
        # A double near 1e4 is off by 1e-12, and so this ramp by 1e-10, which its terms are 1e8 of.
        (Piece(1e4 + 0.1, ((0, (0.1, -100.0)),)), 1e4 + 0.101),
    ],
)  # fmt: skip
def test_where_terms_cancel_their_rounding_is_zero(piece: Piece, t: float) -> None:
    assert piece(t) == 0.0
    assert piece.values(np.array([t, t + 0.01])).tolist()[0] == 0.0
    moved_off = 1e-9 * max(1.0, t)
    assert abs(piece(t + moved_off)) > 1e-10
    assert piece.values(np.array([t + moved_off]))[0] == pytest.approx(piece(t + moved_off))

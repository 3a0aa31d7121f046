"""Decisions modulo a large prime."""

import pytest
import sympy as sp

from bondgraph.algebra.residues import PRIME, is_rational_function, is_zero, residues

a, b, h, x = sp.symbols("a b h x")


def test_the_modulus_is_a_prime() -> None:
    assert sp.isprime(PRIME)


def test_residues_follow_the_rules_of_arithmetic() -> None:
    value = residues()
    assert value(sp.Rational(1, 3)) * 3 % PRIME == 1
    assert value(a + b) == (value(a) + value(b)) % PRIME
    assert value(a * b) == value(a) * value(b) % PRIME
    assert value(a**-2) * value(a) ** 2 % PRIME == 1
    assert value(-a) == PRIME - value(a)


def test_equal_seeds_give_equal_residues_and_others_do_not() -> None:
    assert residues(3)(a) == residues(3)(a)
    assert residues(3)(a) != residues(4)(a)
    assert residues()(a) != residues()(b)
    assert residues()(a) != residues()(sp.Symbol("a", positive=True))


def test_division_by_zero_is_an_error() -> None:
    with pytest.raises(ZeroDivisionError, match="denominator vanishes"):
        residues()(1 / ((a + b) ** 2 - a**2 - 2 * a * b - b**2))


@pytest.mark.parametrize(
    "zero",
    [
        sp.Integer(0),
        (a + b) ** 2 - a**2 - 2 * a * b - b**2,
        h / (h - 1) - 1 - 1 / (h - 1),
        (a**3 - b**3) / (a - b) - a**2 - a * b - b**2,
        sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1,
        sp.sqrt(2) * sp.sqrt(3) - sp.sqrt(6),
    ],
)
def test_what_vanishes_is_zero(zero: sp.Expr) -> None:
    assert is_zero(zero)


@pytest.mark.parametrize(
    "other",
    [a, a - b, sp.Integer(PRIME) * a + 1, (a + b) ** 2 - a**2 - b**2, sp.sin(x) ** 2 - 1, h - 2],
)
def test_what_does_not_vanish_is_not_zero(other: sp.Expr) -> None:
    assert not is_zero(other)


def test_rational_functions_are_told_from_others() -> None:
    assert all(map(is_rational_function, (sp.Rational(1, 2), a, (a + b) ** 3 / (a - 2))))
    assert not any(map(is_rational_function, (sp.sin(a), sp.sqrt(a), a**b, sp.pi * a)))


w = sp.sqrt(2)
IDENTITIES = [
    (w + 1) * (w - 1) - 1,
    (1 + w + sp.sqrt(3)) * (1 + w - sp.sqrt(3)) - 2 * w,
    sp.sqrt(a) * sp.sqrt(a) * b - a * b,
    a ** sp.Rational(3, 2) / a - sp.sqrt(a),
    sp.sqrt(sp.Rational(2, 3)) - sp.sqrt(6) / 3,
    sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1,
    sp.tan(x) * sp.cos(x) - sp.sin(x),
    sp.sin(2 * x) - 2 * sp.sin(x) * sp.cos(x),
    sp.cos(x / 2) ** 2 - (1 + sp.cos(x)) / 2,
    sp.sin(3 * x) - 3 * sp.sin(x) + 4 * sp.sin(x) ** 3,
    sp.sin(a + b) - sp.sin(a) * sp.cos(b) - sp.cos(a) * sp.sin(b),
    sp.cosh(x) ** 2 - sp.sinh(x) ** 2 - 1,
    sp.tanh(x) * sp.cosh(x) - sp.sinh(x),
    sp.exp(a) * sp.exp(b) - sp.exp(a + b),
    sp.cosh(x) - (sp.exp(x) + sp.exp(-x)) / 2,
    sp.sinh(x) - (sp.exp(x) - sp.exp(-x)) / 2,
    sp.exp(2 * a) - sp.exp(a) ** 2,
]


@pytest.mark.parametrize("identity", IDENTITIES, ids=str)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_residues_keep_identities_of_roots_and_functions(identity: sp.Expr, seed: int) -> None:
    assert residues(seed)(identity) == 0


@pytest.mark.parametrize("number", [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 30, 31, 12, 899])
def test_residues_keep_the_roots_of_small_primes_and_their_products(number: int) -> None:
    root = sp.sqrt(number)
    assert residues()((1 + root) ** 2 - 1 - number - 2 * root) == 0


@pytest.mark.parametrize(
    "other",
    [
        w - sp.sqrt(3),
        w + sp.sqrt(3) - sp.sqrt(10),
        sp.sqrt(a) - a,
        sp.sqrt(a + b) - sp.sqrt(a) - sp.sqrt(b),
        sp.sin(x) - x,
        sp.sin(x) - sp.cos(x),
        sp.sin(x) ** 2 - sp.cos(x) ** 2 - 1,
        sp.exp(a * b) - sp.exp(a + b),
        sp.Abs(x) - x,
        sp.sin(1) - sp.sin(2),
    ],
    ids=str,
)
def test_residues_tell_what_is_not_an_identity(other: sp.Expr) -> None:
    assert residues()(other) != 0

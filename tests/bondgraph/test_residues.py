"""Decisions modulo a large prime."""

import random

import pytest
import sympy as sp

from bondgraph.elimination import ResidueRows
from bondgraph.residues import PRIME, is_rational_function, is_zero, residues

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


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("jordan", [True, False])
def test_pivots_are_found_up_to_the_rank(seed: int, jordan: bool) -> None:
    """Against sympy's rank; small entries keep ranks equal modulo the prime."""
    rng = random.Random(seed)
    matrix = sp.Matrix(5, 6, lambda i, j: rng.choice([0, 0, 0, 1, -1, 2]))
    rows = ResidueRows(
        {j: int(matrix[i, j]) % PRIME for j in range(6) if matrix[i, j]} for i in range(5)
    )
    found = [column for column in range(6) if rows.pivot(column, jordan)]
    assert len(found) == matrix.rank()
    assert tuple(found) == matrix.rref()[1]

"""Exact linear algebra on small systems of expressions."""

import random

import pytest
import sympy as sp
from sympy.polys.matrices import DomainMatrix

from bondgraph.algebra.exact import (
    SingularError,
    add_scaled,
    cancelled,
    matrix_of,
    rows_of,
    solve,
)

a, b, c, x = sp.symbols("a b c x")
one = sp.Integer(1)


def test_two_equations_by_cramers_rule() -> None:
    (first, second) = solve([{0: a, 1: b}, {0: b, 1: c}], [{0: one}, {1: one}])
    determinant = a * c - b**2
    for got, expected in (
        (first[0], c / determinant), (first[1], -b / determinant),
        (second[0], -b / determinant), (second[1], a / determinant),
    ):  # fmt: skip
        assert sp.cancel(got - expected) == 0


@pytest.mark.parametrize("seed", range(20))
def test_solution_solves(seed: int) -> None:
    """The product of a matrix and its solution is the right side, exactly."""
    rng = random.Random(seed)
    size = rng.randint(1, 3)
    entries = [0, 0, 1, -2, sp.Rational(1, 3), a, b, a + b, 1 / c, a * b]
    matrix = sp.Matrix(size, size, lambda i, j: rng.choice(entries) + (c if i == j else 0))
    right = sp.Matrix(size, 3, lambda i, j: rng.choice(entries))
    if sp.cancel(matrix.det(method="berkowitz")) == 0:
        return
    rows = solve(rows_of(matrix), rows_of(right))
    given, solution, wanted = (_fractions(m) for m in (matrix, matrix_of(rows, 3), right))
    assert given * solution == wanted


def _fractions(matrix: sp.MatrixBase) -> DomainMatrix:
    """Its entries as fractions of polynomials, in lowest terms."""
    field = sp.QQ.frac_field(a, b, c)
    rows = [[field.from_sympy(entry) for entry in row] for row in matrix.tolist()]
    return DomainMatrix(rows, matrix.shape, field)


def test_algebraic_numbers_are_exact() -> None:
    """With w = sqrt(2): (w, 1; 1, w)^-1 = (w, -1; -1, w)."""
    w = sp.sqrt(2)
    assert solve([{0: w, 1: one}, {0: one, 1: w}], [{0: one}, {1: one}]) == [
        {0: w, 1: -one},
        {0: -one, 1: w},
    ]


@pytest.mark.parametrize(
    "matrix",
    [
        [{}],
        [{0: a}, {0: b}],
        [{0: a, 1: b}, {0: a * c, 1: b * c}],
        [{0: sp.sqrt(2), 1: sp.Integer(2)}, {0: one, 1: sp.sqrt(2)}],
    ],
)
def test_singular_matrix_is_refused(matrix: list) -> None:
    with pytest.raises(SingularError):
        solve(matrix, [{0: one}] * len(matrix))


def test_columns_keep_their_numbers() -> None:
    assert solve([{0: a}], [{7: b}]) == [{7: b / a}]
    assert solve([{0: a}], [{}]) == [{}]


def test_entries_that_cancel_are_dropped() -> None:
    row = {0: a, 1: b}
    add_scaled(row, {0: one, 1: b, 2: x}, -a)
    assert set(row) == {1, 2}
    assert sp.expand(row[1] - b + a * b) == 0
    row = {0: (a + b) ** 2}
    add_scaled(row, {0: a**2 + 2 * a * b + b**2}, -one)
    assert row == {}


def test_cancelling_finds_zero_and_common_factors() -> None:
    assert cancelled(a - a * (b + 1) / (b + 1)) == 0
    assert cancelled(a / (a + b) + b / (a + b)) == 1
    assert cancelled(x) is x


def test_cancelling_finds_zero_in_long_entries() -> None:
    product = sp.prod(a + k * b + (k + 1) * c for k in range(12))
    zero = product - sp.expand(product)
    assert zero.count_ops() > 200
    assert cancelled(zero) == 0
    assert cancelled(zero + 1) != 0


def test_matrix_of_rows_and_back() -> None:
    rows = [{2: a}, {}, {0: b, 1: c}]
    matrix = matrix_of(rows, 3)
    assert matrix == sp.Matrix([[0, 0, a], [0, 0, 0], [b, c, 0]])
    assert rows_of(matrix) == rows
    with pytest.raises(TypeError, match=r"does not support item assignment|Cannot set"):
        matrix[0, 0] = one

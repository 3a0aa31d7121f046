"""Sparse elimination modulo a prime."""

import random

import pytest
import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.residues import PRIME


def _matrix(seed: int) -> sp.Matrix:
    """Small entries, so that ranks are equal modulo the prime."""
    rng = random.Random(seed)
    return sp.Matrix(5, 6, lambda i, j: rng.choice([0, 0, 0, 1, -1, 2]))


def _rows(matrix: sp.Matrix) -> ResidueRows:
    return ResidueRows(
        {j: int(row[j]) % PRIME for j in range(matrix.cols) if row[j]}
        for row in (matrix.row(i) for i in range(matrix.rows))
    )


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("jordan", [True, False])
def test_pivots_are_found_up_to_the_rank(seed: int, jordan: bool) -> None:
    """The independent columns from left to right, as in the reduced echelon form."""
    matrix = _matrix(seed)
    rows = _rows(matrix)
    found = [column for column in range(6) if rows.pivot(column, jordan)]
    assert len(found) == matrix.rank()
    assert tuple(found) == matrix.rref()[1]


@pytest.mark.parametrize("seed", range(20))
def test_dependent_column_meets_the_pivots_that_it_depends_on(seed: int) -> None:
    matrix = _matrix(seed)
    rows, (echelon, pivots) = _rows(matrix), matrix.rref()
    for column in range(6):
        if not rows.pivot(column):
            above = [pivots[row] for row in range(len(pivots)) if echelon[row, column] != 0]
            assert sorted(rows.pivots_meeting(column)) == above

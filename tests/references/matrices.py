"""Exact comparisons of symbolic matrices, and numbers from them."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt
import sympy as sp

Number = int | float | complex | Fraction | sp.Expr


def differences(matrix: Any, expected: Any) -> dict[tuple[int, int], sp.Expr]:
    """The entries in which two matrices of one shape differ, as ``matrix - expected`` in lowest terms."""
    expected = sp.Matrix(expected)
    if matrix.shape != expected.shape:
        raise ValueError(f"shapes {matrix.shape} and {expected.shape} differ")
    entries = (sp.SparseMatrix(matrix) - sp.SparseMatrix(expected)).todok()
    found = {place: sp.cancel(sp.expand(entry)) for place, entry in entries.items()}
    return {place: entry for place, entry in found.items() if entry != 0}


def numbers(matrix: Any, values: Mapping[str, float]) -> npt.NDArray[np.complex128]:
    """The matrix in complex numbers, symbols replaced by values of their names."""
    result = np.zeros(matrix.shape, dtype=complex)
    replace = {sp.Symbol(name): sp.Float(value) for name, value in values.items()}
    for place, entry in matrix.todok().items():
        result[place] = complex(entry.xreplace(replace))
    return result


def rationals(matrix: Any, values: Mapping[str, Fraction]) -> sp.Matrix:
    """The matrix in exact rationals."""
    replace = {
        sp.Symbol(name): sp.Rational(value.numerator, value.denominator)
        for name, value in values.items()
    }
    return sp.Matrix(matrix).xreplace(replace)


def leading_minors(matrix: sp.Matrix) -> list[sp.Expr]:
    """The determinants of the leading blocks, for Sylvester's criterion."""
    return [matrix[:n, :n].det(method="bareiss") for n in range(1, matrix.rows + 1)]

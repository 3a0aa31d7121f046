"""Equations over more inputs than they had, each with the columns of others, with factors, or with none."""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import fixed
from bondgraph.equations import StateEquations
from bondgraph.reduce.record import Reading

Copies = Mapping[int, Mapping[int, sp.Expr]]
"""Of inputs that are added, by their places, the columns that each has, with factors."""


def widened(
    equations: StateEquations, inputs: tuple[sp.Symbol, ...], copies: Copies,
    readings: Mapping[sp.Symbol, Reading],
) -> StateEquations:  # fmt: skip
    """The equations over these inputs, those that are added last, and with these readings over them."""
    reduction = equations.reduction
    columns = {k: spread(reading, copies) for k, reading in reduction.columns.items()}
    matrices = {
        letter: _wider(getattr(equations, letter), copies, len(inputs)) for letter in "BEDG"
    }
    return replace(
        equations, inputs=inputs, readings=MappingProxyType(dict(readings)), **matrices,
        reduction=replace(reduction, inputs=inputs, columns=MappingProxyType(columns)),
    )  # fmt: skip


def spread(row: Reading, copies: Copies) -> Reading:
    """A row with entries for the inputs that are added."""
    D, K = (_more(part, copies) for part in (row.D, row.K))
    return Reading(row.F, fixed(D), row.H, fixed(K))


def _wider(
    matrix: sp.ImmutableSparseMatrix, copies: Copies, width: int
) -> sp.ImmutableSparseMatrix:
    wider = sp.SparseMatrix(matrix.rows, width, dict(matrix.todok()))
    for new, parts in copies.items():
        for i in range(matrix.rows):
            wider[i, new] = sp.Add(*(factor * matrix[i, old] for old, factor in parts.items()))
    return sp.ImmutableSparseMatrix(wider)


def _more(part: Mapping[int, sp.Expr], copies: Copies) -> dict[int, sp.Expr]:
    result = dict(part)
    for new, own in copies.items():
        total = sp.Add(*(factor * part[old] for old, factor in own.items() if old in part))
        if total != 0:
            result[new] = total
    return result

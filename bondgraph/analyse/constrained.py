"""States whose slips are held at zero: which remain, and the balances that holding efforts miss."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, add_scaled, fixed
from bondgraph.algebra.residues import is_zero
from bondgraph.reduce.record import Reading


@dataclass(frozen=True)
class Rows:
    """A by rows, the right sides of ``A x' =``, and outputs, over states and inputs."""

    states: tuple[sp.Symbol, ...]
    A: tuple[FixedRow, ...]
    balances: tuple[Reading, ...]
    outputs: tuple[Reading, ...]


def locked(
    model: Rows, slips: Sequence[FixedRow], held: Sequence[int], order: Sequence[int]
) -> Rows:
    """The model with slips at zero: ``x = T x_r``, and the balances along what is left free.

    ``held``: the columns of the efforts that hold them; ``order``: see `without_slips`.
    """
    reduced = without_slips(slips, order)
    T, kept = reduced.T, reduced.kept
    efforts = [{j: e for j, e in row.D.items() if j in held} for row in model.balances]
    N = transposed(T, len(kept))
    if any(multiplied(row, efforts) for row in N):
        numbered = [{held.index(j): e for j, e in row.items()} for row in efforts]
        N = left_annihilator(transposed(numbered, len(held)), len(T))
    A = tuple(fixed(multiplied(multiplied(row, model.A), T)) for row in N)
    F, D, K = ([getattr(row, part) for row in model.balances] for part in "FDK")
    balances = tuple(
        Reading(multiplied(multiplied(row, F), T), multiplied(row, D), {}, multiplied(row, K))
        for row in N
    )
    outputs = tuple(
        Reading(multiplied(y.F, T), y.D, multiplied(y.H, T), y.K) for y in model.outputs
    )
    return Rows(tuple(model.states[j] for j in kept), A, balances, outputs)


@dataclass(frozen=True)
class Reduced:
    """States that remain when slips are held at zero: ``x = T x_r``, ``T`` by rows."""

    kept: tuple[int, ...]
    T: tuple[FixedRow, ...]


def without_slips(slips: Sequence[FixedRow], order: Sequence[int]) -> Reduced:
    """Solve ``F_s x = 0`` for as many states as there are independent slips, in that order of states.

    >>> [dict(row) for row in without_slips([{0: sp.Integer(1), 1: -sp.Integer(2)}], [0, 1]).T]
    [{0: 2}, {0: 1}]
    """
    matrix = sp.zeros(len(slips), len(order))
    for i, row in enumerate(slips):
        for at, j in enumerate(order):
            matrix[i, at] = row.get(j, 0)
    reduced, pivots = echelon(matrix)
    gone = {order[pivot]: i for i, pivot in enumerate(pivots)}
    kept = tuple(j for j in range(len(order)) if j not in gone)
    place = {j: at for at, j in enumerate(kept)}
    T: list[Row] = [{place[j]: sp.Integer(1)} if j in place else {} for j in range(len(order))]
    for j, i in gone.items():
        entries = {at: reduced[i, order.index(k)] for k, at in place.items()}
        T[j] = {at: -entry for at, entry in entries.items() if entry != 0}
    return Reduced(kept, tuple(map(fixed, T)))


def left_annihilator(columns: Sequence[Row], size: int) -> list[Row]:
    """Independent rows N with ``N columns = 0``; columns given sparse, of that size.

    >>> left_annihilator([{0: sp.Integer(2), 1: -sp.Integer(1)}], 2)
    [{0: 1/2, 1: 1}]
    """
    matrix = sp.zeros(len(columns), size)
    for i, column in enumerate(columns):
        for j, entry in column.items():
            matrix[i, j] = entry
    return [
        {j: entry for j, entry in enumerate(vector) if entry != 0}
        for vector in matrix.nullspace(simplify=sp.cancel, iszerofunc=is_zero)
    ]


def echelon(matrix: sp.Matrix) -> tuple[sp.Matrix, tuple[int, ...]]:
    """The reduced echelon form and its pivots, zeros decided exactly."""
    reduced, pivots = matrix.rref(simplify=sp.cancel, iszerofunc=is_zero)
    return reduced, tuple(pivots)


def multiplied(row: FixedRow, T: Sequence[FixedRow]) -> Row:
    """``row * T``."""
    result: Row = {}
    for j, entry in row.items():
        add_scaled(result, T[j], entry)
    return result


def transposed(rows: Sequence[FixedRow], columns: int) -> list[Row]:
    """The columns of sparse rows, sparse."""
    result: list[Row] = [{} for _ in range(columns)]
    for i, row in enumerate(rows):
        for j, entry in row.items():
            result[j][i] = entry
    return result

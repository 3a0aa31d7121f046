"""States whose slips are held at zero: which remain, and the balances that holding efforts miss."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, SingularError, add_scaled, fixed
from bondgraph.algebra.residues import is_zero
from bondgraph.errors import DependentSourceError, SignalError
from bondgraph.reduce.record import Reading, ReadingSum


@dataclass(frozen=True)
class Rows:
    """A by rows, the right sides of ``A x' =``, and outputs, over states and inputs."""

    states: tuple[sp.Symbol, ...]
    A: tuple[FixedRow, ...]
    balances: tuple[Reading, ...]
    outputs: tuple[Reading, ...]


def locked(
    model: Rows, slips: Sequence[Reading], held: Sequence[int], order: Sequence[int], ports: str
) -> Rows:
    """The model with slips at zero: ``x = T x_r + S v``, and the balances along what is left free.

    ``slips``: ``F x + D v``; ``held``: the columns of what holds them; ``order``: of the states
    those go first that it has first; ``ports``: what holds them, for people.

    Raises `DependentSourceError` for a slip that only sources rule and for one that rates rule,
    `SignalError` for an output that shows what several ports hold together.
    """
    _check_held(model, slips, held, ports)
    T, S, kept = _without(slips, order, ports)
    efforts = [{held.index(j): e for j, e in row.D.items() if j in held} for row in model.balances]
    N = left_annihilator(transposed(efforts, len(held)), len(T))
    if len(N) != len(kept):
        raise DependentSourceError(
            f"what is given at {ports} does not hold what is received there; leave one of them free"
        )
    symmetric = transposed(T, len(kept))
    if not any(multiplied(row, efforts) for row in symmetric):
        N = symmetric
    A, balances = _along(model, N, T, S)
    try:
        outputs = tuple(_shown(model, y, efforts, held, T, S) for y in model.outputs)
    except SingularError:
        raise SignalError(
            f"an output shows what one of {ports} gives, which hold together and share it as their limits "
            "tell; name fewer of them"
        ) from None
    return Rows(tuple(model.states[j] for j in kept), A, balances, outputs)


def _check_held(model: Rows, slips: Sequence[Reading], held: Sequence[int], ports: str) -> None:
    """Refuse rows with rates in them, and ports whose rates would be needed to hold them."""
    if any(slip.H or slip.K for slip in slips):
        raise DependentSourceError(
            f"what is to be held at {ports} depends on rates; a mode holds what states and inputs rule"
        )
    if any(j in held for row in (*model.balances, *model.outputs) for j in row.K):
        raise DependentSourceError(
            f"of {ports} one drives a dependent storage and is to be held; put a storage that can be "
            "independent beside it"
        )


def _along(
    model: Rows, N: Sequence[FixedRow], T: Sequence[FixedRow], S: Sequence[FixedRow]
) -> tuple[tuple[FixedRow, ...], tuple[Reading, ...]]:
    """``N A (T x_r' + S v') = N (J (T x_r + S v) + B v + E v')``."""
    F, D, K = ([getattr(row, part) for row in model.balances] for part in "FDK")
    A, balances = [], []
    for row in N:
        inertia, forces = multiplied(row, model.A), multiplied(row, F)
        inputs, rates = multiplied(row, D), multiplied(row, K)
        add_scaled(inputs, multiplied(forces, S), sp.Integer(1))
        add_scaled(rates, multiplied(inertia, S), -sp.Integer(1))
        A.append(fixed(multiplied(inertia, T)))
        balances.append(Reading(multiplied(forces, T), inputs, {}, rates))
    return tuple(A), tuple(balances)


def _shown(
    model: Rows, y: Reading, efforts: Sequence[FixedRow], held: Sequence[int],
    T: Sequence[FixedRow], S: Sequence[FixedRow],
) -> Reading:  # fmt: skip
    """An output over the states that are left; what holds ports is what the balances lack of ``A x'``."""
    total = ReadingSum(y)
    wanted = {held.index(j): entry for j, entry in y.D.items() if j in held}
    for i, weight in _weights(efforts, wanted, len(held)).items():
        row = model.balances[i]
        total.add(Reading({}, {}, model.A[i], {}), weight)
        total.add(Reading(row.F, row.D, {}, row.K), -weight)
    D = {j: entry for j, entry in total.D.items() if j not in held}
    K = dict(total.K)
    add_scaled(D, multiplied(total.F, S), sp.Integer(1))
    add_scaled(K, multiplied(total.H, S), sp.Integer(1))
    return Reading(multiplied(total.F, T), D, multiplied(total.H, T), K)


def _weights(efforts: Sequence[FixedRow], wanted: FixedRow, count: int) -> Row:
    """w with ``w efforts = wanted``: which balances tell what an output shows of what holds ports."""
    if not wanted:
        return {}
    matrix = sp.zeros(count, len(efforts) + 1)
    for i, row in enumerate(efforts):
        for j, entry in row.items():
            matrix[j, i] = entry
    for j, entry in wanted.items():
        matrix[j, len(efforts)] = entry
    reduced, pivots = echelon(matrix)
    if len(efforts) in pivots:
        raise SingularError
    return {i: reduced[at, len(efforts)] for at, i in enumerate(pivots)}


def _without(
    slips: Sequence[Reading], order: Sequence[int], ports: str
) -> tuple[tuple[FixedRow, ...], tuple[FixedRow, ...], tuple[int, ...]]:
    """``F x + D v = 0`` as ``x = T x_r + S v`` by rows, and the states that are left, in their own order."""
    inputs = sorted({j for slip in slips for j in slip.D})
    matrix = sp.zeros(len(slips), len(order) + len(inputs))
    for i, slip in enumerate(slips):
        for at, j in enumerate(order):
            matrix[i, at] = slip.F.get(j, 0)
        for at, j in enumerate(inputs, start=len(order)):
            matrix[i, at] = slip.D.get(j, 0)
    reduced, pivots = echelon(matrix)
    if any(pivot >= len(order) for pivot in pivots):
        raise DependentSourceError(
            f"inputs alone rule what is to be held at {ports}, so that no port can hold it; leave one of "
            "them free, or put a storage between"
        )
    gone = {order[pivot]: i for i, pivot in enumerate(pivots)}
    kept = tuple(j for j in range(len(order)) if j not in gone)
    place = {j: at for at, j in enumerate(kept)}
    T: list[Row] = [{place[j]: sp.Integer(1)} if j in place else {} for j in range(len(order))]
    S: list[Row] = [{} for _ in order]
    for j, i in gone.items():
        entries = {place[k]: reduced[i, at] for at, k in enumerate(order) if k in place}
        T[j] = {at: -entry for at, entry in entries.items() if entry != 0}
        driven = {k: reduced[i, at] for at, k in enumerate(inputs, start=len(order))}
        S[j] = {k: -entry for k, entry in driven.items() if entry != 0}
    return tuple(map(fixed, T)), tuple(map(fixed, S)), kept


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

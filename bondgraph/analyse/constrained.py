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


@dataclass(frozen=True)
class TiedStates:
    """``x = T x_r + S v`` by rows, and how fast T and S change; x_r are the states ``kept``."""

    T: tuple[FixedRow, ...]
    S: tuple[FixedRow, ...]
    T_rate: tuple[FixedRow, ...]
    S_rate: tuple[FixedRow, ...]
    kept: tuple[int, ...]


def locked(
    model: Rows, slips: Sequence[Reading], bends: Sequence[Reading], held: Sequence[int],
    order: Sequence[int], ports: str,
) -> Rows:  # fmt: skip
    """The model with slips at zero: ``x = T x_r + S v``, and the balances along what is left free.

    ``slips``: ``F x + D v``; ``bends``: how fast their coefficients change, none if they do not;
    ``held``: the columns of what holds them; ``order``: of the states
    those go first that it has first; ``ports``: what holds them, for people.

    Raises `DependentSourceError` for a slip that only sources rule and for one that rates rule,
    `SignalError` for an output that shows what several ports hold together.
    """
    _check_held(model, slips, held, ports)
    tied = _without(slips, bends, order, ports)
    T, kept = tied.T, tied.kept
    efforts = [{held.index(j): e for j, e in row.D.items() if j in held} for row in model.balances]
    N = left_annihilator(transposed(efforts, len(held)), len(T))
    if len(N) != len(kept):
        raise DependentSourceError(
            f"what is given at {ports} does not hold what is received there; leave one of them free"
        )
    symmetric = transposed(T, len(kept))
    if not any(multiplied(row, efforts) for row in symmetric):
        N = symmetric
    A, balances = _along(model, N, tied)
    try:
        outputs = tuple(_shown(model, y, efforts, held, tied) for y in model.outputs)
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
    model: Rows, N: Sequence[FixedRow], tied: TiedStates
) -> tuple[tuple[FixedRow, ...], tuple[Reading, ...]]:
    """``N A (T x_r' + S v' + T' x_r + S' v) = N (J (T x_r + S v) + B v + E v')``."""
    F, D, K = ([getattr(row, part) for row in model.balances] for part in "FDK")
    A, balances = [], []
    for row in N:
        inertia, forces = multiplied(row, model.A), multiplied(row, F)
        inputs, rates = multiplied(row, D), multiplied(row, K)
        add_scaled(inputs, multiplied(forces, tied.S), sp.Integer(1))
        add_scaled(inputs, multiplied(inertia, tied.S_rate), -sp.Integer(1))
        add_scaled(rates, multiplied(inertia, tied.S), -sp.Integer(1))
        A.append(fixed(multiplied(inertia, tied.T)))
        states = multiplied(forces, tied.T)
        add_scaled(states, multiplied(inertia, tied.T_rate), -sp.Integer(1))
        balances.append(Reading(states, inputs, {}, rates))
    return tuple(A), tuple(balances)


def _shown(
    model: Rows, y: Reading, efforts: Sequence[FixedRow], held: Sequence[int], tied: TiedStates
) -> Reading:
    """An output over the states that are left; what holds ports is what the balances lack of ``A x'``."""
    total = ReadingSum(y)
    wanted = {held.index(j): entry for j, entry in y.D.items() if j in held}
    for i, weight in _weights(efforts, wanted, len(held)).items():
        row = model.balances[i]
        total.add(Reading({}, {}, model.A[i], {}), weight)
        total.add(Reading(row.F, row.D, {}, row.K), -weight)
    D = {j: entry for j, entry in total.D.items() if j not in held}
    K = dict(total.K)
    add_scaled(D, multiplied(total.F, tied.S), sp.Integer(1))
    add_scaled(D, multiplied(total.H, tied.S_rate), sp.Integer(1))
    add_scaled(K, multiplied(total.H, tied.S), sp.Integer(1))
    F = multiplied(total.F, tied.T)
    add_scaled(F, multiplied(total.H, tied.T_rate), sp.Integer(1))
    return Reading(F, D, multiplied(total.H, tied.T), K)


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
    slips: Sequence[Reading], bends: Sequence[Reading], order: Sequence[int], ports: str
) -> TiedStates:
    """``F x + D v = 0`` as ``x = T x_r + S v`` by rows, and the states that are left, in their own order."""
    inputs, count = sorted({j for slip in slips for j in slip.D}), len(order)
    width = count + len(inputs)
    # Beside the rows what they are combined of, for their bends.
    matrix = sp.zeros(len(slips), width + len(bends))
    for i, slip in enumerate(slips):
        for at, j in enumerate(order):
            matrix[i, at] = slip.F.get(j, 0)
        for at, j in enumerate(inputs, start=count):
            matrix[i, at] = slip.D.get(j, 0)
        if bends:
            matrix[i, width + i] = 1
    reduced, pivots = echelon(matrix)
    if any(count <= pivot < width for pivot in pivots):
        raise DependentSourceError(
            f"inputs alone rule what is to be held at {ports}, so that no port can hold it; leave one of "
            "them free, or put a storage between"
        )
    gone = {order[pivot]: i for i, pivot in enumerate(pivots) if pivot < count}
    kept = tuple(j for j in range(count) if j not in gone)
    place = {j: at for at, j in enumerate(kept)}
    T: list[Row] = [{place[j]: sp.Integer(1)} if j in place else {} for j in range(count)]
    S: list[Row] = [{} for _ in order]
    for j, i in gone.items():
        entries = {place[k]: reduced[i, at] for at, k in enumerate(order) if k in place}
        T[j] = {at: -entry for at, entry in entries.items() if entry != 0}
        driven = {k: reduced[i, at] for at, k in enumerate(inputs, start=count)}
        S[j] = {k: -entry for k, entry in driven.items() if entry != 0}
    T_rate, S_rate = [Row() for _ in order], [Row() for _ in order]
    for j, i in gone.items():
        for at, bend in enumerate(bends):
            factor = -reduced[i, width + at]
            add_scaled(T_rate[j], multiplied(bend.F, T), factor)
            add_scaled(S_rate[j], multiplied(bend.F, S), factor)
            add_scaled(S_rate[j], bend.D, factor)
    T_all, S_all, T_late, S_late = (tuple(map(fixed, part)) for part in (T, S, T_rate, S_rate))
    return TiedStates(T_all, S_all, T_late, S_late, kept)


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

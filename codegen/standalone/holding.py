"""What holds ports that stick: linear equations for their efforts, of ranks decided exactly.

For the sticking ports s, ``y_s = F_s x + D_s u = 0``. Rows of D_ss that are independent determine
efforts at once (a resistance lies beside the port). Along the left null space N of D_ss the
constraint rules the states instead: ``N^T y_s' = 0``, that is ``N^T F_s A^-1 (J x + B u) + ... =
0``. What neither determines is how redundant ports share a load; and where other inputs rule such
a combination of slips, a source or a law, the ports stick only while it is zero and stays so.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, HoldError, Places
from codegen.standalone.instant import Instant
from codegen.standalone.matrices import Numbers, scaled_solve, scales
from codegen.standalone.sharing import fair_share
from codegen.tuning import TUNING


@dataclass(frozen=True)
class HeldSet:
    """Ranks of one set of sticking ports; numbers are positions within the set.

    ``moved``: the inputs of laws that the ports' efforts move, which answer at once as their own
    inputs do. ``direct``: rows of D that are independent over what answers, in ``direct_columns``,
    and so determine efforts at once. ``null``: the other ports, each of which leads a combination
    of slips that no effort moves at once. ``kept``: those combinations, by position in ``null``,
    that are independent in the states, in ``kept_columns``. ``ruled``: whether other inputs,
    sources or laws, rule a combination that is none of these, and alone let the set hold.
    """

    moved: tuple[int, ...]
    direct: tuple[int, ...]
    direct_columns: tuple[int, ...]
    null: tuple[int, ...]
    kept: tuple[int, ...]
    kept_columns: tuple[int, ...]
    ruled: bool


def plain_set(count: int) -> HeldSet:
    """So many ports whose slips all bind the states, each by itself."""
    every = tuple(range(count))
    return HeldSet((), (), (), every, every, (), False)


@dataclass(frozen=True)
class Hold:
    """The holding equations ``X x + U u + V u' = 0`` of one set of sticking ports.

    ``inputs``: what they give. ``share``: combinations of slips that are none; ``ways``: directions
    in which the holding efforts may change without moving anything, the same where ports act as
    they are acted on. ``ruled``: those combinations where other inputs rule
    them: the ports hold only while these are zero. ``slip_x``, ``slip_u``: the slips that constrain
    the states, independent, as ``slip_x x + slip_u u``; ``fixed``: how their rates beside those of
    s depend on u'. ``take_away``: what to add to x per unit of those slips to remove them, along
    ``A^-1 F^T``, or what the efforts move. ``mix``: what those slips are of the ports' own;
    ``free``: directions, by columns, in which efforts may be impulses, as they change no slip at
    once.
    """

    ports: Places
    inputs: Places
    X: Array
    U: Array
    V: Array
    #: Inverse of the square system for the efforts, the rows of ``share`` appended.
    inverse: Array
    share: Array
    ways: Array
    ruled: Array
    slip_x: Array
    slip_u: Array
    fixed: Array
    take_away: Array
    mix: Array
    free: Array

    @property
    def shares(self) -> bool:
        """Whether redundant ports share a load; one that nothing can load gives nothing."""
        return bool(np.count_nonzero(self.share.any(axis=0)) > len(self.share))

    @cached_property
    def magnitudes(self) -> tuple[Array, Array, Array, Array]:
        """Those of X, U, V and of what takes these to efforts."""
        inverse = self.inverse[:, : len(self.X)]
        return np.abs(self.X), np.abs(self.U), np.abs(self.V), np.abs(inverse)

    def efforts(self, now: Instant, sharing: bool = True) -> Array:
        """The holding efforts; u must be zero at the sticking ports. Redundant ports share."""
        known = self.rule(now)
        efforts: Array
        if not len(self.share):
            efforts = self.inverse @ -known
            return efforts
        efforts = self.inverse @ np.concatenate([-known, np.zeros(len(self.share))])
        return fair_share(efforts, self.ways, now.caps[self.ports]) if sharing else efforts

    def rule(self, now: Instant) -> Array:
        """What has to vanish while the ports hold."""
        left: Array = self.X @ now.x + self.U @ now.u + self.V @ now.du
        return left

    def slips(self, x: Array, u: Array) -> Array:
        """The slips that constrain the states."""
        return np.asarray(self.slip_x @ x + self.slip_u @ u, dtype=float)

    def correction(self, rate: Array, du: Array) -> Array:
        """What must be added to the rates of x, or by rounding slips that stick would drift."""
        added: Array = self.take_away @ (self.slip_x @ rate + self.fixed @ du)
        return added


def hold(
    held: HeldSet,
    ports: Sequence[int],
    inputs: Places,
    rows: Places,
    received: Places,
    moving: Places,
    numbers: Numbers,
    varying: bool,
    exact: bool,
) -> Hold:
    """The holding equations of ports of these, which give these inputs and receive these rows of y.

    ``received``: the same as the graph has them, whose ranks count. ``moving``: the rows that tell
    how fast those change by their factors, -1 where not.
    ``varying``: whether x itself is integrated. ``exact``: whether these are the numbers for which
    the ranks were decided. Raises `HoldError` where they have others, `EvaluationError` where there
    are no unique efforts.
    """
    stuck = np.array(ports, dtype=np.intp)
    chosen = inputs[stuck]
    F, D, G = (matrix[rows[stuck]] for matrix in (numbers.F, numbers.D, numbers.G))
    plain = numbers.F[received[stuck]]
    on = moving[stuck]
    moved = [np.where(on[:, None] >= 0, m[on], 0.0) for m in (numbers.F, numbers.D, numbers.G)]
    answers, kept, direct = D[:, [*chosen, *held.moved]], list(held.kept), list(held.direct)
    free = [k for k in range(len(held.null)) if k not in held.kept]
    try:
        null = vanishing(answers, held.direct, held.direct_columns, held.null)
        seen = null @ plain
        share = vanishing(seen, held.kept, held.kept_columns, free)
    except np.linalg.LinAlgError:
        raise HoldError from None
    if not exact:
        sizes = np.abs(answers), np.abs(null) @ np.abs(plain)
        _check(
            ((null, answers, sizes[0]), (share, seen, sizes[1])),
            (answers[direct], seen[kept] * scales(numbers.A)),
        )
    slip_x, slip_u, share = null[kept] @ F, null[kept] @ D, share @ null
    by_x, by_u, by_rates = (null[kept] @ matrix for matrix in moved)
    U = np.vstack([D[direct], slip_x @ numbers.Q + by_u])
    # Where laws answer as well, all are searched for together.
    inverse = np.zeros((0, 0)) if held.moved else _inverse(np.vstack([U[:, chosen], share]))
    return Hold(
        stuck,
        chosen,
        X=np.vstack([F[direct], slip_x @ numbers.P + by_x]),
        U=U,
        V=np.vstack([G[direct], slip_x @ numbers.R + slip_u + by_rates]),
        inverse=inverse,
        share=share,
        ways=_ways(U[:, chosen], share, inverse),
        ruled=share if held.ruled else share[:0],
        slip_x=slip_x,
        slip_u=slip_u,
        fixed=slip_u if varying else slip_u + slip_x @ numbers.R,
        take_away=_take_away(numbers, slip_x, numbers.Q[:, [] if direct else chosen]),
        mix=null[kept],
        free=_free(answers, held, len(stuck)),
    )


def _check(dependent: Iterable[tuple[Array, Array, Array]], independent: Iterable[Array]) -> None:
    """Refuse combinations of rows that are not zero, and rows that are not independent.

    Third of what depends stands how large the terms are that make up the rows.
    """
    for sums, matrix, sizes in dependent:
        left, terms = np.abs(sums @ matrix), np.abs(sums) @ sizes
        if (left > TUNING.consistent * terms).any():
            raise HoldError
    for rows in independent:
        lengths = np.linalg.norm(rows, axis=1, keepdims=True)
        left = np.linalg.svd(rows / np.where(lengths > 0, lengths, 1.0), compute_uv=False)
        if len(left) < len(rows) or (left <= TUNING.nothing).any():
            raise HoldError


def vanishing(
    matrix: Array, independent: Sequence[int], columns: Sequence[int], others: Sequence[int]
) -> Array:
    """For each other row the combination, led by it, of it and the independent ones that is zero.

    The independent ones are so in ``columns``.

    >>> vanishing(np.array([[1.0, 2.0], [3.0, 6.0]]), [0], [0], [1])
    array([[-3.,  1.]])
    """
    result = np.zeros((len(others), len(matrix)))
    result[np.arange(len(others)), list(others)] = 1.0
    if len(independent) and len(others):
        square = matrix[np.ix_(independent, columns)]
        factors = np.linalg.solve(square.T, matrix[np.ix_(others, columns)].T).T
        result[:, list(independent)] = -factors
    return result


def _ways(answers: Array, share: Array, inverse: Array) -> Array:
    """Directions in which efforts move nothing: combinations of slips, unless factors are others.

    The jump of a law acts with another factor than what it hangs on has.
    """
    moved, sizes = np.abs(answers @ share.T), np.abs(answers) @ np.abs(share.T)
    if not len(inverse) or not (moved > TUNING.consistent * sizes).any():
        return share
    return np.asarray(inverse[:, len(answers) :].T)


def _free(answers: Array, held: HeldSet, count: int) -> Array:
    """The right null space of ``D_ss`` as it is over the ports' own inputs, by columns.

    Where a law would have to answer with an impulse of its own, there is no such direction.
    """
    rows, columns = list(held.direct), list(held.direct_columns)
    result = []
    for column in (c for c in range(count) if c not in columns):
        way = np.eye(1, answers.shape[1], column)[0]
        if rows:
            way[columns] = -np.linalg.solve(answers[np.ix_(rows, columns)], answers[rows, column])
        if not way[count:].any():
            result.append(way[:count])
    return np.array(result).reshape(-1, count).T


def _take_away(numbers: Numbers, slip_x: Array, pushed: Array) -> Array:
    """``-A^-1 S^T (S A^-1 S^T)^-1``: the impulse that stops the slips S x and moves no others.

    ``pushed``: what impulses of the ports move, by columns; that is another where ports do not act
    as they are acted on, as those of jumps: then such impulses stop the slips.
    """
    if not len(slip_x):
        return np.zeros((slip_x.shape[1], 0))
    moved = scaled_solve(numbers.A, slip_x.T)
    found = np.asarray(-moved @ _inverse(slip_x @ moved), dtype=float)
    by = slip_x @ pushed
    beside, sizes = np.abs(pushed + found @ by), np.abs(pushed) + np.abs(found) @ np.abs(by)
    square = by @ by.T
    aside = bool((beside > TUNING.consistent * sizes).any())
    if not aside or np.linalg.matrix_rank(square) < len(square):
        return found
    return np.asarray(-pushed @ by.T @ _inverse(square), dtype=float)


def _inverse(matrix: Array) -> Array:
    try:
        return np.asarray(np.linalg.inv(matrix), dtype=float)
    except np.linalg.LinAlgError:
        raise EvaluationError(
            "sticking ports have no unique holding efforts: the storages or laws behind them "
            "cancel; check the signs of their values"
        ) from None

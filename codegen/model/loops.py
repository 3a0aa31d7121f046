"""Laws that determine one another at one instant: a bounded search for their common solution."""

from collections.abc import Callable, Hashable, Iterator, Sequence

import numpy as np
import scipy.optimize

from bondgraph.errors import SimulationError
from codegen.model.instant import Instant
from codegen.numbers.arrays import Array
from codegen.numbers.roots import root
from codegen.tuning import TUNING

ITERATIONS = 60

Residual = Callable[[Array], Array]


def solve_loop(
    now: Instant,
    columns: Sequence[int],
    rows: Sequence[int],
    D: Array,
    residual: Callable[[Instant], Array],
    names: Sequence[Hashable],
) -> None:
    """Find the inputs at ``columns`` for which ``residual`` vanishes, and complete the instant.

    ``rows``: what the laws' ports receive. Raises `SimulationError`, naming the ports, if no solution
    is found.
    """
    u, y = now.u.copy(), now.y.copy()

    def left(values: Array) -> Array:
        now.u[:], now.y[:] = u, y
        now.give(columns, values, D)
        return np.nan_to_num(
            residual(now), nan=TUNING.huge, posinf=TUNING.huge, neginf=-TUNING.huge
        )

    values, worst = searched(left, D[np.ix_(rows, columns)], y[list(rows)])
    if values is not None:
        return
    listed = ", ".join(repr(name) for name in names)
    raise SimulationError(
        f"at t = {now.t:g} the laws at {listed} depend on one another and no solution was found "
        f"(residual {worst:.3g}); check the laws, or put a storage between"
    )


def searched(left: Residual, D: Array, open_y: Array) -> tuple[Array | None, float]:
    """The solution that is found, the latest that ``left`` was asked for; and what is left of the laws.

    ``open_y``: what the ports receive if the laws give nothing, ``D`` what they receive of each more.
    """
    worst = np.inf
    for values in _attempts(left, D, open_y):
        worst = float(np.abs(left(values)).max(initial=0.0))
        if worst <= TUNING.residual * (
            TUNING.residual_floor + float(np.abs(values).max(initial=0.0))
        ):
            return values, worst
    return None, worst


def _attempts(left: Residual, D: Array, open_y: Array) -> Iterator[Array]:
    """Candidate solutions, the surest way first.

    ``open_y`` is what the ports would receive if the laws gave nothing. A law that dissipates has its
    solution between there and where its port receives nothing: that bounds a single law, and is where
    Newton's iteration starts for several.
    """
    size = len(open_y)
    nothing_received: Array = np.zeros(size)
    if np.linalg.matrix_rank(D) == size:
        nothing_received = np.asarray(np.linalg.solve(D, -open_y), dtype=float)
    if size == 1:
        yield from _bracketed(left, nothing_received[0])
    for start in (nothing_received, np.zeros(size)):
        yield _newton(left, start)
        yield scipy.optimize.root(left, start, method="hybr", tol=TUNING.searched).x


def _bracketed(left: Residual, end: float) -> Iterator[Array]:
    """The root of a single law between giving nothing and receiving nothing, if the signs differ."""

    def one(value: float) -> float:
        return float(left(np.array([value]))[0])

    if one(0.0) * one(end) <= 0 and end:
        yield np.array([root(one, 0.0, end)])


def _newton(left: Residual, values: Array) -> Array:
    """Newton's iteration with differences for slopes; a step that does not help is halved."""
    now = left(values)
    for _ in range(ITERATIONS):
        if not now.any():
            return values
        slopes = np.empty((len(values), len(values)))
        for j in range(len(values)):
            step = TUNING.loop_difference * (abs(values[j]) + TUNING.loop_floor)
            moved = values.copy()
            moved[j] += step
            slopes[:, j] = (left(moved) - now) / step
        try:
            change = np.linalg.solve(slopes, -now)
        except np.linalg.LinAlgError:
            return values
        size = float(np.abs(now).max())
        for _ in range(ITERATIONS):
            tried = left(values + change)
            if np.abs(tried).max() < size:
                break
            change = change / 2
            if (values + change == values).all():
                # Rounding is reached: other steps give what is known.
                return values
        else:
            return values
        values, now = values + change, tried
    return values

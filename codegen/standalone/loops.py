"""Laws that determine one another at one instant: a bounded search for their common solution."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError
from codegen.standalone.evaluation import Laws
from codegen.standalone.instant import Instant
from codegen.standalone.roots import root
from codegen.tuning import TUNING

ITERATIONS = 60

Residual = Callable[[Array], Array]

Partial = Callable[[Array, float], Array]
"""The same where ports receive only a part of what comes to them from outside the laws."""

Search = Callable[[Residual, Array], Array]
"""From a function and a start to where the function may vanish."""


@dataclass
class Loop(Laws):
    """Laws that determine one another, or one that determines itself."""

    rescue: Search | None = None

    def close(self, now: Instant) -> None:
        """Find what they give together at an instant."""
        self.solve(now, lambda: now.u[self.inputs] - self.formula(now))

    def solve(self, now: Instant, left: Callable[[], Array]) -> None:
        """Find the inputs for which ``left()`` vanishes, and complete the instant.

        Raises `EvaluationError`, naming the ports, if no solution is found.
        """
        u, y = now.u.copy(), now.y.copy()

        def residual(amounts: Array, part: float = 1.0) -> Array:
            now.u[:], now.y[:] = u, y
            now.y[self.readings] *= part
            now.give(self.inputs, amounts)
            found = left()
            if np.isfinite(found).all():
                return found
            return np.nan_to_num(found, nan=1e300, posinf=1e300, neginf=-1e300)

        D = now.numbers.D[np.ix_(self.readings, self.inputs)]
        found, worst = searched(residual, D, y[self.readings], self.rescue, residual)
        if found is None:
            listed = ", ".join(repr(name) for name in self.names)
            raise EvaluationError(
                f"at t = {now.t:g} the laws at {listed} depend on one another and no solution was "
                f"found (residual {worst:.3g}); check the laws, or put a storage between"
            )


def searched(
    residual: Residual,
    D: Array,
    open_y: Array,
    rescue: Search | None = None,
    partial: Partial | None = None,
) -> tuple[Array | None, float]:
    """The solution that is found, the latest that was asked for; and what is left of the laws.

    ``open_y``: what the ports receive if the laws give nothing, ``D`` what they receive of each
    more. ``rescue``: a search to try where Newton's finds nothing; ``partial``: for the
    last way, by parts.
    """
    worst = np.inf
    for amounts in _attempts(residual, D, open_y, rescue):
        worst = float(np.abs(residual(amounts)).max(initial=0.0))
        if _solves(worst, amounts):
            return amounts, worst
    # A single law that rises is bracketed, or has no solution.
    if partial is None or len(open_y) == 1:
        return None, worst
    return _by_parts(partial, len(open_y)), worst


def _solves(worst: float, amounts: Array) -> bool:
    return worst <= TUNING.residual * (
        TUNING.residual_floor + float(np.abs(amounts).max(initial=0.0))
    )


def _by_parts(partial: Partial, size: int) -> Array | None:
    """From ports that receive nothing from outside to those that receive all, part by part.

    Laws that rise have one solution for each part, which moves with it without a leap: along
    the line through the last two it is near enough to the next, where parts are small enough.
    None where no part that counts is.
    """
    amounts, way = np.zeros(size), np.zeros(size)
    part, more, to = 0.0, 1.0, 0.0
    for _ in range(TUNING.portions):

        def left(tried: Array, to: float = to) -> Array:
            return partial(tried, to)

        tried = _newton(left, amounts + (to - part) * way)
        if _solves(float(np.abs(left(tried)).max(initial=0.0)), tried):
            if to == 1.0:
                return tried
            if to > part:
                way, more = (tried - amounts) / (to - part), 2 * more
            amounts, part = tried, to
        else:
            more /= 4
        to = min(part + more, 1.0)
        if more < TUNING.least_portion:
            break
    return None


def _attempts(
    residual: Residual, D: Array, open_y: Array, rescue: Search | None
) -> Iterator[Array]:
    """Candidate solutions, the surest way first.

    A law that dissipates has its solution between giving nothing and where its port receives
    nothing: that bounds a single law, and is where Newton's iteration starts for several.
    """
    size = len(open_y)
    nothing_received: Array = np.zeros(size)
    if np.linalg.matrix_rank(D) == size:
        nothing_received = np.asarray(np.linalg.solve(D, -open_y), dtype=float)
    if size == 1:
        yield from _bracketed(residual, nothing_received[0])
    for start in (nothing_received, np.zeros(size)):
        yield _newton(residual, start)
        if rescue is not None:
            yield rescue(residual, start)


def _bracketed(residual: Residual, end: float) -> Iterator[Array]:
    """The root of a single law between giving and receiving nothing, if the signs differ."""

    def one(amount: float) -> float:
        return float(residual(np.array([amount]))[0])

    if one(0.0) * one(end) <= 0 and end:
        yield np.array([root(one, 0.0, end)])


def _slope(residual: Residual, amounts: Array, now: Array, j: int, size: float) -> Array:
    """How what is left, ``now``, changes with one amount, by a step that rounding does not lose."""
    step = TUNING.loop_difference * (abs(amounts[j]) + TUNING.loop_floor)
    while True:
        moved = amounts.copy()
        moved[j] += step
        change = residual(moved) - now
        if step >= size or np.abs(change).max() > TUNING.loop_lost * size:
            return np.asarray(change / step)
        step *= TUNING.loop_wider


def _newton(residual: Residual, amounts: Array) -> Array:
    """Newton's iteration with differences for slopes; a step that does not help is halved."""
    now = residual(amounts)
    for _ in range(ITERATIONS):
        if not now.any():
            return amounts
        slopes = np.empty((len(amounts), len(amounts)))
        size = float(np.abs(now).max())
        for j in range(len(amounts)):
            slopes[:, j] = _slope(residual, amounts, now, j, size)
        try:
            change = np.linalg.solve(slopes, -now)
        except np.linalg.LinAlgError:
            return amounts
        for _ in range(ITERATIONS):
            tried = residual(amounts + change)
            if np.abs(tried).max() < size:
                break
            change = change / 2
            if (amounts + change == amounts).all():
                # Rounding is reached: other steps give what is known.
                return amounts
        else:
            return amounts
        amounts, now = amounts + change, tried
    return amounts

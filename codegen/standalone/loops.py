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

        def residual(amounts: Array) -> Array:
            now.u[:], now.y[:] = u, y
            now.give(self.inputs, amounts)
            found = left()
            if np.isfinite(found).all():
                return found
            return np.nan_to_num(found, nan=1e300, posinf=1e300, neginf=-1e300)

        D = now.numbers.D[np.ix_(self.readings, self.inputs)]
        found, worst = searched(residual, D, y[self.readings], self.rescue)
        if found is None:
            listed = ", ".join(repr(name) for name in self.names)
            raise EvaluationError(
                f"at t = {now.t:g} the laws at {listed} depend on one another and no solution was "
                f"found (residual {worst:.3g}); check the laws, or put a storage between"
            )


def searched(
    residual: Residual, D: Array, open_y: Array, rescue: Search | None = None
) -> tuple[Array | None, float]:
    """The solution that is found, the latest that was asked for; and what is left of the laws.

    ``open_y``: what the ports receive if the laws give nothing, ``D`` what they receive of each
    more. ``rescue``: a search to try where Newton's finds nothing.
    """
    worst = np.inf
    for amounts in _attempts(residual, D, open_y, rescue):
        worst = float(np.abs(residual(amounts)).max(initial=0.0))
        if worst <= TUNING.residual * (
            TUNING.residual_floor + float(np.abs(amounts).max(initial=0.0))
        ):
            return amounts, worst
    return None, worst


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


def _newton(residual: Residual, amounts: Array) -> Array:
    """Newton's iteration with differences for slopes; a step that does not help is halved."""
    now = residual(amounts)
    for _ in range(ITERATIONS):
        if not now.any():
            return amounts
        slopes = np.empty((len(amounts), len(amounts)))
        for j in range(len(amounts)):
            step = TUNING.loop_difference * (abs(amounts[j]) + TUNING.loop_floor)
            moved = amounts.copy()
            moved[j] += step
            slopes[:, j] = (residual(moved) - now) / step
        try:
            change = np.linalg.solve(slopes, -now)
        except np.linalg.LinAlgError:
            return amounts
        size = float(np.abs(now).max())
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

"""Laws that determine one another at one instant: a bounded search for their common solution."""

from collections.abc import Callable, Hashable, Sequence

import numpy as np
import scipy.optimize

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.instant import Instant

RESIDUAL = 1e-9
"""A solution must satisfy its laws to this fraction of their magnitude."""


def solve_loop(
    now: Instant,
    columns: Sequence[int],
    D: Array,
    residual: Callable[[Instant], Array],
    names: Sequence[Hashable],
) -> None:
    """Find the inputs at ``columns`` for which ``residual`` vanishes, and complete the instant.

    Raises `SimulationError`, naming the ports, if none is found.
    """
    u, y = now.u.copy(), now.y.copy()

    def left(values: Array) -> Array:
        now.u[:], now.y[:] = u, y
        now.give(columns, values, D)
        return residual(now)

    start = np.zeros(len(columns))
    scale = 1.0 + float(np.abs(left(start)).max(initial=0.0))
    worst = np.inf
    for method in ("hybr", "lm"):
        found = scipy.optimize.root(left, start, method=method, tol=1e-13)
        worst = float(np.abs(left(found.x)).max(initial=0.0))
        if worst <= RESIDUAL * (scale + float(np.abs(found.x).max(initial=0.0))):
            return
    listed = ", ".join(repr(name) for name in names)
    raise SimulationError(
        f"at t = {now.t:g} the laws at {listed} depend on one another and no solution was found "
        f"(residual {worst:.3g}); check the laws, or put a storage between"
    )

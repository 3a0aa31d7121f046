"""Whole runs of all bond equations as they are written: Radau's three stages, no equation solved for a rate.

Unknown at each stage are all efforts and flows; what is held follows from what flows in. A step counts where
it agrees with two of half its length; the halves are kept. (E. Hairer, G. Wanner, Solving Ordinary
Differential Equations II, 1996, IV.5 and VII.4.)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.linalg

from .judge import Judge

Array = np.ndarray
ROOT = np.sqrt(6.0)
NODES = np.array([(4 - ROOT) / 10, (4 + ROOT) / 10, 1.0])
A = np.array([
    [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
    [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
    [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
])  # fmt: skip
TURNS, SHORTEST = 12, 1e-9
"""Newton's steps at most, and the step [s] over a jump of flows, whatever it is off there."""


class Stuck(Exception):
    """No step, however short, has a solution or the accuracy that is asked for."""


def followed(
    judge: Judge, times: Sequence[float], z: Array, tolerance: float, steps: int = 1
) -> Array:
    """All unknowns at these times, from consistent ones at the first; a row for each.

    ``tolerance``: what one step may be off, of 1 + the magnitude of each unknown that is held. ``steps``: at
    least so many are made, so that none goes over what two corners have between them.

    Raises `Stuck`.
    """
    rows, t, h = [z], times[0], (times[-1] - times[0]) / 64
    most = (times[-1] - times[0]) / steps
    for end in times[1:]:
        while t < end:
            step = min(h, end - t, most)
            whole, first = stages(judge, t, z, step), stages(judge, t, z, step / 2)
            second = None if first is None else stages(judge, t + step / 2, first, step / 2)
            if whole is None or second is None:
                h = step / 4
            else:
                n = judge.held
                off = np.abs(second[:n] - whole[:n]) / (1 + np.abs(second[:n]))
                error = float(off.max(initial=0.0)) / tolerance
                factor = min(4.0, max(0.2, 0.8 * max(error, 1e-12) ** -0.25))
                if error <= 1 or step <= SHORTEST:
                    t = end if step == end - t else t + step
                    z = second
                    h = max(h, step * factor) if factor > 1 and step < h else step * factor
                else:
                    h = max(step * factor, SHORTEST)
            if h < SHORTEST / 2:
                raise Stuck(f"at t = {t:g}")
        rows.append(z)
    return np.array(rows)


def stages(judge: Judge, t: float, z: Array, h: float) -> Array | None:
    """The unknowns after one step, or None where Newton's steps find none."""
    n, m = judge.held, judge.size - judge.held
    held, flows = z[:n], judge.flows - n
    w, size, before = np.tile(z[n:], (3, 1)), 1 + np.abs(z).max(), np.inf
    factors = None
    for _ in range(TURNS):
        points = np.hstack([held + h * A @ w[:, flows], w])
        try:
            if factors is None:
                factors = scipy.linalg.lu_factor(_system(judge, t, points, h), check_finite=False)
            left = [judge.left(t + c * h, at) for c, at in zip(NODES, points, strict=True)]
        except (ValueError, OverflowError, ZeroDivisionError):
            return None
        change = scipy.linalg.lu_solve(factors, np.concatenate(left), check_finite=False)
        if not np.isfinite(change).all():
            return None
        w = w - change.reshape(3, m)
        moved = float(np.abs(change).max()) / size
        # Efforts of dependent storages are differences over the step.
        if moved < max(1e-12, 1e-15 / h):
            return np.append(held + h * A[2] @ w[:, flows], w[2])
        # Slopes are taken again where the iteration crawls.
        factors = None if moved > 0.05 * before or before == np.inf else factors
        before = moved
    return None


def _system(judge: Judge, t: float, points: Array, h: float) -> Array:
    """The slopes of all stages' equations along all stages' efforts and flows."""
    n, m = judge.held, judge.size - judge.held
    system = np.zeros((3 * m, 3 * m))
    for i in range(3):
        J = judge.slopes(t + NODES[i] * h, points[i])
        for j in range(3):
            block = system[i * m : (i + 1) * m, j * m : (j + 1) * m]
            for k, flow in enumerate(judge.flows - n):
                block[:, flow] += h * A[i, j] * J[:, k]
            if i == j:
                block += J[:, n:]
    return system

"""Masses with Coulomb friction by convex optimisation: no modes are enumerated anywhere.

With slips s = W v - d, efforts f of the ports within their levels L and forces p, M v' = p - W^T f.
Gauss's principle: f is the point of the box |f_i| <= L_i that makes |p - W^T f| least in the norm of
M^-1, ports that slip being held at L_i sign(s_i).
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.optimize import lsq_linear

Array = np.ndarray


def efforts_at_rest(M: Array, W: Array, p: Array, low: Array, high: Array, push: Array) -> Array:
    """Friction efforts between ``low`` and ``high`` at ports at rest; ``push``: d' of each."""
    root = np.linalg.cholesky(np.linalg.inv(M)).T
    G = root @ W.T
    # The slips' own imposed acceleration enters as a part of p along M W^T (W W^T)^-1.
    offset = np.linalg.lstsq(G.T, push, rcond=None)[0] if np.any(push) else 0.0
    fixed = high - low < 1e-14
    f = np.where(fixed, high, 0.0)
    free = np.flatnonzero(~fixed)
    if len(free):
        target = root @ (p - W.T @ f) - offset
        found = lsq_linear(G[:, free], target, (low[free], high[free]), method="bvls", tol=1e-15)
        f[free] = found.x
    return f


def piecewise_linear(
    M: Array,
    W: Array,
    levels: Array,
    forces: Callable[[float], Array],
    breaks: list[float],
    end: float,
) -> list[tuple[float, Array, Array]]:
    """Velocities from rest under forces that are constant between ``breaks``: (time, v, v') at each kink."""
    t, v, kinks = 0.0, np.zeros(len(M)), []
    while t < end:
        slips = W @ v
        moving = np.abs(slips) > 1e-10
        sign = np.sign(slips)
        low = np.where(moving, sign * levels, -levels)
        high = np.where(moving, sign * levels, levels)
        f = efforts_at_rest(M, W, forces(t), low, high, np.zeros(len(W)))
        a = np.linalg.solve(M, forces(t) - W.T @ f)
        kinks.append((t, v.copy(), a))
        rates = W @ a
        stops = [
            t - s / r
            for s, r, on in zip(slips, rates, moving, strict=True)
            if on and s * r < -1e-14
        ]
        after = min([b for b in breaks if b > t] + stops + [end])
        v, t = v + a * (after - t), after
        rest = np.abs(W @ v) < 1e-9
        if rest.any():
            v -= np.linalg.pinv(W[rest]) @ (W[rest] @ v)
    return kinks


def time_stepped(
    M: Array, K: Array, damping: Array, W: Array, levels: Callable[[float], Array],
    forces: Callable[[float], Array], start: tuple[Array, Array], times: Array, steps: int,
) -> Array:  # fmt: skip
    """Velocities at ``times`` of M v' + C v + K q = p - W^T f, q' = v, by implicit steps (Moreau 1988).

    f is in the box at every step, with f = L sign(W v) at the step's end: first-order convergence
    through any number of sticking and slipping instants. ``steps`` in each interval of ``times``.
    """
    q, v = (part.astype(float).copy() for part in start)
    result = [v.copy()]
    for t_0, t_1 in pairwise(times):
        h = (t_1 - t_0) / steps
        system = M + h * damping + h * h * K
        inverse = np.linalg.inv(system)
        delassus, f = h * W @ inverse @ W.T, np.zeros(len(W))
        for n in range(steps):
            t = t_0 + (n + 1) * h
            free = inverse @ (M @ v + h * (forces(t) - K @ q))
            f = _sweep(delassus, W @ free, levels(t), f)
            v = free - h * inverse @ (W.T @ f)
            q += h * v
        result.append(v.copy())
    return np.array(result)


def _sweep(delassus: Array, slips: Array, level: Array, f: Array) -> Array:
    """Projected Gauss-Seidel: each effort in turn brings its own slip to zero, as far as it may."""
    f = np.clip(f, -level, level)
    for _ in range(400):
        before = f.copy()
        for i in range(len(f)):
            wanted = f[i] + (slips[i] - delassus[i] @ f) / delassus[i, i]
            f[i] = min(max(wanted, -level[i]), level[i])
        if np.abs(f - before).max() <= 1e-13 * (1 + np.abs(level).max()):
            break
    return f

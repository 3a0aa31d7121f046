"""How redundant ports share a load, by linear programs in turn."""

import numpy as np
import scipy.linalg
import scipy.optimize

HARDLY = 1e-7
"""Beside sizes of one: what of an effort or a multiplier is none."""


def by_linear_programs(efforts: np.ndarray, share: np.ndarray, caps: np.ndarray) -> np.ndarray:
    """The least largest fraction of the caps; what has to carry it does; then the rest alike.

    Ports without a cap come before all others, each as large as another: what they cannot leave to
    others they share. What has to carry a fraction has a multiplier in the dual program, which one
    solver and one theorem tell (complementary slackness), not this project.
    """
    size = max(float(np.abs(efforts).max()), 1e-300)
    found, rows = np.array(efforts, dtype=float) / size, np.array(share, dtype=float)
    for chosen, limits in ((caps <= 0, np.ones(len(caps))), (caps > 0, caps)):
        known = ~chosen
        while len(rows) and not known.all():
            bounded = np.flatnonzero(~known)
            found, ruled = _least(found, rows, limits, bounded)
            known[ruled] = True
            rows = scipy.linalg.null_space(rows[:, ruled].T, rcond=1e-9).T @ rows
            rows[np.abs(rows) < 1e-9] = 0.0  # or rounding counts as a rank
    return found * size


def _least(
    efforts: np.ndarray, rows: np.ndarray, caps: np.ndarray, bounded: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Efforts of which the largest fraction is the least, and the ports that have to carry it."""
    moved = bounded[np.abs(rows[:, bounded]).max(axis=0) > 1e-9]
    if not len(moved):
        return efforts, bounded
    ways, limits = rows[:, moved].T, caps[moved, None]
    within = np.vstack([np.hstack([ways, -limits]), np.hstack([-ways, -limits])])
    right = np.concatenate([-efforts[moved], efforts[moved]])
    target = np.append(np.zeros(len(rows)), 1.0)
    best = scipy.optimize.linprog(target, within, right, bounds=[(None, None)] * len(target))
    assert best.status == 0, best.message
    forces = np.abs(best.ineqlin.marginals).reshape(2, -1).sum(axis=0) * caps[moved]
    ruled = moved[forces > HARDLY] if best.fun > HARDLY / caps.max() else moved
    return efforts + best.x[:-1] @ rows, ruled

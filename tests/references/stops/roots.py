"""Series of ``r . expm(A t) X`` and where they first fall through zero: no root is missed.

With the step the inverse of the spectral radius, the coefficients of the scaled time fall as 1/k!; all
roots of the polynomial are found at once, as eigenvalues of its companion matrix.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

from references.stops.line import Array

DEGREE = 22
ZERO = 1e-11
"""Of the magnitude of its terms, a coefficient is rounding."""


class Flow:
    """X' = A X over steps of ``step``."""

    def __init__(self, A: Array) -> None:
        self.A = A
        self.step = 1 / max(float(np.abs(np.linalg.eigvals(A)).max(initial=0.0)), 0.5)

    def at(self, t: float, X: Array) -> Array:
        """X after a time."""
        return np.asarray(expm(self.A * t) @ X)

    def series(self, rows: Array, X: Array, most: Array) -> Array:
        """Coefficients of rows of X in ``t / step``, one row each; what is rounding of ``most`` is zero."""
        term, size = X, most
        found = []
        for k in range(DEGREE + 1):
            values, sizes = rows @ term, np.abs(rows) @ size
            found.append(np.where(np.abs(values) <= ZERO * sizes, 0.0, values))
            term = self.A @ term * (self.step / (k + 1))
            size = np.abs(self.A) @ size * (self.step / (k + 1))
        return np.array(found).T


def sign(coefficients: Array) -> int:
    """Of the first coefficient that is not zero: which way it goes from here."""
    given = np.flatnonzero(coefficients)
    return int(np.sign(coefficients[given[0]])) if len(given) else 0


def first_fall(coefficients: Array) -> float | None:
    """The first root in (0, 1] of what is positive just after 0, else 0. Zeros at 0 are divided out."""
    given = np.flatnonzero(coefficients)
    if not len(given):
        return None
    c = coefficients[given[0] :]
    if c[0] < 0:
        return 0.0
    if c[0] > np.abs(c[1:]).sum():
        return None
    scale = np.abs(c).max()
    c = c[: np.flatnonzero(np.abs(c) > 1e-18 * scale)[-1] + 1]
    roots = np.roots(c[::-1])
    near = np.abs(roots.imag) < 1e-7
    candidates = np.sort(roots.real[near & (roots.real > 0) & (roots.real <= 1 + 1e-12)])
    for one in candidates:
        root = _polished(c, float(one))
        if 0 < root <= 1 and _slope(c, root) < 0:
            return root
    return None


def _polished(c: Array, root: float) -> float:
    """Newton's steps."""
    for _ in range(3):
        slope = _slope(c, root)
        if slope == 0:
            break
        root -= float(np.polynomial.polynomial.polyval(root, c)) / slope
    return root


def _slope(c: Array, at: float) -> float:
    return float(np.polynomial.polynomial.polyval(at, np.polynomial.polynomial.polyder(c)))

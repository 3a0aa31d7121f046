"""The equations' matrices in numbers, solved for the rates."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array


@dataclass(frozen=True)
class Numbers:
    """The equations in numbers, solved for the rates; n states, m inputs, p readings.

    x' = P x + Q u + R u'
     y = F x + D u + G u', of which H x' is put in
    """

    #: n x n, n x m, n x m: A^-1 J, A^-1 B, A^-1 E
    P: Array
    Q: Array
    R: Array
    #: n x n
    A: Array
    #: p x n, p x m, p x m
    F: Array
    D: Array
    G: Array
    #: p x n
    H: Array


def solved(
    A: Array, J: Array, B: Array, E: Array, F: Array, D: Array, H: Array, K: Array,
    solve: Callable[[Array, Array], Array] | None = None,
) -> Numbers:  # fmt: skip
    """``A x' = J x + B u + E u'``, ``y = F x + D u + H x' + K u'``, solved for the rates.

    ``solve``: what gives ``A^-1`` times another matrix, `scaled_solve` unless told. Raises
    `numpy.linalg.LinAlgError` where A has no inverse.
    """
    n, m = J.shape[1], B.shape[1]
    found = (solve or scaled_solve)(A, np.hstack([J, B, E]))
    P, Q, R = found[:, :n], found[:, n : n + m], found[:, n + m :]
    return Numbers(P, Q, R, A, F=F + H @ P, D=D + H @ Q, G=K + H @ R, H=H)


def scales(A: Array) -> Array:
    """Scales of rows and columns of A: storages may differ by many powers of ten."""
    found: Array = 1 / np.sqrt(np.abs(np.diag(A)))
    found[~np.isfinite(found)] = 1.0
    return found


def times(matrix: Array, values: Array) -> Array:
    """A matrix times values, of which zero entries take nothing though they be infinite.

    Infinite efforts have finite effects where laws bound these, as the affinity of what is used up.

    >>> with np.errstate(invalid="ignore"):
    ...     times(np.array([[0.0, 2.0]]), np.array([np.inf, 1.0]))
    array([2.])
    """
    found: Array = matrix @ values
    if found.dtype != float or math.isfinite(found.sum()):
        return found
    return np.asarray(np.where(matrix != 0, matrix * values, 0.0).sum(axis=1), dtype=float)


def scaled_solve(A: Array, right: Array) -> Array:
    """``A^-1 right``, with rows and columns scaled first."""
    scale = scales(A)
    found = np.linalg.solve(A * np.outer(scale, scale), scale[:, None] * right)
    return np.asarray(scale[:, None] * found, dtype=float)

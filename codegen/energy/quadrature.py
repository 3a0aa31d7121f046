"""Integrals of products of signals: over smooth steps by Gauss's formula, over affine stretches exactly.

Where ``z' = M z`` and signals are rows a, b over z, the integral of their product over h is ``z^T W(h) z``
with ``W(h) = int_0^h exp(M^T t) a^T b exp(M t) dt``. Over a short step that is Gauss's formula on the power
series; then ``W(2h) = W(h) + E(h)^T W(h) E(h)``, whatever the steps of the run were.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

POINTS = 8
"""Of Gauss's formula: exact to degree 15, twice that of any method's interpolant."""

_roots, _weights = np.polynomial.legendre.leggauss(POINTS)
NODES: Array = (_roots + 1) / 2
WEIGHTS: Array = _weights / 2

ROOM = 1 << 22
"""So many numbers are worked on at once."""


@dataclass(frozen=True)
class Rows:
    """Pairs of signals as rows over z, K x n each; ``norm``: a bound on |M| where it is balanced."""

    M: Array
    one: Array
    other: Array
    norm: float


def rows_over(M: Array, one: Array, other: Array) -> Rows:
    """Pairs of rows over the state of ``z' = M z``."""
    balanced = scipy.linalg.matrix_balance(M, permute=False)[0]
    norm = float(min(np.linalg.norm(balanced, 1), np.linalg.norm(balanced, np.inf)))
    return Rows(M, one, other, norm)


def exact_integrals(rows: Rows, z: Array, lengths: Array) -> Array:
    """The integral of each product over each interval, S x K: it begins at a row of z and is so long."""
    found = np.zeros((len(lengths), len(rows.one)))
    short = rows.norm * lengths <= 1.0
    width = max(1, ROOM // (POINTS * max(len(rows.one), 1)))
    at = np.flatnonzero(short)
    for begin in range(0, len(at), width):
        part = at[begin : begin + width]
        found[part] = _short(rows, z[part], lengths[part])
    left = np.flatnonzero(~short)
    while len(left):
        h = float(lengths[left[0]])
        alike = np.abs(lengths[left] - h) <= TUNING.one_length * h
        found[left[alike]] = _long(rows, z[left[alike]], h)
        left = left[~alike]
    return found


def gauss_sum(values: Array, length: float) -> Array:
    """The integral over a step of so many products, K x `POINTS`, told at its nodes."""
    return np.asarray(length * (values @ WEIGHTS), dtype=float)


def _short(rows: Rows, z: Array, lengths: Array) -> Array:
    """Steps of ``|M| h <= 1``, by the power series at Gauss's nodes."""
    terms = [z]
    for k in range(1, TUNING.degree + 1):
        terms.append((terms[-1] @ rows.M.T) * (lengths[:, None] / k))
    total = np.zeros((len(z), len(rows.one)))
    for node, weight in zip(NODES.tolist(), WEIGHTS.tolist(), strict=True):
        there = np.zeros_like(z)
        for term in reversed(terms):
            there = there * node + term
        total += weight * (there @ rows.one.T) * (there @ rows.other.T)
    return total * lengths[:, None]


def _long(rows: Rows, z: Array, h: float) -> Array:
    """Steps of one length of any size, some products at a time."""
    width = max(1, ROOM // z.shape[1] ** 2)
    parts = []
    for begin in range(0, len(rows.one), width):
        part = slice(begin, begin + width)
        W = _doubled(rows.M, rows.one[part], rows.other[part], rows.norm, h)
        parts.append(np.einsum("si,kis->sk", z, W @ z.T))
    return np.hstack(parts) if parts else np.zeros((len(z), 0))


def _doubled(M: Array, one: Array, other: Array, norm: float, h: float) -> Array:
    """W(h), K x n x n."""
    doublings = max(0, int(np.ceil(np.log2(norm * h))))
    step = h / 2**doublings
    growths = _growth(M * (step * np.append(NODES, 1.0))[:, None, None])
    moved = np.eye(len(M)) + growths[:-1]
    weighted = (WEIGHTS * step)[:, None, None] * (one @ moved)
    W: Array = np.einsum("pki,pkj->kij", weighted, other @ moved)
    # What exp(M h) adds to 1 is kept: slow parts are small beside it in every step.
    growth = growths[-1]
    for _ in range(doublings):
        W = W + _between(W, growth)
        growth = 2 * growth + growth @ growth
    return W


def _between(W: Array, growth: Array) -> Array:
    """``E^T W E`` for each W."""
    E = np.eye(len(growth)) + growth
    return np.asarray(E.T @ W @ E, dtype=float)


def _growth(B: Array) -> Array:
    """``exp(B) - 1`` of small matrices."""
    total = np.zeros_like(B)
    for k in range(TUNING.degree, 0, -1):
        total = (B + total @ B) / k
    return total

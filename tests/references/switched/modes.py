"""One mode's exact motion, and which modes can begin at an instant.

The limits of Wong's sequences (Berger, Ilchmann, Trenn 2012) give the consistent subspace of the pencil and
that of its impulses, in which what the sources drive follows from their derivatives. What must not become
negative is a row over y; where currents or voltages are free, rows are added up so that these drop out
(Fourier, Motzkin), and any share is as good as another.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from references.switched.pencil import Array, Layout, State, pencil

SMALL = 1e-9
"""Of what the largest source drives."""

TERMS = 16
"""Of an exponential: the next is less than 1e-19."""

ORDERS = 8
"""Derivatives that are looked at where all before are zero."""


@dataclass(frozen=True)
class Motion:
    """``y = Q c``, ``c' = M c``; c of a y, and the impulses of a jump, both over y before it.

    ``triggers``: rows that stay positive; ``ways``: for each, what ports do instead where it does not.
    """

    Q: Array
    M: Array
    read: Array
    impulse: Array
    triggers: Array
    ways: tuple[frozenset[tuple[str, int]], ...]
    _leaps: dict[float, Array] = field(default_factory=dict, repr=False)

    @cached_property
    def rates(self) -> Array:
        """The motion's rates, slow and fast."""
        return np.asarray(np.linalg.eigvals(self.M)) if len(self.M) else np.zeros(1)

    @cached_property
    def watched(self) -> Array:
        """The triggers over c; where nothing but rounding is left of one, it is zero."""
        rows = self.triggers @ self.Q
        return np.where(np.abs(rows) > 1e-12 * np.abs(self.triggers).max(initial=0.0), rows, 0.0)

    def leap(self, h: float) -> Array:
        """What leads c over a time, kept for the next time."""
        if h not in self._leaps:
            self._leaps[h] = self.after(h)
        return self._leaps[h]

    def after(self, h: float) -> Array:
        """What leads c over a time."""
        return _exponential(self.M * h)

    def chains(self, y: Array) -> tuple[Array, Array]:
        """Impulse, value and derivatives of each trigger where the mode begins, and what is zero of each.

        Rounding in the derivatives grows by the fastest rate from one to the next.
        """
        c = self.read @ y
        T, fast, size = self.watched, np.linalg.norm(self.M, 2), np.linalg.norm(y)
        reach = np.linalg.norm(T, axis=1)
        chain, zero = [self.triggers @ self.impulse @ y], [np.full(len(T), SMALL * size)]
        noise = 1e-14 * size
        for _ in range(ORDERS):
            chain.append(T @ c)
            zero.append(reach * max(SMALL * np.linalg.norm(c), 10 * noise))
            noise = fast * noise + 1e-15 * fast * float(np.linalg.norm(c))
            c = self.M @ c
        return np.array(chain).T, np.array(zero).T

    def verdicts(self, y: Array) -> Array:
        """For each trigger 1, -1 or 0: the sign of the first of its chain that is not zero."""
        chain, zero = self.chains(y)
        told = np.where(np.abs(chain) > zero, np.sign(chain), 0.0)
        first = (told != 0).argmax(axis=1)
        return np.asarray(told[np.arange(len(told)), first])


@dataclass(frozen=True)
class Impossible:
    """A mode whose laws contradict each other, by what these ports do."""

    ports: frozenset[str]


def motion(layout: Layout, state: State) -> Motion | Impossible:
    """The motion in one mode; RuntimeError where rounding spoils it."""
    made = pencil(layout, state)
    n = layout.driven
    E, A, B, G = made.E[:n, :n], made.A[:n, :n], made.A[:n, n:], made.A[n:, n:]
    Q, W = _wong(E, A)
    both = np.hstack([Q, W])
    if both.shape[1] != n or np.linalg.cond(both) > 1e10:
        raise RuntimeError(f"the judge's numbers are lost: {Q.shape}, {W.shape} of {n}")
    r = Q.shape[1]
    apart, rows = np.linalg.inv(both), np.linalg.inv(np.hstack([E @ Q, A @ W]))
    # a' = M a + ..., N b' = b + B_b g with nilpotent N; so b = -(B_b g + N B_b g' + ...), g' = G g.
    M, N, driven = (rows @ A @ Q)[:r], (rows @ E @ W)[r:], rows @ B
    follows, term = np.zeros_like(driven[r:]), driven[r:]
    for _ in range(n):
        follows, term = follows - term, N @ term @ G
    g = np.eye(len(G))
    space = np.block([[Q, W @ follows], [np.zeros((len(g), r)), g]])
    if len(made.left_over) and np.abs(made.left_over @ space).max() > SMALL:
        return Impossible(made.unruled)
    read = np.block([[apart[:r], np.zeros((r, len(g)))], [np.zeros((len(g), n)), g]])
    rate = np.block([[M, driven[:r]], [np.zeros((len(g), r)), G]])
    jump = W @ N @ np.hstack([-apart[r:], follows])
    impulse = np.vstack([jump, np.zeros((len(g), layout.size))])
    triggers, ways = _shared(_signs(layout, state), made.free)
    return Motion(space, rate, read, impulse, triggers.reshape(-1, layout.size), tuple(ways))


def _signs(layout: Layout, state: State) -> list[tuple[Array, str, int]]:
    """Rows that a mode keeps from falling below zero, whose each is, and what its port does instead."""
    rows: list[tuple[Array, str, int]] = []
    for b in layout.network.of("D", "G", "F"):
        now, flow, across = state[b.name], layout.flow(b), layout.voltage(b)
        if b.kind == "D":
            rows.append((flow, b.name, 0) if now else (-across, b.name, 1))
        elif b.kind == "G":
            row = (2 * now - 1) * b.sense * layout.stored(b.watched)
            row[layout.one] = b.value - (b.value + b.off) * now
            rows.append((row, b.name, 1 - now))
        elif now:
            rows.append((now * across, b.name, 0))
        else:
            for way in (1, -1):
                row = -way * flow
                row[layout.one] = b.value
                rows.append((row, b.name, way))
    return rows


def _wong(E: Array, A: Array) -> tuple[Array, Array]:
    Q, W = np.eye(len(E)), np.zeros((len(E), 0))
    while True:
        sizes = Q.shape, W.shape
        Q, W = _kernel(_away(E @ Q) @ A), _kernel(_away(A @ W) @ E)
        if (Q.shape, W.shape) == sizes:
            return Q, W


def _shared(
    rows: list[tuple[Array, str, int]], free: Array
) -> tuple[Array, list[frozenset[tuple[str, int]]]]:
    """Sums of rows in which nothing is free, with what the ports of each do instead."""
    found = [(row, frozenset([(name, way)])) for row, name, way in rows]
    for column in free.T:
        along = [float(row @ column) for row, _ in found]
        kept = [one for one, by in zip(found, along, strict=True) if abs(by) < SMALL]
        up = [(one, by) for one, by in zip(found, along, strict=True) if by >= SMALL]
        down = [(one, -by) for one, by in zip(found, along, strict=True) if by <= -SMALL]
        for (row, names), by in up:
            kept += [(row / by + r / b, names | more) for (r, more), b in down]
        found = kept
    return np.array([row for row, _ in found]), [names for _, names in found]


def _exponential(matrix: Array) -> Array:
    """By Taylor's series of a part of the matrix, squared again: products of small matrices alone."""
    halvings = max(
        0, int(np.ceil(np.log2(max(2 * float(np.abs(matrix).sum(axis=0).max()), 1e-300))))
    )
    part, one = matrix / 2.0**halvings, np.eye(len(matrix))
    found = one
    for k in range(TERMS, 0, -1):
        found = one + part @ found / k
    for _ in range(halvings):
        found = found @ found
    return found


def _kernel(matrix: Array) -> Array:
    if not matrix.size:
        return np.eye(matrix.shape[1])
    _, sizes, rows = np.linalg.svd(matrix)
    # Of one at least: a matrix of rounding alone has no rank.
    return np.asarray(rows[int((sizes > 1e-11 * max(sizes[0], 1.0)).sum()) :].T)


def _away(columns: Array) -> Array:
    """Rows that vanish on the span of the columns."""
    return _kernel(columns.T).T

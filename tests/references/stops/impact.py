"""What stops do at an instant at which they close, by trying all sets of those that take an impulse.

Newton's restitution for several stops at once, as a linear complementarity (Glocker, Set-Valued Force
Laws, 2001; Brogliato, Nonsmooth Mechanics, 2016): ``p >= 0``, ``y+ + e y- >= 0``, one of them zero.
Energy then changes by ``sum p (y+ + y-) / 2 = sum p y- (1 - e) / 2``, which is never above zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from references.stops.line import Array

MOST = 20_000
"""Strikes in one instant: more do not get less, as of a body between a wall and another that comes."""


class JammedError(RuntimeError):
    """Stops that leave what a source moves no way."""


@dataclass(frozen=True)
class Strike:
    """Stops struck together: those that throw back, and the impulse of each stop, nonnegative."""

    thrown: tuple[int, ...]
    impulse: Array


def subsets(items: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """All, larger ones first."""
    for size in range(len(items), -1, -1):
        yield from combinations(items, size)


def complementary(D: Array, q: Array, size: float) -> Array:
    """The p of ``0 <= p``, ``0 <= D p + q``, one of them zero; speeds below ``size`` are rounding."""
    for chosen in subsets(range(len(q))):
        at = list(chosen)
        part = D[np.ix_(at, at)]
        if at and np.linalg.cond(part) > 1e9:
            continue
        p = np.zeros(len(q))
        p[at] = np.linalg.solve(part, -q[at]) if at else 0.0
        if (p * np.diag(D) >= -size).all() and (D @ p + q >= -size).all():
            return np.maximum(p, 0.0)
    raise JammedError("no set of stops takes what meets them")


def strikes(
    D: Array, y: Array, bounce: Array, shut: Sequence[int], size: float, held: Sequence[int] = ()
) -> list[Strike]:
    """What stops whose gaps are closed do until none closes: ``y``: the speeds of all gaps.

    Plastic stops first; then all others that close, while plastic ones that are joined stay so or are let
    go; what closes no faster than ``size`` is stopped. Stops that merely touch take no part; those
    that bounce but are ``held`` by a force count as plastic until they are let go.
    """
    found: list[Strike] = []
    y = y.copy()
    while True:
        held = [i for i in held if y[i] <= size]
        plastic = [i for i in shut if bounce[i] == 0 or i in held]
        joined = [i for i in plastic if y[i] <= size]
        thrown = [i for i in shut if i not in plastic and y[i] < -size]
        if any(y[i] < -size for i in plastic):
            # A plastic stop that moves apart may be closed by what others take.
            took, thrown = plastic, []
        elif thrown:
            took = joined + thrown
        else:
            return found
        e = np.array([bounce[i] if i in thrown else 0.0 for i in took])
        p = np.zeros(len(y))
        p[took] = complementary(D[np.ix_(took, took)], (1 + e) * y[took], size)
        y += D @ p
        found.append(Strike(tuple(i for i in thrown if p[i] > 0), p))
        if len(found) > MOST:
            raise JammedError("stops are struck without end")

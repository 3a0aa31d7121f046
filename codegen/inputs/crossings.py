"""Where a function of time rises through zero: a block of steps at a time, so that none are kept for long."""

from collections import deque
from functools import cache
from math import comb

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.inputs.polynomials import to_bernstein
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

BLOCK = 256
"""So many steps, of a radian or a power of e at the most, are looked through at once."""

HALVES = 45
"""A step is halved no more often than this where its polynomial turns many times."""

LOOKED = np.linspace(0.0, 1.0, 33)
"""Where inside a step a function is looked at for how far it rises."""


class Rises:
    """The times at which a piece rises through zero, from ``begin`` [s] on.

    What comes back before it has risen by ``least`` is none. A piece that begins below that in magnitude
    has risen, too, where it first is twice as large.
    """

    def __init__(self, piece: Piece, begin: float, least: float = 0.0) -> None:
        self._piece, self._until, self._least = piece, begin, least
        self._found, self._above = deque[float](), piece(begin) > 0
        self._begun = abs(piece(begin)) <= least

    def after(self, t: float, stop: float) -> float:
        """The first rise after t and up to ``stop`` [s]; infinite if there is none. t must not go back."""
        while True:
            while self._found and self._found[0] <= t:
                self._found.popleft()
            if self._found or self._until >= stop:
                first = self._found[0] if self._found else np.inf
                return first if first <= stop else np.inf
            self._look(stop)

    def _look(self, stop: float) -> None:
        begin, rate = self._until, max((abs(rate) for rate, _ in self._piece.terms), default=0.0)
        width = min(1 / rate, stop - begin) if rate else stop - begin
        count = min(BLOCK, int(np.ceil((stop - begin) / width)))
        starts = np.asarray(begin + width * np.arange(count), dtype=float)
        self._until = begin + count * width if count == BLOCK else stop
        powers = series_of(self._piece, starts, width)
        found, self._above = rises(powers, self._above, self._least)
        if self._begun:
            raised = powers.copy()
            raised[:, 0] -= 2 * self._least
            found = np.sort(np.append(found, rises(raised, False, 0.0)[0][:1]))
            self._begun = False
        self._found.extend((begin + width * found).tolist())


def series_of(piece: Piece, starts: Array, width: float) -> Array:
    """The power series of a piece over steps of one width, a row each, in parts of the width."""
    degree = TUNING.degree + max((len(poly) - 1 for _, poly in piece.terms), default=0)
    powers, tau = np.zeros((len(starts), degree + 1)), starts - piece.start
    for rate, poly in piece.terms:
        order = np.arange(degree + 1)
        grown = np.cumprod(np.append(1.0, rate * width / np.maximum(order[1:], 1)))
        factor = np.exp(rate * tau)
        for j in range(len(poly)):
            moved = sum(comb(k, j) * poly[k] * tau ** (k - j) for k in range(j, len(poly)))
            own = (factor * moved)[:, None] * grown[None, : degree + 1 - j] * width**j
            powers[:, j:] += own.real
    return powers


def rises(powers: Array, above: bool, least: float) -> tuple[Array, bool]:
    """Where steps that follow one another rise through zero, in steps; whether they end above zero.

    ``above``: whether they come from above. What comes back before it has risen by ``least`` is none.
    """
    begins, halves, parts = _parted(powers)
    shapes = parts @ to_bernstein(parts.shape[1] - 1).T > 0
    starts, ends = shapes[:, 0], shapes[:, -1]
    before = np.append(above, ends[:-1])
    inside = np.flatnonzero(~starts & ends)
    # Rounding may hide a rise between the end of a step and the beginning of the next.
    between = np.flatnonzero(~before & starts)
    places = np.concatenate(
        [begins[inside] + halves[inside] * _roots(parts[inside]), begins[between]]
    )
    steps = np.concatenate([inside, between])
    # Most have risen by the end of their step.
    real = (least == 0) | (parts[steps].sum(axis=1) > least)
    for at in np.flatnonzero(~real).tolist():
        real[at] = _risen(parts, int(steps[at]), least)
    return np.sort(places[real]), bool(ends[-1])


def _risen(parts: Array, at: int, least: float) -> bool:
    """Whether a function that rises in a step comes to more than ``least`` before it falls again."""
    for powers in parts[at:]:
        if powers.sum() > least:
            return True
        values = np.polynomial.polynomial.polyval(LOOKED, powers)
        if values.max() > least:
            return True
        if powers.sum() <= 0:
            return False
    return True


def _parted(powers: Array) -> tuple[Array, Array, Array]:
    """Parts of steps in each of which there is one root at the most: where, how long, their series."""
    begins, halves = np.arange(float(len(powers))), np.ones(len(powers))
    shape = to_bernstein(powers.shape[1] - 1).T
    for _ in range(HALVES):
        above = powers @ shape > 0
        many = (above[:, 1:] != above[:, :-1]).sum(axis=1) > 1
        if not many.any():
            break
        left, right = (powers[many] @ half for half in _halving(powers.shape[1]))
        width = halves[many] / 2
        begins = np.concatenate([begins[~many], begins[many], begins[many] + width])
        halves = np.concatenate([halves[~many], width, width])
        powers = np.vstack([powers[~many], left, right])
        order = np.argsort(begins, kind="stable")
        begins, halves, powers = begins[order], halves[order], powers[order]
    return begins, halves, powers


@cache
def _halving(count: int) -> tuple[Array, Array]:
    """From powers over a step to those over its two halves, by rows."""
    scale = 0.5 ** np.arange(count)
    shift = [[comb(k, j) * 0.5 ** (k - j) if j <= k else 0.0 for j in range(count)]
             for k in range(count)]  # fmt: skip
    both = np.diag(scale), np.array(shift) * scale
    for half in both:
        half.flags.writeable = False
    return both


def _roots(powers: Array) -> Array:
    """The places in their steps at which polynomials rise through zero; each does so once.

    By Newton's steps; where one leaves what is known to hold the root, or falls there, that is halved.
    They end where a value is the rounding of its terms: steps from there on only turn about the root.
    """
    low, high = np.zeros(len(powers)), np.ones(len(powers))
    ends = powers.sum(axis=1)
    place = -powers[:, 0] / (ends - powers[:, 0])
    slopes = powers[:, 1:] * np.arange(1.0, powers.shape[1])
    rounding = np.finfo(float).eps * np.abs(powers).sum(axis=1)
    for _ in range(HALVES if len(powers) else 0):
        raised = np.vander(place, powers.shape[1], increasing=True)
        value = np.einsum("ij,ij->i", powers, raised)
        slope = np.einsum("ij,ij->i", slopes, raised[:, :-1])
        low, high = np.where(value > 0, low, place), np.where(value > 0, place, high)
        with np.errstate(all="ignore"):
            moved = place - value / slope
        good = (slope > 0) & (moved >= low) & (moved <= high)
        moved = np.where(good, moved, (low + high) / 2)
        still = (np.abs(moved - place) <= TUNING.polished) | (good & (np.abs(value) <= rounding))
        place = moved
        if still.all():
            break
    return np.asarray(place, dtype=float)

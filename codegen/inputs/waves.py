"""Signals that repeat: pieces within a period, whose instants are quotients and never sums of steps.

Period k begins at ``(k + phase)/frequency``, a part of it at ``(k + (phase + fraction))/frequency``: the same
doubles wherever they are worked out, in numpy, in compiled C and in what is exported.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bondgraph.errors import SignalError
from codegen.inputs.chains import by_pieces, jumps
from codegen.inputs.pieces import Piece, Term
from codegen.inputs.signal import Endless, Signal
from codegen.numbers.arrays import Array


@dataclass(frozen=True)
class Wave(Endless):
    """Parts of a period by where they begin, ``fractions`` of it from 0 on, and their terms from there.

    ``duty``: of two parts the first lasts as long as this says at each period's start, in periods, clipped to
    [0, 1]; ``fractions`` then tell nothing.
    """

    frequency: float
    phase: float
    fractions: tuple[float, ...]
    forms: tuple[tuple[Term, ...], ...]
    duty: Signal | None = None

    def instant(self, period: int, offset: float) -> float:
        """The time [s] so many periods after ``offset`` of one."""
        return (period + offset) / self.frequency

    def period(self, t: float) -> int:
        """The period that holds at t and just after."""
        k = math.floor(t * self.frequency - self.phase)
        if self.instant(k + 1, self.phase) <= t:
            return k + 1
        return k - 1 if self.instant(k, self.phase) > t else k

    def offsets(self, period: int) -> tuple[float, ...]:
        """Where the parts of a period begin, in periods; infinite where one does not."""
        if self.duty is None:
            return self._offsets
        share = self.share(period)
        return (self.phase, self.phase + share if share < 1 else math.inf)

    def share(self, period: int) -> float:
        """What the duty says at the start of a period."""
        assert self.duty is not None
        return min(max(self.duty(self.instant(period, self.phase)), 0.0), 1.0)

    @cached_property
    def _offsets(self) -> tuple[float, ...]:
        return tuple(self.phase + fraction for fraction in self.fractions)

    @cached_property
    def _levels(self) -> tuple[Piece | None, ...]:
        """The parts that are constant, each of which is one piece for all periods."""
        flat = [all(rate == 0 and len(poly) == 1 for rate, poly in terms) for terms in self.forms]
        return tuple(
            Piece(0.0, terms) if is_flat else None
            for terms, is_flat in zip(self.forms, flat, strict=True)
        )

    def place(self, t: float) -> tuple[int, int, float]:
        """The period and the part that hold at t, and when that part began."""
        k = self.period(t)
        part, begin = 0, self.instant(k, self.phase)
        for j, offset in enumerate(self.offsets(k)):
            at = self.instant(k, offset)
            if at <= t:
                part, begin = j, at
        return k, part, begin

    def piece(self, t: float) -> Piece:
        """The piece of that part."""
        _, part, begin = self.place(t)
        return self._levels[part] or Piece(begin, self.forms[part])

    def following(self, t: float) -> float:
        """Where the next part begins."""
        k = self.period(t)
        after = self.instant(k + 1, self.phase)
        for offset in self.offsets(k):
            if t < (at := self.instant(k, offset)) < after:
                after = at
        if after <= t:
            raise SignalError(
                f"at t = {t:.9g} a period of {1 / self.frequency:.3g} s is no more than the rounding of time"
            )
        return after

    def preceding(self, t: float) -> float:
        """Where the part began that holds at t."""
        return self.place(t)[2]

    def first_jump(self, begin: float, end: float) -> float | None:
        """As of all signals; what has not jumped in a period never does, unless its duty moves."""
        last = self.instant(self.period(begin) + 2, self.phase)
        for at in self.within(begin, end if self.duty else min(end, last)):
            before, after = self.piece(math.nextafter(at, -math.inf)), self.piece(at)
            if before is not after and jumps(before, after, at):
                return at
        return None

    def scaled(self, factor: float) -> Signal:
        """The wave of parts that are each times a number."""
        forms = tuple(
            tuple((rate, tuple(factor * c for c in poly)) for rate, poly in terms)
            for terms in self.forms
        )
        return Wave(self.frequency, self.phase, self.fractions, forms, self.duty)

    def sampled(self, times: Array, rates: bool = False) -> Array:
        """As of all signals."""
        which, begins = self.places(times)
        pieces = [Piece(0.0, terms) for terms in self.forms]
        if rates:
            pieces = [piece.derivative for piece in pieces]
        return by_pieces(which, pieces, times - begins)

    def places(self, times: Array) -> tuple[NDArray[np.intp], Array]:
        """Which part holds at each of many times, and when it began."""
        f, phase = self.frequency, self.phase
        k = np.floor(times * f - phase)
        k = np.where(
            (k + 1 + phase) / f <= times, k + 1, np.where((k + phase) / f > times, k - 1, k)
        )
        which, begins = np.zeros(len(times), dtype=np.intp), (k + phase) / f
        for j, offset in self._columns(k):
            at = (k + offset) / f
            which, begins = np.where(at <= times, j, which), np.where(at <= times, at, begins)
        return which, begins

    def breaks(self, begin: float, count: int) -> Array:
        """At least so many breakpoints after ``begin`` in turn, fewer than three times as many."""
        first = self.period(begin)
        periods = np.arange(first, first + 2 + -(-count // len(self.forms)), dtype=float)
        starts = (periods + self.phase) / self.frequency
        rows = [starts[:-1]]
        for _, offset in self._columns(periods[:-1]):
            at = (periods[:-1] + offset) / self.frequency
            rows.append(np.where(at < starts[1:], at, starts[:-1]))
        found = np.unique(np.concatenate(rows))
        return found[found > begin]

    def _columns(self, periods: Array) -> Sequence[tuple[int, Array]]:
        """The parts after the first with their offsets in each of these periods."""
        if self.duty is None:
            return [(j, np.full(len(periods), one)) for j, one in enumerate(self._offsets) if j]
        found = {int(k): self.offsets(int(k))[1] for k in np.unique(periods).tolist()}
        return [(1, np.array([found[int(k)] for k in periods.tolist()]))]

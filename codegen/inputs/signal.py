"""What every input over time is: a chain of smooth pieces, each known as it is asked for.

A piece is a sum of polynomials times exponentials, ``sum_j p_j(tau) exp(rate_j tau)`` with
``tau = t - start``: the solutions of linear generators. Lags, sums and multiples of such pieces are such
pieces again, so every signal is evaluated exactly.
"""

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bondgraph.errors import SignalError
from codegen.inputs.chains import first_jump, sampled, scaled, summed
from codegen.inputs.pieces import Piece, collected, moved
from codegen.numbers.arrays import Array, is_finite, is_number


class Signal(ABC):
    """A function of time, continuous from the right, smooth between its breakpoints.

    Runs ask for `piece` and `following`. Where breakpoints have no end no tuple holds them, and what
    a signal does is what its `summands` do.

    Raises `SignalError` where a factor is not finite.

    >>> from codegen import Constant, Step
    >>> (Constant(2) + 3 * Step(1, 10))(1)
    32.0
    """

    @property
    @abstractmethod
    def breakpoints(self) -> tuple[float, ...]:
        """Times [s] at which one piece ends and the next begins, increasing."""

    @property
    @abstractmethod
    def pieces(self) -> tuple[Piece, ...]:
        """One piece more than there are breakpoints; the first reaches back for ever."""

    @property
    def endless(self) -> bool:
        """Whether its breakpoints have no end."""
        return False

    @property
    def summands(self) -> "tuple[Signal, ...]":
        """What it is the sum of; of an endless one none is a sum itself."""
        return (self,)

    @property
    def seams(self) -> frozenset[float]:
        """Breakpoints at which the signal goes on smoothly."""
        return frozenset()

    def piece(self, t: float) -> Piece:
        """The piece that holds at t and just after."""
        if self.endless:
            return summed([part.piece(t) for part in self.summands], self._told_from(t))
        return self.pieces[bisect_right(self.breakpoints, t)]

    def following(self, t: float) -> float:
        """The first breakpoint after t; infinite if there is none."""
        if self.endless:
            return min(part.following(t) for part in self.summands)
        at = bisect_right(self.breakpoints, t)
        return self.breakpoints[at] if at < len(self.breakpoints) else math.inf

    def preceding(self, t: float) -> float:
        """The last breakpoint up to t, where its piece begins; -inf if there is none."""
        if self.endless:
            return max(part.preceding(t) for part in self.summands)
        at = bisect_right(self.breakpoints, t)
        return self.breakpoints[at - 1] if at else -math.inf

    def _told_from(self, t: float) -> float:
        """A time that tells the piece at t from others, from which its terms are told."""
        begin, end = self.preceding(t), self.following(t)
        return begin if begin > -math.inf else end - 1.0 if end < math.inf else 0.0

    def within(self, begin: float, end: float) -> Iterator[float]:
        """The breakpoints after ``begin``, up to ``end`` [s], one after the other."""
        at = self.following(begin)
        while at <= end and at < math.inf:
            yield at
            at = self.following(at)

    def first_jump(self, begin: float, end: float) -> float | None:
        """The first time after ``begin``, up to ``end`` [s], at which it jumps; None if it never does."""
        if self.endless:
            found = [part.first_jump(begin, end) for part in self.summands]
            return min((at for at in found if at is not None), default=None)
        return first_jump(self.breakpoints, self.pieces, self.seams, begin, end)

    def sampled(self, times: Array, rates: bool = False) -> Array:
        """The values at many times, or how fast they change; at a breakpoint just after it."""
        if self.endless:
            rows = [part.sampled(times, rates) for part in self.summands]
            return np.asarray(np.sum(rows, axis=0), dtype=float)
        pieces = [piece.derivative for piece in self.pieces] if rates else self.pieces
        return sampled(self.breakpoints, pieces, times)

    def scaled(self, factor: float) -> "Signal":
        """The signal times a finite number."""
        if self.endless:
            return _EndlessSum(tuple(part.scaled(factor) for part in self.summands))
        return _Scaled(self, factor)

    def __call__(self, t: float) -> float:
        """The value at one time [s]; at a breakpoint that of the piece that begins."""
        return self.piece(t)(t)

    def __add__(self, other: "Signal") -> "Signal":
        """The sum of two signals."""
        if not isinstance(other, Signal):
            return NotImplemented
        summands = (*self.summands, *other.summands)
        endless = any(part.endless for part in summands)
        return _EndlessSum(summands) if endless else _Sum(summands)

    def __mul__(self, factor: float) -> "Signal":
        """The signal times a number.

        >>> from codegen import Step
        >>> (2 * Step(0.1, 350))(0.1)
        700.0
        """
        if not is_number(factor):
            return NotImplemented
        if not is_finite(factor):
            raise SignalError(f"a signal times {factor!r}: the factor is not finite")
        return self.scaled(float(factor))

    __rmul__ = __mul__


@dataclass(frozen=True)
class Pieced(Signal):
    """Pieces between breakpoints; before and after, the outer ones.

    ``smooth``: breakpoints at which it goes on smoothly, where one polynomial takes over from another.
    """

    points: tuple[float, ...] = field(repr=False)
    parts: tuple[Piece, ...] = field(repr=False)
    smooth: frozenset[float] = field(repr=False)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Corners, jumps and seams."""
        return self.points

    @property
    def seams(self) -> frozenset[float]:
        """Where one polynomial takes over from another."""
        return self.smooth

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """What it is between them."""
        return self.parts


class Endless(Signal):
    """A signal whose breakpoints have no end: it tells `piece`, `following`, `preceding`, or `summands`."""

    @property
    def endless(self) -> bool:
        """So it is."""
        return True

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Refused: there is no end of them."""
        raise SignalError(f"{self} has breakpoints without end; ask it for those within a time")

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Refused, as `breakpoints`."""
        raise SignalError(f"{self} has pieces without end; ask it for the piece at a time")


@dataclass(frozen=True)
class _EndlessSum(Endless):
    parts: tuple[Signal, ...]

    @property
    def summands(self) -> tuple[Signal, ...]:
        """The parts."""
        return self.parts


@dataclass(frozen=True)
class _Sum(Signal):
    parts: tuple[Signal, ...]

    @property
    def summands(self) -> tuple[Signal, ...]:
        """The parts."""
        return self.parts

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Those of all parts."""
        return tuple(sorted({time for part in self.parts for time in part.breakpoints}))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces of all parts, side by side."""
        times = self.breakpoints
        starts = (times[0] - 1.0 if times else 0.0, *times)
        return tuple(
            Piece(at, collected([term for part in self.parts
                                 for term in moved(part.piece(at), at).terms]))
            for at in starts
        )  # fmt: skip


@dataclass(frozen=True)
class _Scaled(Signal):
    signal: Signal
    factor: float

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Those of the signal."""
        return self.signal.breakpoints

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The signal's, each times the factor."""
        return tuple(scaled(piece, self.factor) for piece in self.signal.pieces)

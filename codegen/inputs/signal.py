"""What every input over time is: a chain of smooth pieces between breakpoints that it knows.

A piece is a sum of polynomials times exponentials, ``sum_j p_j(tau) exp(rate_j tau)`` with
``tau = t - start``: the solutions of linear generators. Lags, sums and multiples of such pieces are such
pieces again, so every signal is evaluated exactly.
"""

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bondgraph.errors import SignalError
from codegen.inputs.pieces import Piece, collected, moved
from codegen.numbers.arrays import is_finite, is_number
from codegen.tuning import TUNING


class Signal(ABC):
    """A function of time, continuous from the right, smooth between its breakpoints."""

    @property
    @abstractmethod
    def breakpoints(self) -> tuple[float, ...]:
        """Times [s] at which one piece ends and the next begins, increasing."""

    @property
    @abstractmethod
    def pieces(self) -> tuple[Piece, ...]:
        """One piece more than there are breakpoints; the first reaches back for ever."""

    def piece(self, t: float) -> Piece:
        """The piece that holds at t and just after."""
        return self.pieces[bisect_right(self.breakpoints, t)]

    @property
    def seams(self) -> frozenset[float]:
        """Breakpoints at which the signal goes on smoothly."""
        return frozenset()

    def following(self, t: float) -> float:
        """The first breakpoint after t; infinite if there is none."""
        at = bisect_right(self.breakpoints, t)
        return self.breakpoints[at] if at < len(self.breakpoints) else math.inf

    def __call__(self, t: float) -> float:
        """The value at one time [s]; at a breakpoint that of the piece that begins."""
        return self.piece(t)(t)

    def __add__(self, other: "Signal") -> "Signal":
        """The sum of two signals."""
        if not isinstance(other, Signal):
            return NotImplemented
        return _Sum((*_summands(self), *_summands(other)))

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
        return _Scaled(self, float(factor))

    __rmul__ = __mul__


@dataclass(frozen=True)
class _Sum(Signal):
    parts: tuple[Signal, ...]

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
        return tuple(
            Piece(piece.start, tuple((rate, tuple(self.factor * c for c in polynomial))
                                     for rate, polynomial in piece.terms))
            for piece in self.signal.pieces
        )  # fmt: skip


def _summands(signal: Signal) -> tuple[Signal, ...]:
    return signal.parts if isinstance(signal, _Sum) else (signal,)


def first_step(signal: Signal, begin: float, end: float) -> float | None:
    """The first time after ``begin``, up to ``end``, at which a signal jumps; None if it never does."""
    for b, one, other in zip(signal.breakpoints, signal.pieces, signal.pieces[1:], strict=False):
        jump = abs(one(b) - other(b))
        if (
            begin < b <= end
            and b not in signal.seams
            and jump > TUNING.together * (abs(one(b)) + abs(other(b)))
        ):
            return b
    return None


def sampled_values(signal: Signal, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """The signal's values at many times."""
    return _sampled(signal.pieces, signal, times)


def sampled_rates(signal: Signal, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """How fast the signal changes at many times; at a breakpoint just after it."""
    return _sampled([piece.derivative for piece in signal.pieces], signal, times)


def _sampled(
    pieces: Sequence[Piece], signal: Signal, times: NDArray[np.float64]
) -> NDArray[np.float64]:
    if len(pieces) == 1:
        return pieces[0].values(times)
    which = np.searchsorted(np.array(signal.breakpoints, dtype=float), times, side="right")
    result = np.zeros(len(times))
    for at in np.unique(which).tolist():
        here = which == at
        result[here] = pieces[at].values(times[here])
    return result

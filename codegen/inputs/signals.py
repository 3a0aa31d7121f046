"""Inputs over time: each a chain of smooth pieces between breakpoints that it knows.

A piece is a sum of polynomials times exponentials, ``sum_j p_j(tau) exp(rate_j tau)`` with
``tau = t - start``: the solutions of linear generators. Lags of such pieces are such pieces again,
so every signal is evaluated exactly.
"""

import cmath
import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bondgraph import SignalError
from codegen.inputs.pieces import Piece, collected, constant_piece, lagged_terms, moved


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

    def __call__(self, t: float) -> float:
        """The value at one time [s]; at a breakpoint that of the piece that begins."""
        return self.piece(t)(t)

    def __add__(self, other: "Signal") -> "Signal":
        """The sum of two signals."""
        if not isinstance(other, Signal):
            return NotImplemented
        return _Sum((*_summands(self), *_summands(other)))


@dataclass(frozen=True)
class Constant(Signal):
    """One value for ever."""

    value: float

    def __post_init__(self) -> None:
        _check_finite(self, self.value)

    breakpoints = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The single piece."""
        return (constant_piece(0.0, self.value),)


@dataclass(frozen=True)
class Step(Signal):
    """From ``initial`` to ``value`` at ``time`` [s].

    >>> Step(0.1, 350)(0.05), Step(0.1, 350)(0.1)
    (0.0, 350.0)
    """

    time: float
    value: float
    initial: float = 0.0

    def __post_init__(self) -> None:
        _check_finite(self, self.time, self.value, self.initial)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """The time of the step."""
        return (float(self.time),)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Before and after."""
        return constant_piece(self.time, self.initial), constant_piece(self.time, self.value)


@dataclass(frozen=True)
class Ramp(Signal):
    """``initial`` until ``time`` [s], then rising by ``slope`` [1/s], until ``end`` [s] if given."""

    time: float
    slope: float
    initial: float = 0.0
    end: float | None = None

    def __post_init__(self) -> None:
        _check_finite(self, self.time, self.slope, self.initial, self.end or 0.0)
        if self.end is not None and self.end <= self.time:
            raise SignalError(f"{self}: a ramp must end after it begins")

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Where the ramp begins and, if it does, ends."""
        return (float(self.time),) if self.end is None else (float(self.time), float(self.end))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Level, rise and, if it ends, level again."""
        rise = Piece(self.time, ((0, (self.initial, self.slope)),))
        parts = (constant_piece(self.time, self.initial), rise)
        return parts if self.end is None else (*parts, constant_piece(self.end, rise(self.end)))


@dataclass(frozen=True)
class Sine(Signal):
    """``offset + amplitude * sin(2 pi frequency t + phase)``; frequency in Hz, phase in rad."""

    amplitude: float
    frequency: float
    phase: float = 0.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        _check_finite(self, self.amplitude, self.frequency, self.phase, self.offset)

    breakpoints = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The single piece: the real part of ``-i a exp(i (w t + phase))``."""
        turning = -1j * self.amplitude * cmath.exp(1j * self.phase)
        rate = 2j * math.pi * self.frequency
        return (Piece(0.0, ((0, (self.offset,)), (rate, (turning,)))),)


@dataclass(frozen=True, init=False)
class Sampled(Signal):
    """Straight lines between samples; the first and last values are held outside.

    ``times`` [s] must increase; both arrays have the same length, two or more.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]

    def __init__(self, times: ArrayLike, values: ArrayLike) -> None:
        try:
            t, v = (np.asarray(array, dtype=float) for array in (times, values))
        except (TypeError, ValueError) as error:
            raise SignalError(f"samples: times and values must be numbers: {error}") from None
        if t.ndim != 1 or t.shape != v.shape or len(t) < 2:
            raise SignalError(
                f"samples need times and values of one length, two or more, not {t.shape} "
                f"and {v.shape}"
            )
        if not (np.isfinite(t).all() and np.isfinite(v).all()):
            raise SignalError("samples: a time or a value is not finite")
        if not (np.diff(t) > 0).all():
            raise SignalError("samples: the times must increase")
        object.__setattr__(self, "times", tuple(t.tolist()))
        object.__setattr__(self, "values", tuple(v.tolist()))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """The sample times."""
        return self.times

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """A level, the lines, a level."""
        slopes = np.diff(self.values) / np.diff(self.times)
        lines = [
            Piece(t, ((0, (v, float(slope))),))
            for t, v, slope in zip(self.times, self.values, slopes, strict=False)
        ]
        first, last = (
            constant_piece(self.times[0], self.values[0]),
            constant_piece(self.times[-1], self.values[-1]),
        )
        return (first, *lines, last)


@dataclass(frozen=True)
class Lag(Signal):
    """A first-order lag: ``time_constant * y' + y = signal``, in steady state before the first break.

    >>> round(Lag(Step(0.0, 1.0), 0.04)(0.04), 6)
    0.632121
    """

    signal: Signal
    time_constant: float

    def __post_init__(self) -> None:
        _check_finite(self, self.time_constant)
        if not isinstance(self.signal, Signal):
            raise SignalError(f"a lag follows a signal, not {self.signal!r}")
        if self.time_constant <= 0:
            raise SignalError(f"a lag's time constant must be positive, not {self.time_constant}")

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Those of the signal it follows."""
        return self.signal.breakpoints

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The answer to each piece in turn, continuous where they meet."""
        driven = self.signal.pieces
        answers = [Piece(driven[0].start, lagged_terms(driven[0], self.time_constant))]
        for time, piece in zip(self.breakpoints, driven[1:], strict=True):
            forced = Piece(time, lagged_terms(moved(piece, time), self.time_constant))
            missing = answers[-1](time) - forced(time)
            decay = (complex(-1 / self.time_constant), (complex(missing),))
            answers.append(Piece(time, collected([*forced.terms, decay])))
        return tuple(answers)


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


def _summands(signal: Signal) -> tuple[Signal, ...]:
    return signal.parts if isinstance(signal, _Sum) else (signal,)


def first_step(signal: Signal, begin: float, end: float) -> float | None:
    """The first time after ``begin``, up to ``end``, at which a signal jumps; None if it never does."""
    for b, one, other in zip(signal.breakpoints, signal.pieces, signal.pieces[1:], strict=False):
        jump = abs(one(b) - other(b))
        if begin < b <= end and jump > 1e-12 * (abs(one(b)) + abs(other(b))):
            return b
    return None


def as_signal(value: object, name: str) -> Signal:
    """A signal as it is, a number as a constant; anything else is refused, naming the input."""
    if isinstance(value, Signal):
        return value
    if isinstance(value, int | float | np.number) and not isinstance(value, bool):
        if not math.isfinite(value):
            raise SignalError(f"input {name!r}: {value!r} is not a finite number")
        return Constant(float(value))
    raise SignalError(
        f"input {name!r}: {value!r} is neither a signal nor a number; use Constant, Step, Ramp, "
        "Sine, Sampled or Lag"
    )


def sampled_values(signal: Signal, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """The signal's values at many times."""
    return _sampled(signal.pieces, signal, times)


def sampled_rates(signal: Signal, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """How fast the signal changes at many times; at a breakpoint just after it."""
    return _sampled([piece.derivative for piece in signal.pieces], signal, times)


def _sampled(
    pieces: Sequence[Piece], signal: Signal, times: NDArray[np.float64]
) -> NDArray[np.float64]:
    which = np.searchsorted(np.array(signal.breakpoints, dtype=float), times, side="right")
    result = np.zeros(len(times))
    for at in np.unique(which).tolist():
        here = which == at
        result[here] = pieces[at].values(times[here])
    return result


def _check_finite(signal: Signal, *numbers: float) -> None:
    for number in numbers:
        if isinstance(number, bool) or not isinstance(number, int | float | np.number):
            raise SignalError(f"{type(signal).__name__}: {number!r} is not a number")
        if not math.isfinite(number):
            raise SignalError(f"{type(signal).__name__}: {number!r} is not finite")

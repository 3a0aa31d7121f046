"""Inputs over time: constants, steps, ramps, sines and lags."""

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

from bondgraph.errors import SignalError
from codegen.inputs.lagged import lagged
from codegen.inputs.pieces import Piece, collected, constant_piece, lagged_terms, moved
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import is_finite, is_number

LONGEST = 60
"""What is no signal is told in so many characters."""


@dataclass(frozen=True)
class Constant(Signal):
    """One value for ever.

    Raises `SignalError` for what is not a finite number.

    >>> Constant(5)(0.3)
    5.0
    """

    value: float

    def __post_init__(self) -> None:
        check_finite(self, self.value)

    breakpoints = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The single piece."""
        return (constant_piece(0.0, self.value),)


@dataclass(frozen=True)
class Step(Signal):
    """From ``initial`` to ``value`` at ``time`` [s].

    Raises `SignalError` for what is not a finite number.

    >>> Step(0.1, 350)(0.05), Step(0.1, 350)(0.1)
    (0.0, 350.0)
    """

    time: float
    value: float
    initial: float = 0.0

    def __post_init__(self) -> None:
        check_finite(self, self.time, self.value, self.initial)

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
    """``initial`` until ``time`` [s], then rising by ``slope`` [1/s], until ``end`` [s] if given.

    Raises `SignalError` for what is not a finite number, or an end before it begins.

    >>> [Ramp(1, 2, end=3)(t) for t in (0, 2, 4)]
    [0.0, 2.0, 4.0]
    """

    time: float
    slope: float
    initial: float = 0.0
    end: float | None = None

    def __post_init__(self) -> None:
        ends = () if self.end is None else (self.end,)
        check_finite(self, self.time, self.slope, self.initial, *ends)
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
    """``offset + amplitude * sin(2 pi frequency t + phase)``; frequency in Hz, phase in rad.

    Raises `SignalError` for what is not a finite number.

    >>> round(Sine(2, 50)(0.005), 9)
    2.0
    """

    amplitude: float
    frequency: float
    phase: float = 0.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        check_finite(self, self.amplitude, self.frequency, self.phase, self.offset)

    breakpoints = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The single piece: the real part of ``-i a exp(i (w t + phase))``."""
        turning = -1j * self.amplitude * cmath.exp(1j * self.phase)
        rate = 2j * math.pi * self.frequency
        return (Piece(0.0, ((0, (self.offset,)), (rate, (turning,)))),)


@dataclass(frozen=True)
class Lag(Signal):
    """A first-order lag: ``time_constant * y' + y = signal``, in steady state before the first break.

    Of a signal that repeats the steady state repeats, too; of one whose duty is a signal the lag is, up to
    the period that holds t = 0, as if the duty had been for ever what it is there.

    Raises `SignalError` for what is no signal, or a time constant that is not positive.

    >>> round(Lag(Step(0.0, 1.0), 0.04)(0.04), 6)
    0.632121
    """

    signal: Signal
    time_constant: float

    def __post_init__(self) -> None:
        check_finite(self, self.time_constant)
        if not isinstance(self.signal, Signal):
            raise SignalError(f"a lag follows a signal, not {self.signal!r}")
        if self.time_constant <= 0:
            raise SignalError(f"a lag's time constant must be positive, not {self.time_constant}")

    @property
    def endless(self) -> bool:
        """Whether the signal it follows is."""
        return self.signal.endless

    @cached_property
    def summands(self) -> tuple[Signal, ...]:
        """Of an endless signal the lags of its summands."""
        if not self.endless:
            return (self,)
        T = float(self.time_constant)
        found = [(part, lagged(part, T)) for part in self.signal.summands]
        return tuple(Lag(part, T) if one is None else one for part, one in found)

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


def as_signal(value: object, name: str) -> Signal:
    """A signal as it is, a number as a constant; anything else is refused, naming the input."""
    if isinstance(value, Signal):
        return value
    if is_number(value):
        if not is_finite(value):
            raise SignalError(f"input {name!r}: {value!r} is not a finite number")
        return Constant(float(value))
    told = repr(value).replace("\n", "")
    told = told if len(told) <= LONGEST else told[: LONGEST - 3] + "..."
    if callable(value):
        raise SignalError(
            f"input {name!r}: {told} is a Python function, which only runs in numpy call; give its "
            "polynomials, codegen.TimeFunction(f).over(times), or samples, codegen.Sampled(times, values)"
        )
    points = "; values at times are Sampled(times, values)" if hasattr(value, "__len__") else ""
    raise SignalError(
        f"input {name!r}: {told} is neither a signal nor a number; use Constant, Step, Pulse, Ramp, "
        "Sine, Square, Sawtooth, PWM, Sampled, ZeroOrderHold or Lag"
        f"{points}"
    )


def check_finite(signal: Signal, *numbers: float) -> None:
    """Refuse what is no finite number, naming the kind of signal."""
    for number in numbers:
        if not is_number(number):
            raise SignalError(f"{type(signal).__name__}: {number!r} is not a number")
        if not is_finite(number):
            raise SignalError(f"{type(signal).__name__}: {number!r} is not finite")

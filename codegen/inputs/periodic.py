"""Inputs over time that repeat: square waves, ramps, and pulses whose width says something."""

from dataclasses import dataclass
from functools import cached_property

from bondgraph.errors import SignalError
from codegen.inputs.signal import Endless, Signal
from codegen.inputs.signals import Constant, check_finite
from codegen.inputs.waves import Wave
from codegen.numbers.arrays import is_number


@dataclass(frozen=True)
class PWM(Endless):
    """Pulses of a frequency [Hz]: ``high`` from each period's start on for ``duty`` of it, then ``low``.

    Period k begins at ``(k + phase)/frequency``, so ``phase`` counts in periods. A duty that is a signal is
    read at each period's start and clipped to [0, 1], at whose ends nothing switches.

    Raises `SignalError` for a frequency that is not positive, a number outside of 0 to 1 as the duty, and for
    what is not finite.

    >>> gate = PWM(1000.0, 0.25)
    >>> gate(0.0), gate(0.3e-3), gate.following(1.0)
    (1.0, 0.0, 1.00025)
    """

    frequency: float
    duty: float | Signal
    low: float = 0.0
    high: float = 1.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        told = () if isinstance(self.duty, Signal) else (self.duty,)
        check_finite(self, self.frequency, *told, self.low, self.high, self.phase)
        _check_frequency(self, self.frequency)
        for share in told:
            _check_share(self, "duty", share)

    @cached_property
    def summands(self) -> tuple[Signal, ...]:
        """The wave; a constant where nothing switches."""
        forms = _level(self.high), _level(self.low)
        if isinstance(self.duty, Signal):
            return (Wave(float(self.frequency), float(self.phase), (0.0, 1.0), forms, self.duty),)
        share = float(self.duty)
        if not 0 < share < 1 or self.low == self.high:
            return (Constant(float(self.high if share >= 1 else self.low)),)
        return (Wave(float(self.frequency), float(self.phase), (0.0, share), forms),)


@dataclass(frozen=True)
class Square(Endless):
    """A square wave of a frequency [Hz]: ``high`` for ``duty`` of each period, then ``low``.

    Period k begins at ``(k + phase)/frequency``.

    Raises `SignalError` for a frequency that is not positive or a share outside of 0 to 1.

    >>> [Square(2.0, -1.0, 1.0)(t) for t in (0.0, 0.2, 0.25, 0.5)]
    [1.0, 1.0, -1.0, 1.0]
    """

    frequency: float
    low: float
    high: float
    duty: float = 0.5
    phase: float = 0.0

    def __post_init__(self) -> None:
        check_finite(self, self.frequency, self.low, self.high, self.duty, self.phase)
        _check_frequency(self, self.frequency)
        _check_share(self, "duty", self.duty)

    @cached_property
    def summands(self) -> tuple[Signal, ...]:
        """The wave; a constant where nothing switches."""
        return PWM(self.frequency, self.duty, self.low, self.high, self.phase).summands


@dataclass(frozen=True)
class Sawtooth(Endless):
    """Straight lines of a frequency [Hz]: from ``low`` to ``high`` for ``width`` of each period, then back.

    Period k begins at ``(k + phase)/frequency``. A width of 1 jumps back, of 0 jumps up and falls; one of
    0.5 is a triangle.

    Raises `SignalError` for a frequency that is not positive or a share outside of 0 to 1.

    >>> [Sawtooth(2.0, 0.0, 1.0)(t) for t in (0.0, 0.125, 0.25, 0.5)]
    [0.0, 0.25, 0.5, 0.0]
    """

    frequency: float
    low: float
    high: float
    width: float = 1.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        check_finite(self, self.frequency, self.low, self.high, self.width, self.phase)
        _check_frequency(self, self.frequency)
        _check_share(self, "width", self.width)

    @cached_property
    def summands(self) -> tuple[Signal, ...]:
        """The wave; a constant where it is one."""
        low, high, width = float(self.low), float(self.high), float(self.width)
        f, phase, rise = float(self.frequency), float(self.phase), high - low
        if not rise:
            return (Constant(low),)
        up = ((0j, (low, rise * f / width)),) if width else ()
        down = ((0j, (high, -rise * f / (1 - width))),) if width < 1 else ()
        if not (up and down):
            return (Wave(f, phase, (0.0,), (up or down,)),)
        return (Wave(f, phase, (0.0, width), (up, down)),)


def _level(value: float) -> tuple[tuple[complex, tuple[complex, ...]], ...]:
    return ((0, (float(value),)),)


def _check_frequency(signal: Signal, frequency: float) -> None:
    if not frequency > 0:
        raise SignalError(
            f"{type(signal).__name__}: the frequency must be positive, not {frequency!r}"
        )


def _check_share(signal: Signal, name: str, share: float) -> None:
    if not (is_number(share) and 0 <= share <= 1):
        raise SignalError(f"{type(signal).__name__}: the {name} must be from 0 to 1, not {share!r}")

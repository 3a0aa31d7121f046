"""Inputs over time that hold a value and change it at told times: one pulse, data held."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bondgraph.errors import SignalError
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.sampled import Points, shown, stepping
from codegen.inputs.signal import Signal
from codegen.inputs.signals import check_finite
from codegen.numbers.arrays import Array, is_finite, is_number, read_only, real_array


@dataclass(frozen=True)
class Pulse(Signal):
    """``value`` from ``begin`` to ``end`` [s], ``initial`` before and after.

    Raises `SignalError` for what is not a finite number, or an end before it begins.

    >>> [Pulse(0.1, 0.2, 5.0)(t) for t in (0.0, 0.1, 0.2)]
    [0.0, 5.0, 0.0]
    """

    begin: float
    end: float
    value: float
    initial: float = 0.0

    def __post_init__(self) -> None:
        check_finite(self, self.begin, self.end, self.value, self.initial)
        if self.end <= self.begin:
            raise SignalError(f"{self}: a pulse must end after it begins")

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Where the pulse begins and ends."""
        return (float(self.begin), float(self.end))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Before, within and after."""
        return (
            constant_piece(self.begin, self.initial),
            constant_piece(self.begin, self.value),
            constant_piece(self.end, self.initial),
        )


@dataclass(frozen=True, init=False, repr=False)
class ZeroOrderHold(Points):
    """Each value from its time [s] to the next one's; the first also before, the last for ever.

    Either ``times``, which must increase, or the ``period`` [s] between values, the first at ``start``.

    Raises `SignalError` for times that do not increase, and for what is not finite.

    >>> held = ZeroOrderHold(values=[1.0, 4.0, 2.0], period=0.1)
    >>> held.breakpoints, held(0.15)
    ((0.1, 0.2), 4.0)
    """

    times: tuple[float, ...]
    values: tuple[float, ...]

    def __init__(
        self, times: ArrayLike | None = None, values: ArrayLike | None = None,
        period: float | None = None, start: float = 0.0,
    ) -> None:  # fmt: skip
        v = _row(values, "values")
        if (times is None) == (period is None):
            raise SignalError("held values have either times or a period")
        t = _row(times, "times") if period is None else _even(start, period, len(v))
        if t.shape != v.shape:
            raise SignalError(
                f"held values need times and values of one length, not {len(t)} and {len(v)}"
            )
        if not (np.diff(t) > 0).all():
            raise SignalError("held values: the times must increase")
        object.__setattr__(self, "times", tuple(t.tolist()))
        object.__setattr__(self, "values", tuple(v.tolist()))

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """The times of all values but the first."""
        return self.times[1:]

    @cached_property
    def powers(self) -> tuple[Array, Array]:
        """The values."""
        return read_only(np.array(self.times)), read_only(np.array(self.values)[:, None])

    @cached_property
    def jumps(self) -> NDArray[np.bool_]:
        """Where values differ."""
        return read_only(stepping(np.array(self.values)))

    def __repr__(self) -> str:
        return f"ZeroOrderHold({shown(self.times, self.values)})"


def _row(numbers: ArrayLike | None, what: str) -> Array:
    """One finite number or more, in a row."""
    try:
        row = real_array([] if numbers is None else numbers)
    except (TypeError, ValueError) as error:
        raise SignalError(f"held values: {what} must be numbers: {error}") from None
    if row.ndim != 1 or not len(row):
        raise SignalError(f"held values: {what} must be one number or more in a row")
    if not np.isfinite(row).all():
        raise SignalError(f"held values: one of the {what} is not finite")
    return row


def _even(start: object, period: object, count: int) -> Array:
    """Times that many periods after the start, none the sum of others."""
    for number, what in ((start, "start"), (period, "period")):
        if not is_number(number) or not is_finite(number):
            raise SignalError(f"held values: the {what} must be a finite number, not {number!r}")
    first, step = float(start), float(period)  # type: ignore[arg-type]
    if not step > 0:
        raise SignalError(f"held values: the period must be positive, not {period!r}")
    return np.asarray(first + step * np.arange(count), dtype=np.float64)

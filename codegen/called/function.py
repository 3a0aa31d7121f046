"""`TimeFunction`: a Python function of time as an input."""

import hashlib
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.errors import SignalError
from codegen.called.fitting import fits
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.signal import Pieced, Signal
from codegen.numbers.arrays import Array, is_finite, is_number, real_array
from codegen.tuning import TUNING


@dataclass(frozen=True, repr=False)
class Followed(Pieced):
    """A function over the stretch that it was asked for: a level, polynomials, a level."""

    name: str

    def __repr__(self) -> str:
        told = repr((self.points, [piece.terms for piece in self.parts]))
        digest = hashlib.sha256(told.encode()).hexdigest()[:16]
        return (
            f"<function {self.name} from {self.points[0]!r} to {self.points[-1]!r} s, "
            f"{len(self.parts) - 2} polynomials, sha256 {digest}>"
        )


@dataclass(frozen=True, repr=False)
class TimeFunction:
    """A Python function of time [s] as an input of runs in numpy; the function alone is as good.

    A run gets polynomials of degree 13 that miss it by no more than ``tolerance`` of its size, so that the
    event loop and exact steps go on as with any input. They are compared with it between the points that they
    are made of and at the samples of the run; what it does between all of these is not seen. ``breakpoints``
    [s]: where it jumps or has corners, from where on its new values hold. Those that are not told are found
    to the rounding of time, at the price of some forty polynomials each.

    The function is called with one float and gives one number, always the same for the same time. The times
    are in no order. C and exports take no Python function: give them what `over` makes, or `Sampled`.

    Raises `SignalError` for what is no function, for breakpoints that are no finite numbers, and a tolerance
    that is not between 0 and 1.

    >>> import math
    >>> wave = TimeFunction(math.sin).over([0, 10])
    >>> abs(wave(1.0) - math.sin(1.0)) < 1e-14, wave(11.0) == wave(10.0)
    (True, True)
    """

    function: Callable[[float], float]
    breakpoints: Iterable[float] = ()
    tolerance: float = field(default=TUNING.called)

    def __post_init__(self) -> None:
        if not callable(self.function) or isinstance(self.function, Signal):
            raise SignalError(f"{self.function!r} is no Python function of time")
        try:
            told = real_array(list(self.breakpoints))
        except (TypeError, ValueError) as error:
            raise SignalError(f"{self}: breakpoints must be numbers: {error}") from None
        if not np.isfinite(told).all():
            raise SignalError(f"{self}: a breakpoint is not finite")
        if not is_number(self.tolerance) or not 0 < self.tolerance < 1:
            raise SignalError(f"{self}: tolerance={self.tolerance!r} is not between 0 and 1")
        object.__setattr__(self, "breakpoints", tuple(np.unique(told).tolist()))

    def __call__(self, t: float) -> float:
        """What the function gives at a time [s]; `SignalError` where that is no finite number."""
        try:
            value = self.function(t)
        except Exception as error:
            raise SignalError(
                f"{self} raised {type(error).__name__} at t = {t:.9g}: {error}"
            ) from error
        if not is_number(value) or not is_finite(value):
            raise SignalError(f"{self} gives {value!r} at t = {t:.9g}, which is no finite number")
        return float(value)

    def over(self, times: ArrayLike) -> Signal:
        """The signal from the first to the last of some times [s], for runs by C and for exports.

        ``times``: also where it is compared with the function. Raises `SignalError` where no polynomials
        keep to the tolerance.
        """
        try:
            asked = np.unique(real_array(times))
        except (TypeError, ValueError) as error:
            raise SignalError(f"{self}: times must be numbers: {error}") from None
        if len(asked) < 2 or not np.isfinite(asked).all():
            raise SignalError(
                f"{self}: give two finite times or more, the first and the last of a run"
            )
        begin, end = float(asked[0]), float(asked[-1])
        ends = [begin, *(b for b in self.breakpoints if begin < b < end), end]
        try:
            found = fits(self._called, ends, asked, self.tolerance)
        except SignalError as error:
            raise SignalError(
                str(error) if repr(self) in str(error) else f"{self} {error}"
            ) from error
        scale = found.halves[:, None] ** -np.arange(found.powers.shape[1])
        rows = zip(
            found.centres.tolist(),
            found.halves.tolist(),
            (found.powers * scale).tolist(),
            strict=True,
        )
        parts = [Piece(centre, ((0.0, tuple(row)),), 0.5 / half) for centre, half, row in rows]
        first, last = (
            constant_piece(t, piece(t)) for t, piece in ((begin, parts[0]), (end, parts[-1]))
        )
        # The last sample is still the function's, its rate as well.
        points = (*found.begins.tolist(), math.nextafter(end, math.inf))
        smooth = frozenset(found.begins[found.smooth].tolist())
        return Followed(points, (first, *parts, last), smooth, self._name)

    def _called(self, times: Array) -> Array:
        return np.array([self(t) for t in times.tolist()], dtype=np.float64)

    @property
    def _name(self) -> str:
        """A function by its name; an object by its class, whose text may hold an address."""
        named: Any = self.function
        if not hasattr(named, "__qualname__"):
            named = type(named)
        return f"{named.__module__}.{named.__qualname__}"

    def __repr__(self) -> str:
        told = f", breakpoints={self.breakpoints!r}" if self.breakpoints else ""
        return f"TimeFunction({self._name}{told})"


def followed(inputs: Any, times: Array) -> Any:
    """Inputs of a run in numpy over its times: functions by what they are over these, all else as it is.

    Raises `SignalError` naming the input.
    """
    if not isinstance(inputs, Mapping):
        return inputs
    return {name: _followed(name, value, times) for name, value in inputs.items()}


def _followed(name: object, value: Any, times: Array) -> Any:
    if isinstance(value, Signal) or not callable(value):
        return value
    function = value if isinstance(value, TimeFunction) else TimeFunction(value)
    try:
        return function.over(times)
    except SignalError as error:
        raise SignalError(f"input {str(name)!r}: {error}") from error.__cause__

"""Inputs over time from samples."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.errors import SignalError
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import real_array


@dataclass(frozen=True, init=False)
class Sampled(Signal):
    """Straight lines between samples; the first and last values are held outside.

    ``times`` [s] must increase; both arrays have the same length, two or more.

    Raises `SignalError` for other arrays, and for what is not finite.

    >>> Sampled([0, 1, 3], [0, 10, 30])(2)
    20.0
    """

    times: tuple[float, ...]
    values: tuple[float, ...]

    def __init__(self, times: ArrayLike, values: ArrayLike) -> None:
        try:
            t, v = (real_array(array) for array in (times, values))
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

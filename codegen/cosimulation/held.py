"""What connected inputs were over a run, as signals: held values, or lines that jump where they meet."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from codegen.cosimulation.part import Given
from codegen.inputs.held import ZeroOrderHold
from codegen.inputs.sampled import Points
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.numbers.arrays import Array, read_only


@dataclass(frozen=True)
class Lines(Points):
    """Lines from each time [s] to the next one's: values there, and slopes [1/s].

    >>> Lines((0.0, 1.0), (0.0, 5.0), (2.0, 0.0))(0.5)
    1.0
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    slopes: tuple[float, ...]

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """The times of all lines but the first."""
        return self.times[1:]

    @cached_property
    def powers(self) -> tuple[Array, Array]:
        """Values and slopes."""
        rows = np.column_stack([self.values, self.slopes])
        return read_only(np.array(self.times)), read_only(rows)

    @cached_property
    def jumps(self) -> NDArray[np.bool_]:
        """Where a line does not end at what the next begins with."""
        times, values, slopes = map(np.array, (self.times, self.values, self.slopes))
        ends = values[:-1] + slopes[:-1] * np.diff(times)
        return read_only(ends != values[1:])


def signal_of(times: Array, given: Sequence[Given]) -> Signal:
    """An input of a run, from what it was from each instant on."""
    at, values = times[: len(given)].tolist(), [one.value for one in given]
    if len(values) == 1 and not given[0].slope:
        return Constant(values[0])
    if any(one.slope for one in given):
        return Lines(tuple(at), tuple(values), tuple(one.slope for one in given))
    return ZeroOrderHold(at, values)

"""Fixed steps of models with delays: they remember, and end where breaks come late.

What a delay reads in a step is told by the states there, between its ends by Hermite's polynomial.
"""

from collections.abc import Collection, Sequence

import numpy as np

from codegen.fixed.memory import READ_AT, Memory
from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.instant import Formula
from codegen.standalone.stepping import FixedSteps, Given, Signal
from codegen.tuning import TUNING


class RememberingSteps(FixedSteps):
    """A model in fixed steps whose last open ports are given by delays."""

    #: What each delay reads.
    read_late: Formula
    #: The names of what they give, among the inputs.
    delayed: Sequence[str] = ()
    memory: Memory
    _end: tuple[bytes, bytes, Mode] | None = None

    @property
    def wanted(self) -> Sequence[str]:
        """The external inputs that no delay gives."""
        return [name for name in self.names.external if name not in self.delayed]

    def recalling(self, signals: list[Signal]) -> list[Signal]:
        """A function of time for each external input; of what delays give one that remembers."""
        given = iter(signals)
        return [
            self._remembered(self.delayed.index(name)) if name in self.delayed else next(given)
            for name in self.names.external
        ]

    def _remembered(self, delay: int) -> Signal:
        return lambda t: self.memory.given(delay, t)

    def begin(self, at: Point, on: Collection[str], named: Collection[str]) -> Array:
        """The vector s with which a run begins; nothing has been read."""
        self.memory.begin(at.t)
        self._end = None
        return super().begin(at, on, named)

    def until(self, t: float, end: float) -> float:
        """Where steps from t end at the latest: at what breaks, or is not known yet, too."""
        self.memory.enter(t)
        stop = super().until(t, end)
        found = self.memory.following(t)
        return found if found < stop - TUNING.together * max(abs(stop), stop - t) else stop

    def advance(
        self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode
    ) -> tuple[Mode, Array]:
        """A step in one mode, and the mode at its end; what delays read in it."""
        after, end = super().advance(t, h, s, given, mode)
        start = s.tobytes(), given[0][0].tobytes(), mode
        turns = start != self._end or self.memory.stretch >= self.memory.until
        ends = [self.at(Point(t, s, *given[0]), mode), self.at(Point(t + h, end, *given[2]), mode)]
        first, last = (now.rate for now in ends)
        values = [self.read_late(now) for now in ends]
        for x in 0.5 * (READ_AT[2:] + 1):
            y = 1 - x
            between = y * y * (1 + 2 * x) * s + x * x * (3 - 2 * x) * end
            between = between + h * x * y * (y * first - x * last)
            inputs = self._inputs(t + x * h, x, given), given[1][1]
            values.append(self.read_late(self.at(Point(t + x * h, between, *inputs), mode)))
        self.memory.take(t + h, np.array(values).T, turns)
        self._end = end.tobytes(), given[2][0].tobytes(), after
        return after, end

    def _inputs(self, t: float, x: float, given: Sequence[Given]) -> Array:
        """The inputs in a part of a step: on the parabola through three, or remembered."""
        y = 1 - x
        (a, _), (b, _), (c, _) = given
        found = a * y * (y - x) + 4 * b * x * y + c * x * (x - y)
        for at, name in enumerate(self.names.external):
            if name in self.delayed:
                found[at] = self.memory.given(self.delayed.index(name), t)
        return found


def lags_told(numbers: Sequence[float], names: Sequence[str]) -> tuple[Array, Array]:
    """How late delays are, and what they give at first; `ValueError` for one that is not late."""
    late, start = np.array(numbers, dtype=float).reshape(2, -1)
    for name, time, first in zip(names, late, start, strict=True):
        if not 0 < time < np.inf or not np.isfinite(first):
            raise ValueError(
                f"{name}: a delay is above zero and starts at a number, not {time}, {first}"
            )
    return late, start

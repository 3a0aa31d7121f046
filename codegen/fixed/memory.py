"""What delays have read of a run in fixed steps, and what they give of it.

Polynomials, one after the other, of what each read in a step; as model_memory.c has them.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array
from codegen.tuning import TUNING

READ_AT = np.array([-1.0, 1.0, -1 / 3, 1 / 3])
"""Where a step is read, from -1 to 1: its ends, then inside."""

TO_POWERS = np.linalg.inv(np.vander(READ_AT, increasing=True))
"""From values there to powers of the place."""


@dataclass(frozen=True)
class Past:
    """A part of a run; ``powers``: delays by rows."""

    begin: float
    end: float
    powers: Array

    def rises(self, t: float, h: float) -> Array:
        """Values, slopes and half the curvatures at a time, over steps of h; delays by columns."""
        half = 0.5 * (self.end - self.begin)
        x, ratio = (t - self.begin) / half - 1, h / half
        k = np.arange(len(READ_AT))
        first, second = k * x ** np.maximum(k - 1, 0), 0.5 * k * (k - 1) * x ** np.maximum(k - 2, 0)
        weights = np.array([x**k, first * ratio, second * ratio**2])
        found: Array = weights @ self.powers.T
        return found


class Memory:
    """What was read from ``since`` up to ``until`` [s]; at a break there is a jump or a corner.

    ``late``: each delay [s]; ``start``: what it gives before. It gives what holds in the
    ``stretch`` between two breaks.
    """

    def __init__(self, late: Array, start: Array) -> None:
        self.late, self.start = late, start
        self.begin(0.0)

    def begin(self, t: float) -> None:
        """Nothing has been read yet."""
        self.until = self.stretch = self.since = t
        self.sizes = np.zeros(len(self.late))
        self._parts: list[Past] = []
        self._begins: list[float] = []
        self._breaks: list[float] = []

    def enter(self, t: float) -> None:
        """From now on it gives what holds at t and just after."""
        passed = [self._breaks[k - 1] + late for late in self.late
                  if (k := self._reached(self._breaks, late, t))]  # fmt: skip
        self.stretch = max(passed, default=self.since)

    def following(self, t: float) -> float:
        """The next break after t, and no more than is known."""
        ahead = [self._breaks[k] + late for late in self.late
                 if (k := self._reached(self._breaks, late, t)) < len(self._breaks)]  # fmt: skip
        return float(min([*ahead, *(t + self.late)]))

    def given(self, delay: int, t: float) -> float:
        """What a delay gives at t [s]."""
        late = float(self.late[delay])
        begun = self._reached(self._begins, late, max(t, self.stretch))
        ahead = self._reached(self._breaks, late, self.stretch)
        if ahead < len(self._breaks):
            # What begins at a break beyond the stretch has not begun, however close it is.
            begun = min(begun, self._begins.index(self._breaks[ahead]))
        if not begun:
            return float(self.start[delay])
        return float(self._parts[begun - 1].rises(t - late, 1.0)[0, delay])

    def take(self, end: float, values: Array, turns: bool) -> None:
        """What was read up to ``end`` [s], delays by rows; ``turns``: a break may be there."""
        part = Past(self.until, end, values @ TO_POWERS.T)
        self.sizes = np.maximum(self.sizes, np.abs(values).max(axis=1))
        if (turns or not self._parts) and self._breaks_off(part):
            self._breaks.append(self.until)
        self._parts.append(part)
        self._begins.append(self.until)
        self.until = end
        self._forget()

    def _reached(self, times: Sequence[float], late: float, t: float) -> int:
        """How many of these times, increasing, are no later than t, so late."""
        near = TUNING.together * max(abs(t), t - self.since)
        return bisect_right(times, t + near, key=lambda time: time + late)

    def _breaks_off(self, part: Past) -> bool:
        """Whether a step over its begin would err by more than rounding, and a little."""
        length = part.end - part.begin
        h, shortest = max(length, TUNING.seam_reach * float(self.late.min())), length
        before = np.array([self.start, 0 * self.start, 0 * self.start])
        if self._parts:
            last = self._parts[-1]
            h = max(h, part.begin - last.begin)
            shortest = min(shortest, part.begin - last.begin)
            before = last.rises(part.begin, h)
        off = np.abs(part.rises(part.begin, h) - before)
        rounding = TUNING.seam_rounding * (h / shortest) ** np.arange(3)
        return bool((off > np.outer(TUNING.seam + rounding, self.sizes)).any())

    def _forget(self) -> None:
        """What no delay asks for any more, from time to time."""
        over = bisect_right(self._begins, self.until - 2 * float(self.late.max())) - 1
        if over > len(self._parts) // 2:
            del self._parts[:over], self._begins[:over]
            self._breaks = [one for one in self._breaks if one >= self._begins[0]]

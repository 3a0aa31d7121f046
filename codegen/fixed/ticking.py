"""Fixed steps with sampled tasks: they end at the instants of these, which are exact.

At an instant every task that is due sets what it sets, all told by what stood before; then the mode
is chosen anew. A sample that is a rounding off an instant is that instant.
"""

import math
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.stepping import Chosen, FixedSteps
from codegen.standalone.switchings import Clock, Reset
from codegen.tuning import TUNING


def become(
    states: Sequence[str], now: Instant, s: Array, values: Array, fired: Iterable[Reset]
) -> Array:
    """The vector s with what these resets set.

    Raises `EvaluationError` where a state is set to two values, or to none.
    """
    x, found = np.concatenate((now.x, now.z)), s.copy()
    first: dict[int, float] = {}
    for one in fired:
        value = values[one.value]
        if not np.isfinite(value) or value != first.setdefault(one.place, value):
            name = states[one.place]
            raise EvaluationError(f"at t = {now.t:g} {name} is reset to two values, or to none")
        # Less what inputs that drive dependent storages add.
        found[one.place] = value + (s[one.place] - x[one.place])
    return found


class TickingSteps(FixedSteps):
    """A model in fixed steps with tasks that have instants of their own."""

    clocks: Sequence[Clock] = ()
    #: What the tasks set: of each the clock is -1 less the port.
    ticks: Sequence[Reset] = ()
    #: What they set it to, among other conditions.
    told_by_tasks: Formula
    began, done = 0.0, -math.inf

    def begin(self, at: Point, on: Collection[str], named: Collection[str]) -> Array:
        """The vector s with which a run begins; no task has been at work."""
        self.began, self.done = at.t, -math.inf
        return super().begin(at, on, named)

    def until(self, t: float, end: float) -> float:
        """The first instant before the end, else the end."""
        first = min(one.following(t + self.near(t)) for one in self.clocks)
        return first if first < end - self.near(end) else end

    def near(self, t: float) -> float:
        """So close to t [s] an instant is at t; a run begins where it begins."""
        return TUNING.together * max(abs(t), t - self.began) if t > self.began else 0.0

    def due(self, t: float) -> dict[int, float]:
        """The tasks that are due, by their clocks, and when they were; each is so once."""
        near = self.near(t)
        found = {i: one.latest(t + near) for i, one in enumerate(self.clocks)}
        return {i: at for i, at in found.items() if at >= t - near and at > self.done}

    def settled(
        self, at: Point, previous: Chosen, dead_band: float, h: float
    ) -> tuple[Mode, Array]:
        """The mode of a step of h, and s then; once no event is left, with what is due set."""
        mode, s = super().settled(at, previous, dead_band, h)
        due = self.due(at.t)
        if not due:
            return mode, s
        self.done = max(due.values())
        fired = [one for one in self.ticks if -1 - one.port in due]
        now = self.at(at._replace(s=s), mode)
        s = become(self.names.states, now, s, self.told_by_tasks(now), fired)
        return super().settled(at._replace(s=s), mode, dead_band, h)

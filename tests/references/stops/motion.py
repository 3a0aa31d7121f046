"""The motion of bodies on a line with stops: exact between events, all of which are found.

At an instant first impulses (`impact`), then forces: of all sets of closed stops that may hold, one in which
each force is, by its first derivative that is not zero, not negative, and each other gap does not close.
Stops that bounce ever faster hold once what they give is small beside what moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from references.stops.impact import JammedError, strikes, subsets
from references.stops.line import Array, Line
from references.stops.roots import Flow, first_fall, sign

SMALL, SLOW, TOGETHER = 1e-12, 1e-7, 1e-10
"""Of the fastest, closing speeds in an instant that are rounding, and those of bounces that end; of a step,
what is one instant."""

STILL = 1e-10
"""Of the fastest, speeds of gaps that are at rest: stops that take turns ever faster end in that."""

PRESSED = 1e-9
"""Of the largest, a force that presses."""

Happening = tuple[float, str, str, float]
"""When, which stop, "hit", "touch" or "apart", and the impulse that it gave."""


@dataclass
class Course:
    """Positions and speeds of the free bodies at the times, forces of stops there, and the events.

    ``ties``: when stops closed together, to rounding, by no more than chance: their order may matter.
    """

    states: list[Array] = field(default_factory=list)
    forces: list[Array] = field(default_factory=list)
    events: list[Happening] = field(default_factory=list)
    ties: list[float] = field(default_factory=list)


class Machine:
    """Runs one line."""

    def __init__(self, line: Line, joined: bool = True) -> None:
        """``joined``: whether stops that bounce, but are held by a force, take shocks as plastic ones."""
        self._line, self._m, self._joined = line, line.matrices, joined
        self._bounce = np.array([stop.bounce for stop in line.stops])
        self._modes: dict[tuple[int, ...], tuple[Flow, Array] | None] = {}
        self._speed = 0.0
        self._most = np.abs(self._m.start)
        self._most[self._m.all + self._m.n :] = 1.0

    def run(self, times: Array, told: Course | None = None) -> Course:
        """From the first of the times to the last; ``told``: empty, filled up to where stops jam."""
        course = Course() if told is None else told
        t, X = float(times[0]), self._m.start.copy()
        if (self._m.gaps @ X < -self._rounding(X)).any():
            raise ValueError("a stop begins beyond its bound")
        shut, mode = self._closed(X), None
        while True:
            X, mode, apart = self._decide(t, X, shut, mode, course)
            t_new, X_new, closed = self._advance(t, X, mode, apart, times, course)
            if closed is None:
                return course
            near = {*closed, *self._closed(X_new)} - {*mode}
            course.ties += [t_new] * (len(near) > 1)
            t, X, shut = t_new, X_new, sorted({*mode, *near})
            if len(course.events) > 200_000:
                raise RuntimeError("the machine makes no progress")

    def _rounding(self, X: Array) -> Array:
        return SMALL * (1 + np.abs(self._m.gaps) @ np.abs(X))

    def _closed(self, X: Array) -> list[int]:
        """The stops whose gaps are no more than rounding."""
        return [int(i) for i in np.flatnonzero(self._m.gaps @ X <= self._rounding(X))]

    def _decide(
        self, t: float, X: Array, shut: Sequence[int], old: tuple[int, ...] | None, course: Course
    ) -> tuple[Array, tuple[int, ...], list[int]]:
        """X after impacts, the stops that hold, and those that are closed without holding."""
        m, y = self._m, self._m.rates @ X
        self._most = np.maximum(self._most, np.abs(X))
        self._speed = max(self._speed, float(np.abs(X[m.all : m.all + m.n]).max(initial=0.0)),
                          float(np.abs(y).max(initial=0.0)))  # fmt: skip
        # What closes so slowly at a stop that bounces has come to its end.
        ends = (y < -SMALL * self._speed) & (y > -SLOW * self._speed)
        bounce, rest = np.where(ends, 0.0, self._bounce), np.zeros(len(y))
        hits: list[Happening] = []
        held = self._pressed(X, old) if self._joined and old else ()
        for strike in strikes(m.shares, y, bounce, shut, SMALL * self._speed, held):
            X = X + m.push @ strike.impulse
            rest += strike.impulse
            for i in strike.thrown:
                hits.append((t, self._line.stops[i].name, "hit", float(strike.impulse[i])))
                rest[i] -= strike.impulse[i]
        y = m.rates @ X
        resting = [i for i in shut if abs(y[i]) <= STILL * self._speed]
        X = self._placed(X, shut, resting)
        mode = self._mode(X, resting)
        if old is not None:
            for i, stop in enumerate(self._line.stops):
                changed = (i in mode) != (i in old)
                kind = ("touch" if i in mode else "apart") if changed else "hit"
                if changed or rest[i] > PRESSED * rest.max():
                    hits.append((t, stop.name, kind, float(rest[i])))
            course.events += hits
        return X, mode, [i for i in shut if i not in mode]

    def _pressed(self, X: Array, mode: tuple[int, ...]) -> list[int]:
        """The stops of a mode that hold by a force."""
        found = self._flow(mode)
        assert found is not None
        forces = found[1] @ X
        return [i for i in mode if forces[i] > PRESSED * np.abs(forces).max()]

    def _placed(self, X: Array, shut: Sequence[int], resting: Sequence[int]) -> Array:
        """X with gaps that are closed exactly so, and what rests exactly at rest: rounding is not kept."""
        m, X = self._m, X.copy()
        if shut:
            rows = m.gaps[list(shut), : m.n]
            X[: m.n] -= np.linalg.pinv(rows) @ (m.gaps[list(shut)] @ X)
        if resting:
            rows = m.rates[list(resting), m.all : m.all + m.n]
            X[m.all : m.all + m.n] -= np.linalg.pinv(rows) @ (m.rates[list(resting)] @ X)
        return X

    def _mode(self, X: Array, resting: Sequence[int]) -> tuple[int, ...]:
        """The largest set that may hold."""
        for chosen in subsets(resting):
            found = self._flow(chosen)
            if found is None:
                continue
            flow, forces = found
            rest = [i for i in resting if i not in chosen]
            gaps = flow.series(self._m.gaps[rest], X, self._most)
            gaps[:, :2] = 0.0
            held = flow.series(forces[list(chosen)], X, self._most)
            if all(sign(row) >= 0 for row in (*gaps, *held)):
                return chosen
        raise JammedError("no set of stops may hold")

    def _flow(self, mode: tuple[int, ...]) -> tuple[Flow, Array] | None:
        """How X moves while some stops hold, and the rows of the stops' forces; None if these depend."""
        if mode not in self._modes:
            m, at = self._m, list(mode)
            D = m.shares[np.ix_(at, at)]
            rows = np.zeros_like(m.gaps)
            if at and np.linalg.cond(D) > 1e9:
                self._modes[mode] = None
            else:
                rows[at] = -np.linalg.solve(D, m.rates[at] @ m.A) if at else 0.0
                self._modes[mode] = Flow(m.A + m.push @ rows), rows
        return self._modes[mode]

    def _advance(
        self, t: float, X: Array, mode: tuple[int, ...], apart: Sequence[int], times: Array,
        course: Course,
    ) -> tuple[float, Array, list[int] | None]:  # fmt: skip
        """To the next event: its time, and the stops that it closes; None at the end."""
        found = self._flow(mode)
        assert found is not None
        flow, forces = found
        free = [i for i in range(len(self._bounce)) if i not in mode]
        y = self._m.rates @ X
        while True:
            step = flow.step
            series = np.vstack(
                [
                    flow.series(self._m.gaps[free], X, self._most),
                    flow.series(forces[list(mode)], X, self._most),
                ]
            )
            for row, i in zip(series, free, strict=False):
                if i in apart:
                    row[: 1 if y[i] > STILL * self._speed else 2] = 0.0
            falls = [first_fall(row) for row in series]
            first = min((f for f in falls if f is not None), default=None)
            until = t + step * (1.0 if first is None else first)
            self._record(flow, forces, t, X, min(until, times[-1]), times, course)
            if until >= times[-1]:
                return t, X, None
            new = flow.at(until - t, X)
            if first is not None:
                ends = [f is not None and f <= first + TOGETHER for f in falls]
                return until, new, [i for i, end in zip(free, ends, strict=False) if end]
            t, X, apart = until, new, []

    def _record(
        self, flow: Flow, forces: Array, t: float, X: Array, until: float, times: Array,
        course: Course,
    ) -> None:  # fmt: skip
        """The samples from t to ``until``; one at an event is what holds after it."""
        m = self._m
        for at in times[len(course.states) :]:
            if at > until or (at == until and until < times[-1]):
                return
            now = flow.at(at - t, X)
            course.states.append(np.concatenate([now[: m.n], now[m.all : m.all + m.n]]))
            course.forces.append(forces @ now)

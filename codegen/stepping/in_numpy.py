"""A run in numpy that pauses, and goes on from there."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.signal import Signal
from codegen.model.kept import Paused
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.program.layout import NAMES, RECORDED
from codegen.runs.hybrid import Course
from codegen.runs.track import Event, Settings
from codegen.stepping.going import Given, as_signals
from codegen.stepping.plan import PlainRow, Plan, Row


class NumpyGoing:
    """The event-driven loop in numpy."""

    backend = "numpy"

    def __init__(self, plan: Plan, settings: Settings) -> None:
        self._plan, self._settings = plan, settings
        self._course: Course | None = None
        self._paused: Paused | None = None
        self._row: Row | None = None
        self._signals: tuple[Signal, ...] = ()

    def under(self, given: Sequence[Given], t: float) -> None:
        """See `Going`."""
        del t
        self._signals = as_signals(given)

    def begin(self, t: float, s: Array, mode: Mode) -> Sequence[Event]:
        """See `Going`."""
        course = self._new(t, s, mode)
        with np.errstate(all="ignore"):
            self._paused, self._row = self._shown(course)
        self._course = course
        return course.track.events

    def advance(self, stop: float, anew: bool) -> Sequence[Event]:
        """See `Going`."""
        course, (arrived, present) = self._at
        course.under(self._signals)
        with np.errstate(all="ignore"):
            course.take_up(arrived if anew or not present.decided else present)
            course.on_to(stop)
            course.arrive()
            self._paused, self._row = self._shown(course)
        return course.track.events

    def row(self) -> Row:
        """See `Going`."""
        if self._row is None:
            course, (_, present) = self._at
            course.under(self._signals)
            course.take_up(present)
            self._row = _row_of(course)
        return self._row

    def paused(self) -> Paused:
        """See `Going`."""
        return self._at[1]

    def take_up(self, paused: Paused) -> None:
        """See `Going`."""
        if self._course is None:
            present = paused.present
            self._course = self._new(present.t, np.array(present.s), present.mode)
        self._paused, self._row = paused, None

    def _new(self, t: float, s: Array, mode: Mode) -> Course:
        return Course(self._plan.model, np.array([t]), s, self._signals, self._settings, mode)

    def _shown(self, course: Course) -> tuple[Paused, Row]:
        """Decide the instant at which a course has arrived, and look at it."""
        arrived = course.kept()
        course.settle()
        row = _row_of(course)
        self._plan.check(row)
        return Paused(arrived, course.kept()), row

    @property
    def _at(self) -> tuple[Course, Paused]:
        assert self._course is not None
        assert self._paused is not None
        return self._course, self._paused


def _row_of(course: Course) -> Row:
    now = course.look()
    values = np.concatenate([getattr(now, NAMES[part]) for part in RECORDED])
    return PlainRow(course.t, values.tolist(), course.mode)

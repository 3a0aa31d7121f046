"""A stepper of a model with delays: each advance goes part by part."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from bondgraph.errors import SignalError
from codegen.delays.course import Course, Make, Reached
from codegen.delays.readings import Reading
from codegen.inputs.signal import Signal
from codegen.runs.track import Event
from codegen.standalone.switchings import Clock
from codegen.stepping.going import as_signals
from codegen.stepping.known import Sources
from codegen.stepping.plan import Signals
from codegen.stepping.state import StepperState
from codegen.stepping.stepper import Stepper, refuse_unknown


@dataclass(frozen=True)
class LateState(StepperState):
    """Where such a stepper is, with what its delays have read: ``own`` is that of what it steps."""

    own: StepperState
    reached: Reached


class LateStepper(Stepper):
    """As `Stepper`; its inputs are those that no delay gives."""

    def __init__(self, make: Make, delays: Sequence[Reading], clocks: Sequence[Clock], inputs: Sequence[str],
                 sources: Sources, begin: float) -> None:  # fmt: skip
        self._ahead = sources
        self._course = Course(delays, clocks, self._known, begin, math.inf)
        self._inner = inner = make(self._course.told())
        self._origin = replace(inner.origin, inputs=tuple(inputs))
        self._time, self._late, self._events = inner.time, 0.0, inner.events
        self.completed = inner.completed

    @property
    def signals(self) -> Signals:
        """Every named signal at the present instant, just after what happens there."""
        return self._inner.signals

    @property
    def backend(self) -> str:
        """What runs it."""
        return self._inner.backend

    def give(self, **inputs: object) -> Signals:
        """Take these inputs from the present instant on, and stay there; every named signal under them."""
        self._refuse_unknown(inputs)
        before = len(self._inner.events)
        self._inner.give(**inputs)
        self._events += self._inner.events[before:]
        self._course.at = replace(self._course.at, smooth=False)
        return self.signals

    @property
    def state(self) -> LateState:
        """All that what follows rests on: frozen, and to be pickled."""
        own = self._inner.state
        return LateState(
            self._time, own.inputs, self._late, own.names, own.start, own.paused, self._events, own,
            self._course.at,
        )  # fmt: skip

    def restore(self, state: StepperState) -> None:
        """Be where a stepper of this model was; inputs are as they were there.

        Raises `SignalError` for what is no state of this model.
        """
        if not isinstance(state, LateState):
            raise SignalError(f"a stepper goes back to what its state was, not to {state!r}")
        self._inner.restore(state.own)
        self._course.at = state.reached
        self._time, self._late, self._events = state.time, state.late, state.events

    def _go(self, time: float, late: float, inputs: Mapping[str, object]) -> Signals:
        self._refuse_unknown(inputs)
        before, events = self.state, tuple[Event, ...]()
        try:
            if inputs:
                self._events = ()
                self.give(**inputs)
                events = self._events
            while self._course.at.t < time:
                events += self._course.go_on(self._inner, time)
        except BaseException:
            self.restore(before)
            raise
        self._time, self._late, self._events = time, late, events
        return self.signals

    def _known(self, t: float, end: float) -> Sequence[Signal]:
        """Inputs and sources, the latter as far as they are known."""
        self._ahead.reach(t, end)
        return (*as_signals(self._inner.given), *self._ahead.signals)

    def _refuse_unknown(self, inputs: Mapping[str, object]) -> None:
        for name in inputs:
            if name not in self._origin.inputs:
                refuse_unknown(name, self._origin.inputs)

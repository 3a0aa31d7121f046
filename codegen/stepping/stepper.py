"""`Stepper`: a model that is stepped from outside, under inputs that are told step by step."""

import math
from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import NoReturn

from bondgraph.errors import SignalError, nearest
from codegen.inputs.signals import Constant, as_signal
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import is_finite, is_number
from codegen.runs.completion import started
from codegen.runs.impulses import rated_inputs, refuse_step
from codegen.runs.track import Event
from codegen.stepping.going import Given, Going, as_signals
from codegen.stepping.known import Sources
from codegen.stepping.plan import Plan, Signals
from codegen.stepping.state import Start, StepperState


@dataclass(frozen=True)
class Origin:
    """What a stepper is made of: a model, the names of its inputs, what runs it, where it begins."""

    model: ClosedModel
    inputs: tuple[str, ...]
    plan: Plan
    going: Going
    time: float
    start: Start


class Stepper:
    """A model at one instant, stepped from outside: `advance` goes on under inputs that are told then.

    `Simulator.stepper` makes it. One advance after the other gives what one run gives whose inputs are held
    from step to step: the same events, and the same signals to its tolerance.

    >>> import bondgraph as bg
    >>> from codegen import simulator
    >>> mass = bg.graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v")],
    ...                 "force > mass > m")
    >>> stepper = simulator(bg.derive(mass), {"m": 2}).stepper(inputs={"F": 0})
    >>> [stepper.advance(0.5, F=force)["v"] for force in (4, 4, -8)]
    [1.0, 2.0, 0.0]
    >>> stepper.time, stepper.events
    (1.5, ())
    """

    def __init__(self, origin: Origin, given: Sequence[Given], sources: Sources) -> None:
        self._origin, self._given, self._sources = origin, plainly(given), sources
        self._going, self._time, self._late = origin.going, origin.time, 0.0
        self._start: Start | None = origin.start
        self._places = {name: at for at, name in enumerate(origin.inputs)}
        self._rated = rated_inputs(origin.model)
        #: The states that were not named and followed what switches held at first.
        self.completed, events = self._begin(origin.start)
        self._events = tuple(events)

    @property
    def time(self) -> float:
        """The present instant [s]."""
        return self._time

    @property
    def signals(self) -> Signals:
        """Every named signal at the present instant, just after what happens there."""
        return Signals(self._origin.plan, self._going.row())

    @property
    def events(self) -> tuple[Event, ...]:
        """What the latest advance came to, its end included, in order; nothing is told twice.

        Before the first what state machines did at the begin.
        """
        return self._events

    @property
    def given(self) -> tuple[Given, ...]:
        """The inputs that hold, in turn: numbers, or signals over the time."""
        return self._given

    @property
    def origin(self) -> Origin:
        """What it is made of, and where it began."""
        return self._origin

    @property
    def backend(self) -> str:
        """What runs it: what C cannot go on with numpy does, from there on."""
        return self._going.backend

    def advance(self, dt: float, /, **inputs: object) -> Signals:
        """Go on by ``dt`` [s]; every named signal at the new instant, just after what happens there.

        ``inputs``: numbers, or signals over the time, that hold from the present instant on. Those that are
        not named go on as they were.

        Raises `SignalError` for unusable arguments, `SimulationError` where the model can't go on;
        the stepper then is where it was.
        """
        time, late = self._later(dt)
        return self._go(time, late, inputs)

    def advance_to(self, time: float, /, **inputs: object) -> Signals:
        """As `advance`, on to a time [s] that is told itself: ticks and breakpoints there are met exactly.

        Raises what `advance` raises, and `SignalError` for a time that is not later.
        """
        if not is_number(time) or not self._time < time < math.inf:
            raise SignalError(f"from t = {self._time!r} s a step leads to no time {time!r}")
        return self._go(float(time), 0.0, inputs)

    def give(self, **inputs: object) -> Signals:
        """Take these inputs from the present instant on, and stay there; every named signal under them.

        What happens there under them is told by ``events``, beside what was told before.

        Raises what `advance` raises; the stepper then is where it was.
        """
        given = self._named(inputs)
        if given is self._given:
            return self.signals
        if self._rated:
            self._refuse_steps(given, self._time)
        self._going.under((*given, *self._sources.signals), self._time)
        try:
            events = self._renewed(given)
        except BaseException:
            self._going.under((*self._given, *self._sources.signals), self._time)
            raise
        self._given = given
        self._events += tuple(self._untold(events))
        return self.signals

    def _renewed(self, given: Sequence[Given]) -> Sequence[Event]:
        """Decide the present instant anew; what happens there."""
        if self._start is None:
            return self._going.advance(self._time, anew=True)
        before = self._going.paused()
        try:
            self._begin(self._start, given)
        except BaseException:
            self._going.take_up(before)
            raise
        return ()

    def _go(self, time: float, late: float, inputs: Mapping[str, object]) -> Signals:
        given = self._named(inputs) if inputs else self._given
        anew = given is not self._given
        reached = self._sources.reach(self._time, time)
        if self._rated:
            self._refuse_steps(given, time)
        if reached or anew:
            self._going.under((*given, *self._sources.signals), self._time)
        try:
            events = self._advanced(given, time, anew)
        except BaseException:
            if anew:
                self._going.under((*self._given, *self._sources.signals), self._time)
            raise
        if anew and events:
            events = self._untold(events)
        self._given, self._time, self._late, self._start = given, time, late, None
        self._events = tuple(events)
        return self.signals

    @property
    def state(self) -> StepperState:
        """All that what follows rests on: frozen, and to be pickled."""
        return StepperState(
            self._time, as_signals(self._given), self._late, self._names, self._start,
            self._going.paused(), self._events,
        )  # fmt: skip

    def restore(self, state: StepperState) -> None:
        """Be where a stepper of this model was; inputs are as they were there.

        Raises `SignalError` for what is no state of this model.
        """
        if not isinstance(state, StepperState):
            raise SignalError(f"a stepper goes back to what its state was, not to {state!r}")
        if state.names != self._names:
            raise SignalError(
                "this is the state of another model: its states, inputs and ports are "
                f"{state.names}, those here {self._names}"
            )
        self._sources.reach(state.time, state.time)
        self._going.under((*plainly(state.inputs), *self._sources.signals), state.time)
        self._going.take_up(state.paused)
        self._given, self._time, self._late = plainly(state.inputs), state.time, state.late
        self._start, self._events = state.start, state.events

    def _advanced(self, given: Sequence[Given], time: float, anew: bool) -> Sequence[Event]:
        if not anew or self._start is None:
            return self._going.advance(time, anew)
        # States were told for the instant before anything: under the inputs that hold from then on.
        before = self._going.paused()
        try:
            _, events = self._begin(self._start, given)
            return [*events, *self._going.advance(time, anew=False)]
        except BaseException:
            self._going.take_up(before)
            raise

    def _begin(
        self, start: Start, given: Sequence[Given] | None = None
    ) -> tuple[Mapping[str, float], Sequence[Event]]:
        """Be at the start: the states that were completed, and what happens there."""
        model, t = self._origin.model, self._time
        under = (*(self._given if given is None else given), *self._sources.signals)
        signals = as_signals(under)
        _, begun = started(model, t, dict(start.told), signals, start.on)
        self._going.under(under, t)
        return begun.completed, self._going.begin(t, begun.s, begun.mode)

    def _later(self, dt: float) -> tuple[float, float]:
        """The time after a step, and what its rounding leaves out: steps add up as if not rounded."""
        if not is_number(dt) or not 0.0 < dt < math.inf:
            raise SignalError(f"a step must be a positive number of seconds, not {dt!r}")
        begin = self._time
        time = begin + dt
        part = time - begin
        late = self._late + ((begin - (time - part)) + (dt - part))
        rounded = time + late
        if not begin < rounded < math.inf:
            raise SignalError(f"a step of {dt!r} s from t = {begin!r} s leads to no later time")
        return rounded, late - (rounded - time)

    def _named(self, inputs: Mapping[str, object]) -> tuple[Given, ...]:
        """All inputs with these in place of what they were; the same object if nothing is another."""
        given = list(self._given)
        changed = False
        for name, value in inputs.items():
            at = self._places.get(name)
            if at is None:
                refuse_unknown(name, self._origin.inputs)
            told = told_input(value, name)
            changed |= told != given[at]
            given[at] = told
        return tuple(given) if changed else self._given

    def _refuse_steps(self, given: Sequence[Given], time: float) -> None:
        sources = self._sources.signals
        before, after = as_signals(self._given) + sources, as_signals(given) + sources
        for at, where in self._rated.items():
            old = after[at] if self._start is not None else before[at]
            refuse_step(self._origin.model, at, where, old, after[at], (self._time, time))

    def _untold(self, events: Sequence[Event]) -> list[Event]:
        """Without what was told of the present instant before it was decided anew."""
        told = Counter((e.port, e.kind) for e in self._events if e.time == self._time)
        found = list[Event]()
        for event in events:
            key = event.port, event.kind
            if event.time == self._time and told[key]:
                told[key] -= 1
            else:
                found.append(event)
        return found

    @property
    def _names(self) -> tuple[tuple[Hashable, ...], ...]:
        program = self._origin.model.program
        states = tuple(name.name for name in (*program.states, *program.law_states))
        return states, self._origin.inputs, tuple(port.name for port in program.friction)


def refuse_unknown(name: str, inputs: Sequence[str]) -> NoReturn:
    """Refuse an input that a model does not have; `SignalError`."""
    told = f"unknown input {name!r}{nearest(name, inputs)}"
    raise SignalError(f"{told}; the model's inputs are {', '.join(inputs) or 'none'}")


def plainly(given: Sequence[Given]) -> tuple[Given, ...]:
    """Inputs, constants as numbers."""
    return tuple(float(one.value) if isinstance(one, Constant) else one for one in given)


def told_input(value: object, name: str) -> Given:
    """A number as it is, or a signal; `SignalError` for anything else."""
    if type(value) is float and math.isfinite(value):
        return value
    if is_number(value) and is_finite(value):
        return float(value)
    return as_signal(value, name)

"""A model of ours as a participant: a stepper, and what it went through."""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import sympy as sp

from bondgraph.errors import SignalError
from codegen.cosimulation.feeds import Feeds
from codegen.cosimulation.instants import meets
from codegen.cosimulation.part import Given
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Ramp
from codegen.numbers.arrays import Array, is_finite, is_number
from codegen.program.units import told_units
from codegen.runs.track import Event, Settings
from codegen.simulator import Simulator
from codegen.stepping.plan import Row
from codegen.stepping.stepper import Stepper
from codegen.switched.simulator import SwitchedSimulator


class ModelPart:
    """A simulator, by its stepper. ``given``: signals of inputs that are not connected."""

    def __init__(
        self, name: str, origin: Simulator | SwitchedSimulator, given: Mapping[str, object],
        initial: Mapping[str, float], on: Iterable[Hashable], settings: Settings,
    ) -> None:  # fmt: skip
        self.name, self.origin = name, origin
        self.simulator = origin.simulator if isinstance(origin, SwitchedSimulator) else origin
        self.inputs, self.open = self.simulator.inputs, dict(given)
        self.settings, self.time = settings, 0.0
        self.rows, self._events = list[Row](), list[Event]()
        #: Of each connected input what it was from each instant on.
        self.held: dict[str, list[Given]] = {}
        self._initial, self._on = initial, tuple(on)
        self._stepper: Stepper | None = None
        self._feeds: Feeds | None = None
        self._now, self._told = dict[str, Given](), 0

    def pace(self, start: sp.Rational, every: sp.Rational) -> None:
        """Know the communication points, and so which controllers work at them."""
        tasks = self.simulator.closed.equations.tasks
        self._feeds = Feeds(
            self.simulator.closed, [one for one in tasks if meets(one, start, every)]
        )

    def fed(self, signal: str, first: bool) -> frozenset[str]:
        """See `Part`."""
        del first
        assert self._feeds is not None
        return self._feeds.of(signal) - self.open.keys()

    def certain(self, first: bool) -> bool:
        """See `Part`."""
        del first
        return True

    def begin(self, time: float) -> None:
        """See `Part`. A connected input is 0, or what was told of it, until it is given."""
        free = [name for name in self.inputs if name not in self.open]
        first = {name: number_of(self._initial.get(name, 0.0), name) for name in free}
        states = {name: value for name, value in self._initial.items() if name not in first}
        self._now = {name: Given(value) for name, value in first.items()}
        self.held = {name: [] for name in free}
        method, rtol, atol = self.settings.method, self.settings.rtol, self.settings.atol
        self._stepper = self.origin.stepper(
            states, {**self.open, **first}, time=time, method=method, rtol=rtol, atol=atol,
            initially_on=self._on,
        )  # fmt: skip
        self.time = time

    def give(self, given: Mapping[str, Given]) -> bool:
        """See `Part`."""
        changed = {name: one for name, one in given.items() if one != self._now[name]}
        if changed:
            self._now.update(changed)
            self.stepper.give(**{name: _line(one, self.time) for name, one in changed.items()})
            self._listen()
        return bool(changed)

    def ready(self) -> None:
        """See `Part`."""

    def read(self, signal: str) -> float:
        """See `Part`."""
        try:
            return self.stepper.signals[signal]
        except KeyError as error:
            raise SignalError(str(error.args[0])) from None

    def keep(self) -> None:
        """See `Part`."""
        self.rows.append(self.stepper.signals.row)
        for name, one in self._now.items():
            self.held[name].append(one)

    def advance(self, stop: float) -> None:
        """See `Part`."""
        self.stepper.advance_to(stop)
        self.time, self._told = stop, 0
        self._listen()

    @property
    def stepper(self) -> Stepper:
        """What steps it."""
        assert self._stepper is not None
        return self._stepper

    @property
    def columns(self) -> Mapping[str, Array]:
        """See `Part`."""
        return self.stepper.origin.plan.columns(self.rows)[0]

    @property
    def units(self) -> Mapping[str, str]:
        """See `Part`."""
        return told_units(self.simulator.closed.equations)

    @property
    def events(self) -> tuple[Event, ...]:
        """See `Part`."""
        return tuple(self._events)

    def _listen(self) -> None:
        """Note what happened since the last time."""
        self._events += self.stepper.events[self._told :]
        self._told = len(self.stepper.events)


def _line(given: Given, time: float) -> float | Signal:
    return given.value if given.slope == 0.0 else Ramp(time, given.slope, given.value)


def number_of(value: object, name: str) -> float:
    """A number that an input begins with; `SignalError` for anything else."""
    if not is_number(value) or not is_finite(value):
        raise SignalError(f"initial {name}: {value!r} is not a finite number")
    return float(value)


def checked_initial(initial: Any, name: str) -> Mapping[str, float]:
    """Initial values of a participant by name; `SignalError` for anything else."""
    if not isinstance(initial, Mapping):
        raise SignalError(
            f"initial of {name!r} must map names to numbers, not be {initial!r}; where a coupled model rests "
            "depends on the others"
        )
    return initial

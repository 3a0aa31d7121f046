"""What the delays of a model give in a run: the run is stepped, each part under what is known of them.

A part is no longer than the shortest delay, so that what it reads of the past is known (the method of
steps: Bellen, Zennaro 2003, section 3.4). It ends at whatever is not smooth: an event, an instant of a
task, a breakpoint of an input or of a delay; so jumps and corners travel on as what they are.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.nodes.lagging import Lagging
from codegen.delays.history import CHECKS, History, missed, nodes
from codegen.inputs.signal import Pieced, Signal
from codegen.model.exact_values import at_parameters
from codegen.model.lags import lags
from codegen.numbers.lambdified import lambdified
from codegen.program.records import Program
from codegen.standalone.switchings import Clock
from codegen.stepping.stepper import Stepper
from codegen.tuning import TUNING

Make = Callable[[Mapping[str, object]], Stepper]
"""A stepper at the begin of the run, under these inputs for what delays give."""


@dataclass(frozen=True)
class Reading:
    """A delay with numbers: its name, how late [s], its start, and what it reads of signals by name."""

    name: str
    late: float
    start: float
    value: Callable[[Mapping[str, float]], float]


def readings(
    delays: Sequence[Lagging], parameters: Mapping[str, sp.Rational]
) -> tuple[Reading, ...]:
    """The delays with numbers for their parameters.

    Raises what `lags` raises.
    """
    found = []
    for one, (late, start) in zip(delays, lags(delays, parameters), strict=True):
        value = at_parameters(one.value, parameters)
        names = sorted(map(str, value.free_symbols))
        function = lambdified([sp.Symbol(name) for name in names], [value])
        found.append(Reading(one.given.name, late, start, _by_name(function, names)))
    return tuple(found)


def _by_name(function: Callable[..., object], names: Sequence[str]) -> Callable[..., float]:
    def value(now: Mapping[str, float]) -> float:
        return float(np.asarray(function(*(now[name] for name in names))).ravel()[0])

    return value


def found(
    program: Program, delays: Sequence[Reading], make: Make, signals: Sequence[Signal],
    begin: float, end: float,
) -> dict[str, Pieced]:  # fmt: skip
    """A signal of what each delay gives from ``begin`` to ``end`` [s], to rounding of what it reads."""
    course = _Course(delays, make, [*signals], program.clocks, begin, end)
    while course.t < end:
        course.go_on()
    return course.told()


class _Course:
    """Where the stepping is, and what has been read."""

    def __init__(
        self, delays: Sequence[Reading], make: Make, signals: list[Signal], clocks: Sequence[Clock],
        begin: float, end: float,
    ) -> None:  # fmt: skip
        self.t, self._end, self._delays = begin, end, delays
        self._histories = [History(begin, one.late, one.start) for one in delays]
        self._stepper = make(self.told())
        self._signals, self._clocks = signals, clocks
        self._length, self._smooth = end - begin, False
        self._sizes = np.zeros(len(delays))

    def told(self) -> dict[str, Pieced]:
        """What each gives as far as it is known."""
        pairs = zip(self._delays, self._histories, strict=True)
        return {one.name: history.signal() for one, history in pairs}

    def go_on(self) -> None:
        """One part, halved until polynomials tell what was read in it."""
        limit = self._limit()
        if limit - self.t <= 16 * self._least(limit):
            self._over(limit)
            return
        kept, length = self._stepper.state, min(self._length, limit - self.t)
        while True:
            stop = limit if length >= limit - self.t else self.t + length
            values, checks, event = self._read(stop)
            if event is not None:
                self._stepper.restore(kept)
                length = event - self.t
                if length <= 16 * self._least(event):
                    self._over(event)
                    return
                limit = event
                continue
            wrong = [missed(row, check) for row, check in zip(values, checks, strict=True)]
            self._sizes = np.maximum(self._sizes, np.abs(values).max(axis=1))
            if (np.array(wrong) <= TUNING.delayed * self._sizes + TUNING.tiny).all():
                break
            if length <= self._least(stop) * 1024:
                break
            self._stepper.restore(kept)
            length = 0.5 * (stop - self.t)
        for history, row in zip(self._histories, values, strict=True):
            history.take(self.t, stop, row, self._smooth)
        self._smooth, self._length = stop < limit, 2 * (stop - self.t)
        self.t = stop

    def _least(self, t: float) -> float:
        return 4 * float(np.spacing(max(abs(t), self._end - self.t)))

    def _limit(self) -> float:
        """How far nothing happens that is known of: the end of what delays have read, and breakpoints."""
        ahead = [self.t + one.late for one in self._delays]
        ahead += [clock.following(self.t) for clock in self._clocks]
        ahead += [signal.following(self.t) for signal in self._signals]
        ahead += [history.following(self.t) for history in self._histories]
        return min(*ahead, self._end)

    def _read(self, stop: float) -> tuple[np.ndarray, np.ndarray, float | None]:
        """What is read at the nodes and between; the first event before the end, where there is one."""
        begin, told = self.t, self.told()
        places = np.concatenate([nodes(), CHECKS])
        order = np.argsort(places)
        rows = np.zeros((len(self._delays), len(places)))
        for at in order.tolist():
            event = self._advance(begin + places[at] * (stop - begin), told)
            if event is not None:
                return rows, rows, event
            told = {}
            now = {**self._stepper.signals, "t": self._stepper.time}
            rows[:, at] = [one.value(now) for one in self._delays]
        event = self._advance(stop, told)
        if event is not None and event < stop - self._least(stop):
            return rows, rows, event
        return rows[:, : len(nodes())], rows[:, len(nodes()) :], None

    def _advance(self, stop: float, told: Mapping[str, object]) -> float | None:
        """Go on to a time; when the first event was that came."""
        step = stop - self._stepper.time
        if step <= 0 and not told:
            return None
        self._stepper.advance(max(step, 0.0), **told)
        events = [one.time for one in self._stepper.events if one.time > self.t]
        return min(events, default=None)

    def _over(self, instant: float) -> None:
        """Over what is no more than a rounding ahead."""
        self._advance(instant, self.told())
        self.t, self._smooth = max(instant, self._stepper.time), False

"""A run with delays, part by part: each is stepped under what is known of them, and tells what they read.

A part is no longer than the shortest delay, so that what it reads of the past is known (the method of
steps: Bellen, Zennaro 2003, section 3.4). It ends at whatever is not smooth: an event, an instant of a
task, a breakpoint of an input or of a delay; so jumps and corners travel on as what they are.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.delays.history import CHECKS, Past, begun, missed, nodes
from codegen.delays.readings import Reading
from codegen.inputs.signal import Pieced, Signal
from codegen.numbers.arrays import Array
from codegen.runs.track import Event
from codegen.standalone.switchings import Clock
from codegen.stepping.stepper import Stepper
from codegen.tuning import TUNING

Known = Callable[[float, float], Sequence[Signal]]
"""Inputs and sources, as far as they are known between two times [s]."""


Make = Callable[[Mapping[str, Pieced]], Stepper]
"""A stepper of which what delays give are inputs as well, under these for them."""


@dataclass(frozen=True)
class Reached:
    """How far a run has come: its time [s], and of each delay what it has read and the largest of it.

    ``length`` [s]: how long the next part is tried; ``smooth``: whether it goes on from the one before.
    """

    t: float
    pasts: tuple[Past, ...]
    sizes: tuple[float, ...]
    length: float
    smooth: bool = False


@dataclass(frozen=True)
class _Read:
    """A part that was stepped: what was read at the nodes and between, what happened, and when first."""

    values: Array
    checks: Array
    events: tuple[Event, ...]
    event: float | None


class Course:
    """Where the stepping is. A call that fails leaves it in between: who calls goes back to ``at``."""

    def __init__(
        self, delays: Sequence[Reading], clocks: Sequence[Clock], known: Known, begin: float, length: float
    ) -> None:  # fmt: skip
        self._delays, self._clocks, self._known = delays, clocks, known
        pasts = tuple(begun(one.lag, begin) for one in delays)
        self.at = Reached(begin, pasts, tuple(0.0 for _ in delays), length)

    def told(self) -> dict[str, Pieced]:
        """What each delay gives as far as it is known, from the present instant on."""
        pairs = zip(self._delays, self.at.pasts, strict=True)
        return {one.name: past.since(self.at.t).signal() for one, past in pairs}

    def go_on(self, stepper: Stepper, end: float) -> tuple[Event, ...]:
        """One part, no farther than ``end`` [s], halved until polynomials tell what was read; its events."""
        t, limit = self.at.t, self._limit(end)
        kept, length = stepper.state, min(self.at.length, limit - t)
        least = 4 * float(np.spacing(max(abs(t), abs(end))))
        while limit - t > 16 * least:
            stop = limit if length >= limit - t else t + length
            read = self._read(stepper, stop, least)
            if read.event is not None:
                limit = read.event
            elif self._is_told(read) or length <= 1024 * least:
                self._take(stop, read, limit)
                return read.events
            stepper.restore(kept)
            length = limit - t if read.event is not None else 0.5 * (stop - t)
        return self._over(stepper, limit)

    def _limit(self, end: float) -> float:
        """How far nothing happens that is known of: the end of what delays have read, and breakpoints."""
        t = self.at.t
        ahead = [t + past.late for past in self.at.pasts]
        ahead += [clock.following(t) for clock in self._clocks]
        ahead += [signal.following(t) for signal in self._known(t, end)]
        ahead += [past.following(t) for past in self.at.pasts]
        return min(*ahead, end)

    def _read(self, stepper: Stepper, stop: float, least: float) -> _Read:
        """What is read at the nodes and between; the first event before the end, where there is one."""
        begin, told = self.at.t, self.told()
        places = np.concatenate([nodes(), CHECKS])
        rows, events = np.zeros((len(self._delays), len(places))), list[Event]()
        for at in np.argsort(places).tolist():
            events += _advanced(stepper, begin + places[at] * (stop - begin), told)
            if first := [one.time for one in events if one.time > begin]:
                return _Read(rows, rows, (), min(first))
            told = {}
            now = {**stepper.signals, "t": stepper.time}
            rows[:, at] = [one.value(now) for one in self._delays]
        events += _advanced(stepper, stop, told)
        early = [one.time for one in events if begin < one.time < stop - least]
        values, checks = rows[:, : len(nodes())], rows[:, len(nodes()) :]
        return _Read(values, checks, tuple(events), min(early, default=None))

    def _is_told(self, read: _Read) -> bool:
        wrong = [missed(*both) for both in zip(read.values, read.checks, strict=True)]
        return bool((np.array(wrong) <= TUNING.delayed * self._largest(read) + TUNING.tiny).all())

    def _largest(self, read: _Read) -> Array:
        return np.asarray(np.maximum(self.at.sizes, np.abs(read.values).max(axis=1)))

    def _take(self, stop: float, read: _Read, limit: float) -> None:
        t, turns = self.at.t, not self.at.smooth
        sizes = tuple(self._largest(read).tolist())
        rows = zip(self.at.pasts, read.values, sizes, strict=True)
        pasts = tuple(past.since(t).taken(t, stop, row, turns, size) for past, row, size in rows)
        # A part that ended where it had to tells nothing of how long others may be.
        length = 2 * (stop - t) if stop < limit else max(2 * (stop - t), self.at.length)
        self.at = Reached(stop, pasts, sizes, length, stop < limit)

    def _over(self, stepper: Stepper, instant: float) -> tuple[Event, ...]:
        """Over what is no more than a rounding ahead."""
        events = _advanced(stepper, instant, self.told())
        self.at = replace(self.at, t=max(instant, stepper.time), smooth=False)
        return tuple(events)


def _advanced(stepper: Stepper, stop: float, told: Mapping[str, Pieced]) -> tuple[Event, ...]:
    """Go on to a time under what delays give; what happened."""
    if told:
        before = len(stepper.events)
        stepper.give(**told)
        events = stepper.events[before:]
    else:
        events = ()
    if stop > stepper.time:
        stepper.advance_to(stop)
        events += stepper.events
    return events

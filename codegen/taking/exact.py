"""Exact runs in C whose samples and events are taken while they go on."""

from collections.abc import Sequence

import numpy as np

from codegen.engine.happened import told_events
from codegen.engine.runs import CRuns, Outcome, Prepared
from codegen.engine.status import Status
from codegen.inputs.signal import Signal
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.runs.track import BLOCK, Event, Taker

MOST_EVENTS = 2 * BLOCK
"""Events there is room for at the most; half of that are taken at a time."""


def run_exact(
    engine: CRuns, taker: Taker, times: Array, start: Array, signals: Sequence[Signal], first: Mode,
    keeping: bool, patient: bool,
) -> Outcome:  # fmt: skip
    """A run by the engine, all that it records to ``taker``; how it ended.

    ``first``: the mode before the run, all let go unless told. ``keeping``: whether events are kept.
    ``patient``: whether to go on although tables of modes take longer than other ways.
    """
    prepared = engine.prepare(times, start, signals, first, keeping, patient, BLOCK + 1)
    taking = _Taking(prepared, engine.model, taker)
    with prepared.handing.to(taking.take):
        status = prepared.call(taking.begin)
    engine.expect(min(prepared.capacity, MOST_EVENTS))
    if status == Status.OK and not taking.end():
        status = Status.UNTAKEN
    # Nothing else is not taken without an error.
    status = Status.NOT_FINITE if status == Status.UNTAKEN else status
    return Outcome(status, prepared.task.time)


class _Taking:
    """Passes on what a run hands over, as vectors, modes and events."""

    def __init__(self, prepared: Prepared, model: ClosedModel, taker: Taker) -> None:
        self._prepared, self._model, self._taker = prepared, model, taker
        handing, task = prepared.handing, prepared.task
        if handing.call is not None:
            task.room, task.full = len(prepared.rows), handing.call

    def begin(self) -> None:
        """The run begins, perhaps once more."""
        self._left = len(self._prepared.times)
        self._largest = np.zeros(self._model.size)
        self._taker.begin()

    def end(self) -> bool:
        """Take what is left; whether it could be taken."""
        prepared = self._prepared
        return self.take(self._left, prepared.task.count if prepared.keeping else 0)

    def take(self, samples: int, events: int) -> bool:
        """Take so many; not where a number is not finite."""
        if events:
            self._taker.happened(self._told(events))
        vectors = self._prepared.rows[:samples, : self._model.size]
        if not np.isfinite(vectors).all():
            return False
        if samples:
            known = self._prepared.tables.places.known
            modes = [known[place] for place in self._prepared.modes[:samples].tolist()]
            self._largest = np.maximum(self._largest, np.abs(vectors).max(axis=0))
            self._left -= samples
            self._taker.take(vectors, modes, self._largest)
        return True

    def _told(self, count: int) -> list[Event]:
        """The first events; there is room for more from then on."""
        prepared, program = self._prepared, self._model.program
        names = program.happening, program.taken
        told = told_events(prepared.engine.ffi, prepared.events, count, *names)
        if prepared.capacity < MOST_EVENTS:
            prepared.capacity = min(8 * prepared.capacity, MOST_EVENTS)
            prepared.make_room()
        return told

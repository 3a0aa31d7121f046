"""Runs in C with located events whose samples and events are taken while they go on."""

from typing import Any

import numpy as np

from codegen.engine.fallback import Stopped
from codegen.engine.happened import told_events
from codegen.engine.located import FEW, MANY, UNBOUNDED, LocatedRuns
from codegen.engine.runs import NO_END
from codegen.engine.status import Status
from codegen.inputs.tables import NO_TABLE, has_table
from codegen.runs.track import BLOCK
from codegen.taking.asked import Request
from codegen.taking.blocks import Sink
from codegen.taking.exact import MOST_EVENTS


def run_located(runs: LocatedRuns, sink: Sink, asked: Request) -> Stopped | None:
    """A run into a sink; or why it could not go on."""
    if not has_table(asked.signals):
        return Stopped(NO_TABLE, limit=True)
    taking = _Taking(runs, sink, asked)
    status, room = int(Status.EVENTS), FEW
    # Room that is full is emptied on the way; more is asked for by an instant that fills it alone.
    while status == Status.EVENTS and room <= MANY:
        status = taking.call(room)
        room *= 16
    if status == Status.OK and taking.end():
        return None
    return (
        Stopped(UNBOUNDED) if status in (0, Status.UNTAKEN) else runs.stopped(taking.asking, status)
    )


class _Taking:
    """Passes on what a run hands over."""

    def __init__(self, runs: LocatedRuns, sink: Sink, asked: Request) -> None:
        self._runs, self._sink, self._asked = runs, sink, asked
        self.asking = runs.asking(
            asked.times,
            asked.states,
            asked.signals,
            asked.settings,
            asked.begun.mode,
            asked.corners,
        )
        room, handing = len(asked.times), runs.handing
        if handing.call is not None:
            room = min(room, BLOCK)
        self._table = np.empty((room, runs.width))
        self._rows = runs.rows(self._table)
        if handing.call is not None:
            self._rows.full = handing.call

    def call(self, room: int) -> int:
        """Run, with room for so many events; the status."""
        self._make_room(room)
        self._left = len(self._asked.times)
        self._sink.begin()
        with self._runs.handing.to(self.take):
            return self._runs.call(self.asking, self._rows)

    def _make_room(self, room: int) -> None:
        """Make room for so many events."""
        ffi, keeping = self._runs.library.opened[0], self._asked.events
        self._room, record = room, self.asking.record
        self._events: Any = ffi.new("bg_event[]", room) if keeping else ffi.NULL
        record.events, record.capacity = self._events, room if keeping else NO_END

    def end(self) -> bool:
        """Take what is left; whether it could be taken."""
        return self.take(self._left, self.asking.record.count if self._asked.events else 0)

    def take(self, samples: int, events: int) -> bool:
        """Take so many; not where a number is not finite."""
        program = self._runs.model.program
        if events:
            ffi, names = self._runs.library.opened[0], (program.happening, program.taken)
            self._sink.happened(told_events(ffi, self._events, events, *names))
            if self._room < MOST_EVENTS:
                self._make_room(min(8 * self._room, MOST_EVENTS))
        rows = self._table[:samples].copy()
        if not np.isfinite(rows[:, : self._runs.finite]).all():
            return False
        if samples:
            self._left -= samples
            self._sink.take(*self._runs.told(rows))
        return True

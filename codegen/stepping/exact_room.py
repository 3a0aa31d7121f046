"""What an exact run works in that pauses: an engine, the modes of a model, buffers that are made once."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from codegen.engine.fallback import Stopped
from codegen.engine.happened import told_events
from codegen.engine.modes import Tables
from codegen.engine.packed import Packed
from codegen.engine.runs import CAPACITY, LIMITS, MEANINGS, MOST_AT_FIRST
from codegen.engine.sizes import Engine, aligned
from codegen.engine.status import Status
from codegen.model.kept import Paused
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.runs.track import Event
from codegen.stepping.carried import Carried
from codegen.stepping.going import GaveUpError


class ExactRoom:
    """One engine's: calls of C that pause a run, from one buffer to another."""

    def __init__(self, engine: Engine, model: ClosedModel, patient: bool) -> None:
        self.engine, self._ffi, self._library = engine, engine.ffi, engine.library
        self._names, self._taken = model.program.happening, model.program.taken
        self._tables, self._context = Tables(engine, model), engine.context()
        self._tables.record.most = 0 if patient else self._tables.places.few
        sizes, told = engine.sizes.numbers, self._ffi.new("unsigned long[2]")
        self._library.ex_paused_sizes(told)
        self._length, self._width = sizes["L"], told[1] // 8
        self._from, self._to = (self._buffer(told[0] // 8) for _ in range(2))
        self._times, self._start = np.zeros(2), np.zeros(sizes["N"])
        self._first = np.ones(sizes["PORTS"], dtype=np.intc)
        self._rows, self._modes = aligned(2, sizes["ROW"]), np.zeros(2, dtype=np.intc)
        self._task = self._tasked()
        self._capacity = CAPACITY
        self._make_room()
        self._carried = Carried(
            model, sizes["N"], sizes["X"], sizes["U"], self._reached(), sizes["PORTS"]
        )

    def begin(self, inputs: Packed, t: float, s: Array, mode: Mode) -> None:
        """Be at the beginning of a run in the buffer that is next."""
        self._times[:] = t
        self._start[:], self._first[: len(mode)] = s, mode
        self._task.times = self._ffi.cast("double *", self._times.ctypes.data)
        self._call(self._library.ex_pause_first, inputs, self._to[1])

    def go(self, inputs: Packed, stop: float, anew: bool, renewed: bool) -> Sequence[Event]:
        """Go on from one buffer to the next; what happens."""
        ends = self._from[1], self._to[1]
        self._call(self._library.ex_pause_next, inputs, *ends, stop, anew, renewed)
        return self.told()

    def told(self) -> Sequence[Event]:
        """What the latest call says has happened."""
        count = self._task.count
        told = self._names, self._taken
        return told_events(self._ffi, self._events, count, *told) if count else ()

    def take_up(self, inputs: Packed, paused: Paused) -> None:
        """Be in the buffer that is next where a run has paused."""
        numbers = self._carried.numbers(paused)
        self._library.ex_pause_carry(self._to[1], self._pointer(numbers), 1)
        self._call(self._library.ex_pause_look, inputs, self._to[1])

    def come(self) -> tuple[Mode, Array]:
        """The mode in the buffer that is next, and what maps act on there."""
        return self._tables.places.known[self._modes.item(0)], self._to[0][: self._length].copy()

    def commit(self) -> None:
        """What is in the next buffer is where the run is."""
        self._from, self._to = self._to, self._from

    def paused(self) -> Paused:
        """Where the run is."""
        numbers = np.empty(self._width)
        self._library.ex_pause_carry(self._from[1], self._pointer(numbers), 0)
        return self._carried.told(numbers)

    def _call(self, function: Callable[..., int], inputs: Packed, *more: Any) -> None:
        """Call as often as it takes to supply modes and room for events."""
        tables = self._tables
        context = self._context[1]
        while status := function(context, tables.record, inputs.record, self._task, *more):
            if (failed := tables.failed or inputs.failed) is not None:
                tables.failed = inputs.failed = None
                raise failed
            if status == Status.MISSING and tables.room:
                tables.supply(tables.mode_at(self._task.where))
            elif status == Status.BLUNT:
                tables.sharpen()
            elif status == Status.EVENTS and self._capacity < MOST_AT_FIRST:
                self._capacity *= 8
                self._make_room()
            else:
                told = Status(status)
                stopped = Stopped(MEANINGS[told], self._task.time, told in LIMITS)
                raise GaveUpError(stopped, told == Status.ENDLESS)

    def _tasked(self) -> Any:
        task, ffi = self.engine.new("ex_task"), self._ffi
        task.samples, task.start = 2, self._pointer(self._start)
        task.first = ffi.cast("int *", self._first.ctypes.data)
        task.modes = ffi.cast("int *", self._modes.ctypes.data)
        width = self.engine.sizes.numbers["ROW"]
        task.rows = ffi.cast(f"double(*)[{width}]", self._rows.ctypes.data)
        return task

    def _make_room(self) -> None:
        self._events = self._ffi.new("bg_event[]", self._capacity)
        self._task.events, self._task.capacity = self._events, self._capacity

    def _buffer(self, count: int) -> tuple[Array, Any]:
        room = aligned(count + 1)
        room[:] = 0.0
        return room, self._ffi.cast("ex_paused *", room.ctypes.data)

    def _pointer(self, numbers: Array) -> Any:
        return self._ffi.cast("double *", numbers.ctypes.data)

    def _reached(self) -> tuple[int, ...]:
        """Of each port the displacement that stops it, -1 of others: C keeps how far that has been."""
        model, record = self._tables.model, self._tables.record
        stops = set(model.stopping)
        return tuple(
            record.switches[i].place if i in stops else -1 for i in range(len(self._names))
        )

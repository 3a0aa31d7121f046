"""A run by the generated C of a model that pauses, and goes on from there."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from codegen.engine.fallback import Stopped
from codegen.engine.happened import told_events
from codegen.engine.located import FEW, MANY, METHODS, LocatedRuns, packed_signals
from codegen.engine.sizes import aligned
from codegen.engine.status import Status
from codegen.inputs.tables import NO_TABLE, has_table, signal_table
from codegen.model.kept import Paused
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.runs.track import Event, Settings
from codegen.stepping.carried import Carried
from codegen.stepping.going import GaveUpError, Given, as_signals, only_numbers
from codegen.stepping.plan import PlainRow, Plan, Row


class LocatedGoing:
    """Steps with a tolerance in C; `GaveUpError` where it cannot go on."""

    backend = "c"

    def __init__(self, plan: Plan, runs: LocatedRuns, settings: Settings) -> None:
        self._plan, self._runs, model = plan, runs, runs.model
        self._ffi, self._library = runs.library.opened
        instance, run = runs.library.sizes
        self._kept = aligned(instance), aligned(run)
        self._model = self._ffi.cast("bg_model *", self._kept[0].ctypes.data)
        self._run = self._ffi.cast("bg_located *", self._kept[1].ctypes.data)
        self._kept[0][:], self._kept[1][:] = 0.0, 0.0
        told = self._ffi.new("unsigned long[2]")
        self._library.bg_paused_sizes(told)
        self._width, self._told = told[1] // 8, sum(plan.widths)
        self._from, self._to = (self._buffer(told[0] // 8) for _ in range(2))
        self._first = np.ones(max(len(model.program.friction), 1), dtype=np.intc)
        self._asked, self._capacity = self._ffi.new("bg_request *"), FEW
        self._asked.method = METHODS.index(settings.method)
        self._asked.rtol, self._asked.atol = settings.rtol, settings.atol
        self._asked.first = self._ffi.cast("int *", self._first.ctypes.data)
        self._make_room()
        program, size = model.program, model.size
        states, inputs = max(len(program.states), 1), max(len(program.inputs), 1)
        self._carried = Carried(model, size, states, inputs, tuple(range(size)))
        self._given, self._places = tuple[Given, ...](), dict[int, list[int]]()
        self._signals: Any = None
        self._row: Row | None = None
        self._check(self._library.bg_pause_make(self._model, self._pointer(runs.parameters)))

    def under(self, given: Sequence[Given], t: float) -> None:
        """See `Going`."""
        numbers = only_numbers(self._given, given)
        self._given = tuple(given)
        if self._signals is None or numbers is None or not numbers.keys() <= self._places.keys():
            self._pack(t)
            return
        for at, value in numbers.items():
            self._coefficients[self._places[at], 0] = value

    def begin(self, t: float, s: Array, mode: Mode) -> Sequence[Event]:
        """See `Going`."""
        self._first[: len(mode)] = mode
        start = np.ascontiguousarray(s)
        self._call(self._library.bg_pause_first, self._to[1], t, self._pointer(start))
        self._commit(t)
        return self._happened()

    def advance(self, stop: float, anew: bool) -> Sequence[Event]:
        """See `Going`."""
        self._call(self._library.bg_pause_next, self._from[1], self._to[1], stop, anew)
        self._commit(stop)
        return self._happened()

    def _happened(self) -> Sequence[Event]:
        """What the latest call says has happened."""
        count = self._asked.count
        program = self._runs.model.program
        told = program.happening, program.taken
        return told_events(self._ffi, self._events, count, *told) if count else ()

    def row(self) -> Row:
        """See `Going`."""
        assert self._row is not None
        return self._row

    def paused(self) -> Paused:
        """See `Going`."""
        numbers = np.empty(self._width)
        self._library.bg_pause_carry(self._from[1], self._pointer(numbers), 0)
        return self._carried.told(numbers)

    def take_up(self, paused: Paused) -> None:
        """See `Going`."""
        numbers = self._carried.numbers(paused)
        self._library.bg_pause_carry(self._to[1], self._pointer(numbers), 1)
        self._call(self._library.bg_pause_look, self._to[1])
        self._commit(paused.present.t)

    def _commit(self, t: float) -> None:
        """The run is where it has come to, unless a signal is refused there."""
        values = self._to[0][: self._told].tolist()
        mode = self._to[0][self._told : self._told + self._ports].astype(int).tolist()
        row = PlainRow(t, values, tuple(mode))
        if (
            not math.isfinite(sum(values))
            and not np.isfinite(values[: self._runs.model.size]).all()
        ):
            raise GaveUpError(Stopped("a number of the run is not finite", t))
        self._plan.check(row)
        self._from, self._to, self._row = self._to, self._from, row

    def _call(self, function: Any, *more: Any) -> None:
        """Call as often as it takes to have room for events."""
        signals = self._signals[0]
        while status := function(self._run, self._model, signals, self._asked, *more):
            if status != Status.EVENTS or self._capacity >= MANY:
                self._check(status)
            self._capacity *= 16
            self._make_room()

    def _check(self, status: int) -> None:
        if status:
            reason = self._ffi.string(self._library.bg_model_message(status)).decode()
            stopped = Stopped(reason, float(self._asked.time), status == Status.EVENTS)
            raise GaveUpError(stopped)

    def _pack(self, t: float) -> None:
        """All inputs anew, from t [s] on."""
        signals = as_signals(self._given)
        if not has_table(signals):
            raise GaveUpError(Stopped(NO_TABLE, limit=True))
        table = signal_table(signals, t, math.inf)
        self._signals = packed_signals(self._ffi, table)
        self._coefficients = self._signals[1][4]
        self._places = {at: [] for at, one in enumerate(self._given) if isinstance(one, float)}
        for at, first, _, _, _ in table.terms:
            if at in self._places:
                self._places[at].append(first)

    @property
    def _ports(self) -> int:
        return len(self._runs.model.program.friction)

    def _make_room(self) -> None:
        self._events = self._ffi.new("bg_event[]", self._capacity)
        self._asked.events, self._asked.capacity = self._events, self._capacity

    def _buffer(self, count: int) -> tuple[Array, Any]:
        room = aligned(count + 1)
        room[:] = 0.0
        return room, self._ffi.cast("bg_paused *", room.ctypes.data)

    def _pointer(self, numbers: Array) -> Any:
        return self._ffi.cast("double *", numbers.ctypes.data)

"""Runs of any model by the loop in C that locates events."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from codegen.batch.call import Rooms, job_record, outcome_of
from codegen.batch.engine import CAPACITY, room_for_events
from codegen.batch.plan import Plan
from codegen.engine.located import METHODS, LocatedLibrary, packed_signals
from codegen.engine.sizes import aligned
from codegen.inputs.signal import Signal
from codegen.inputs.tables import SignalTable, has_table, signal_table
from codegen.numbers.arrays import Array
from codegen.runs.track import Settings


class Shared(NamedTuple):
    """Inputs of all runs: their table, and the runtime's record with what that points to."""

    table: SignalTable
    record: Any
    kept: tuple[Any, ...]


@dataclass(frozen=True)
class LocatedInputs:
    """A pointer to a record for each of the runs at ``indices``; ``kept`` is what these point to."""

    indices: NDArray[np.intp]
    pointers: NDArray[np.uintp]
    kept: Any


class _Rooms:
    """Where one thread does its runs, one in each lane; keeps all that the records point to."""

    def __init__(self, library: LocatedLibrary, kept: Plan, settings: Settings) -> None:
        self._ffi, self._library = library.opened
        self._kept = list[Any]()
        self._records = self._ffi.new(f"located_room[{library.lanes}]")
        for at in range(library.lanes):
            self._fill(self._records[at], library, kept, settings)
        size = self._library.lanes_size() if library.lanes > 1 else 0
        self._lanes = aligned(size // 8 + 1) if size else None

    def _fill(self, record: Any, library: LocatedLibrary, kept: Plan, settings: Settings) -> None:
        instance, run = map(aligned, library.sizes)
        values, totals = (
            aligned(max(len(kept.rows), 1), kept.samples),
            aligned(len(kept.products) + 1),
        )
        events = self._ffi.new("bg_event[]", CAPACITY) if kept.eventful else self._ffi.NULL
        self._kept += [instance, run, values, totals, events]
        for name, kind, array in (
            ("totals", "double", totals), ("model", "bg_model", instance), ("run", "bg_located", run),
            ("values", "double", values),
        ):  # fmt: skip
            setattr(record, name, self._ffi.cast(f"{kind} *", array.ctypes.data))
        record.events, record.capacity = events, room_for_events(kept.eventful)
        record.method = METHODS.index(settings.method)
        record.rtol, record.atol = settings.rtol, settings.atol
        record.corners = kept.cornered

    def do(self, job: Any, runs: Any) -> None:
        """Every run."""
        if self._lanes is None:
            self._library.located_batch(self._records, job, runs)
            return
        lanes = self._ffi.cast("bg_lanes *", self._lanes.ctypes.data)
        self._library.lanes_batch(lanes, self._records, job, runs)


class LocatedLoop:
    """One sweep's runs, side by side where they can; calls of `run` may come from several threads."""

    def __init__(
        self, library: LocatedLibrary, time: Array, kept: Plan, settings: Settings
    ) -> None:
        self._plan, self._time = kept, time
        library = library.side_by_side
        self._ffi, _ = library.opened
        self._rooms = Rooms(partial(_Rooms, library, kept, settings))

    def shared(self, signals: Sequence[Signal]) -> Shared:
        """Inputs of all runs."""
        table = self._table(signals)
        return Shared(table, *packed_signals(self._ffi, table))

    def alike(
        self, shared: Shared, places: Sequence[int], factors: Array, indices: NDArray[np.intp]
    ) -> LocatedInputs:
        """The same inputs for these runs, but those at ``places`` times ``factors``."""
        count, ffi = len(indices), self._ffi
        pointers = np.empty(count, dtype=np.uintp)
        if not places:
            pointers[:] = _address(ffi, shared.record)
            return LocatedInputs(indices, pointers, shared)
        own = np.zeros((count, len(shared.table.coefficients), 2))
        own[:] = np.reshape([(c.real, c.imag) for c in shared.table.coefficients], (-1, 2))
        for at, first, length, *_ in shared.table.terms:
            if at in places:
                factor = factors[indices, list(places).index(at)]
                own[:, first : first + length] *= factor[:, None, None]
        records = ffi.new("bg_signals[]", count)
        for k in range(count):
            records[k] = shared.record[0]
            records[k].coefficients = ffi.cast("double(*)[2]", own[k].ctypes.data)
        pointers[:] = _address(ffi, records) + ffi.sizeof("bg_signals") * np.arange(count)
        return LocatedInputs(indices, pointers, (shared, own, records))

    def different(self, found: Sequence[tuple[int, Sequence[Signal]]]) -> list[LocatedInputs]:
        """The inputs of each run by its index, of those that tables can hold."""
        found = [(k, signals) for k, signals in found if has_table(signals)]
        made = [packed_signals(self._ffi, self._table(signals)) for _, signals in found]
        pointers = np.array([_address(self._ffi, record) for record, _ in made], dtype=np.uintp)
        return [LocatedInputs(np.array([k for k, _ in found]), pointers, made)] if found else []

    def run(
        self, inputs: LocatedInputs, parameters: Array, states: Array
    ) -> tuple[Array, NDArray[np.intc], Array]:
        """For each run a row of results, a status, not 0 where it has to be done another way, and what
        its states gain as the start is completed.
        """
        ffi, kept = self._ffi, self._plan
        job, pointed = job_record(ffi, kept, self._time, 0.0)
        runs = ffi.new("located_runs *")
        found = outcome_of(ffi, runs, inputs.pointers, parameters, states, kept.width)
        with self._rooms.one() as rooms:
            rooms.do(job, runs)
        del pointed
        return found

    def _table(self, signals: Sequence[Signal]) -> SignalTable:
        return signal_table(signals, float(self._time[0]), float(self._time[-1]))


def _address(ffi: Any, record: Any) -> int:
    return int(ffi.cast("uintptr_t", record))

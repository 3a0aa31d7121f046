"""Event-located runs by the generated C of a model: adaptive steps, for models of every kind."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.c.export import runtime_file, texts
from codegen.engine.build import FLAGS, check_tools, compiled, loaded
from codegen.engine.sizes import aligned, declarations
from codegen.inputs.signals import Signal
from codegen.inputs.tables import SignalTable, signal_table
from codegen.model.closed import ClosedModel
from codegen.runs.events import Event
from codegen.runs.legs import Settings
from codegen.runs.snapshots import Snapshots

KINDS = ("stick", "slip", "cross")
METHODS = ("auto", "DOP853", "Radau")
"""In the order of ``model_located.h``."""

EVENTS_STATUS = 15
"""Of `bg_model_run`: more events than there is room for."""

FEW, MANY = 256, 1 << 20
"""Events there is room for at first, and at most."""


@dataclass(frozen=True)
class Recorded:
    """What a run has left: its events, everything at its samples."""

    events: tuple[Event, ...]
    shots: Snapshots


class LocatedRuns:
    """The generated C of one model; compiled when the first run asks for it.

    Raises what `codegen.to_c` raises for models that C cannot have, `MissingExtraError` without a compiler.
    """

    def __init__(self, model: ClosedModel, flags: Sequence[str] = FLAGS) -> None:
        check_tools()
        program = model.program
        self.model, self._flags = model, tuple(flags)
        self._parameters = np.array(
            [float(model.parameters[symbol.name]) for symbol in program.parameters] or [0.0]
        )
        # Numbers are given to each instance, so models that differ in them share one library.
        self._texts = texts(model, "model", [0.0] * len(program.parameters))

    def run(
        self, times: Array, states: Array, signals: Sequence[Signal], settings: Settings
    ) -> Recorded | None:
        """Run and record; None where it could not go on."""
        ffi, library = self._library
        kept: list[Any] = []
        table = signal_table(signals, float(times[0]), float(times[-1]))
        inputs = packed_signals(ffi, table, kept)
        instance, run = self._rooms
        width, ports = self._width, max(len(self.model.program.friction), 1)
        rows = np.empty((len(times), width))
        modes = np.zeros((len(times), ports), dtype=np.intc)
        start = np.append(states, 0.0)
        asked, target = ffi.new("bg_request *"), ffi.new("bg_rows *")
        target.table, target.modes = _pointer(ffi, rows), _pointer(ffi, modes, "int *")
        asked.times, asked.states = _pointer(ffi, times), _pointer(ffi, start)
        asked.samples, asked.method = len(times), METHODS.index(settings.method)
        asked.rtol, asked.atol = settings.rtol, settings.atol
        status, room = EVENTS_STATUS, FEW
        while status == EVENTS_STATUS and room <= MANY:
            events = ffi.new("bg_located_event[]", room)
            asked.events, asked.capacity = events, room
            status = library.bg_rows_run(
                ffi.cast("bg_located *", run.ctypes.data),
                ffi.cast("bg_model *", instance.ctypes.data),
                _pointer(ffi, self._parameters), inputs, asked, target,
            )  # fmt: skip
            room *= 16
        if status != 0 or not np.isfinite(rows).all():
            return None
        names = [port.name for port in self.model.program.friction]
        found = tuple(
            Event(event.time, names[event.port], KINDS[event.kind])
            for event in events[0 : asked.count]
        )
        return Recorded(found, self._shots(rows))

    @cached_property
    def _library(self) -> tuple[Any, Any]:
        files = {name: runtime_file(name) for name in ("model_rows.h", "model_rows.c")}
        library = compiled({**self._texts, **files}, self._flags)
        ffi, opened = loaded(library, _declared())
        sizes = ffi.new("unsigned long[3]")
        opened.bg_rows_sizes(sizes)
        if sizes[2] != 8 * self._width:
            raise SimulationError(f"the library {library} was compiled for other sizes; delete it")
        return ffi, opened

    @cached_property
    def _rooms(self) -> tuple[Array, Array]:
        """Room for an instance and for a run."""
        ffi, library = self._library
        sizes = ffi.new("unsigned long[3]")
        library.bg_rows_sizes(sizes)
        return aligned(sizes[0] // 8 + 1), aligned(sizes[1] // 8 + 1)

    @property
    def _widths(self) -> tuple[int, ...]:
        """How many columns x, z, u, u', y, the rate of s and external inputs have."""
        program = self.model.program
        inputs = len(program.inputs)
        return (
            len(program.states), len(program.law_states), inputs, inputs, len(program.readings),
            self.model.size, len(program.external),
        )  # fmt: skip

    @property
    def _width(self) -> int:
        return sum(self._widths)

    def _shots(self, rows: Array) -> Snapshots:
        x, z, u, du, y, rate, external = np.split(rows, np.cumsum(self._widths)[:-1], axis=1)
        return Snapshots(x, z, u, du, y, rate, external)


def packed_signals(ffi: Any, table: SignalTable, kept: list[Any]) -> Any:
    """A table as the runtime's record; ``kept`` gets what the record points to."""
    record = ffi.new("bg_signals *")
    rows = [
        {
            "input": at,
            "first": first,
            "count": count,
            "start": start,
            "rate": [rate.real, rate.imag],
        }
        for at, first, count, start, rate in table.terms
    ]
    terms = ffi.new("bg_term[]", rows or 1)
    breaks, fastest = np.array([*table.breaks, 0.0]), np.array(table.fastest)
    begins = np.array(table.begins, dtype=np.intc)
    coefficients = np.array([(c.real, c.imag) for c in table.coefficients] or [(0.0, 0.0)])
    kept += [record, terms, breaks, fastest, begins, coefficients]
    record.segments, record.terms = len(table.fastest), terms
    record.breaks, record.fastest = _pointer(ffi, breaks), _pointer(ffi, fastest)
    record.begins = _pointer(ffi, begins, "int *")
    record.coefficients = _pointer(ffi, coefficients, "double(*)[2]")
    return record


def _pointer(ffi: Any, array: Any, kind: str = "double *") -> Any:
    return ffi.cast(kind, array.ctypes.data)


def _declared() -> str:
    """What is called; records that only C looks into have names alone."""
    own = "".join(f"typedef struct {n} {n};\n" for n in ("bg_model", "bg_located", "bg_snapshot"))
    return own + "".join(declarations(f"model_{name}.h", {}) for name in ("request", "rows"))

"""Event-located runs by the generated C of a model: adaptive steps, for models of every kind."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from bondgraph.errors import SimulationError
from codegen.c.export import CALLING, texts
from codegen.c.lanes import FEW_STATES, Lanes, lanes, lanes_text
from codegen.c.runtime import runtime_file, runtime_names
from codegen.engine.build import FLAGS, check_tools, compiled, loaded
from codegen.engine.fallback import Stopped
from codegen.engine.handing import Handing
from codegen.engine.runs import not_affine
from codegen.engine.sizes import aligned, declarations
from codegen.engine.status import Status
from codegen.inputs.signal import Signal
from codegen.inputs.tables import SignalTable, signal_table
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import recorded
from codegen.record.snapshots import Snapshots
from codegen.runs.track import Settings

FILES = (
    *CALLING, "batch_measure.h", "batch_measure.c",
    "batch_doubt.h", "batch_gauss.h", "batch_located.h", "batch_located.c",
    "run_paused.h", "run_paused.c", "located_paused.h", "located_paused.c",
)  # fmt: skip
"""What calls a model: once for a table of a run, or once for many runs."""

METHODS = ("auto", "DOP853", "Radau")
"""In the order of ``located_request.h``."""

VECTORS = ("-fno-math-errno", "-fno-trapping-math")
"""Of a root and a choice compilers then make vectors; nothing here asks for errno or the flags of traps."""

_BATCH = """
typedef struct bg_lanes bg_lanes;
void lanes_batch(bg_lanes *a, located_room *rooms, const batch_job *job, const located_runs *runs);
unsigned long lanes_size(void);
int lanes_rooms(void);
int lanes_rows_run(bg_lanes *a, located_room *room, const double *parameters,
                   const bg_signals *signals, bg_request *asked, bg_rows *rows);
"""
"""What is called of runs side by side."""

FEW, MANY = 256, 1 << 20
"""Events there is room for at first, and at most."""


UNBOUNDED = "a number of the run is not finite"
"""Why a run that is over is none."""


class Asking(NamedTuple):
    """A request and its inputs as C's records; ``kept``: what these point to."""

    record: Any
    inputs: Any
    kept: tuple[Any, ...]


class LocatedLibrary:
    """The generated C of a program, written and compiled when it is first asked for.

    Numbers are given to each instance, so models that differ in them alone share one library.
    """

    def __init__(self, model: ClosedModel, flags: Sequence[str] = FLAGS) -> None:
        check_tools()
        self._model, self._flags = model, tuple(flags)

    @cached_property
    def sources(self) -> Mapping[str, str]:
        """Its files; raises what `codegen.to_c` raises for models that C cannot have."""
        zeros = [0.0] * len(self._model.program.parameters)
        files = {name: runtime_file(name) for name in FILES}
        return {**texts(self._model, "model", zeros), **files}

    @cached_property
    def affine(self) -> bool:
        """Whether the program is affine in each friction mode."""
        return not_affine(self._model.program) is None

    @cached_property
    def opened(self) -> tuple[Any, Any]:
        """cffi's interface and the library."""
        return loaded(compiled(self.sources, self._flags), _declared())

    @cached_property
    def side_by_side(self) -> "LocatedLibrary":
        """The library that does several runs at once, or this one where it does one after the other."""
        code = lanes(self._model.program)
        return self if code is None else LanesLibrary(self._model, code, self._flags)

    @property
    def alone(self) -> "LocatedLibrary":
        """The library for a run by itself: by steps of lanes too, where these are exponential."""
        few = self._model.program.size <= FEW_STATES
        return self.side_by_side if few else self

    @property
    def lanes(self) -> int:
        """So many runs are under way at a time."""
        return 1

    @cached_property
    def sizes(self) -> tuple[int, int]:
        """How many doubles an instance and a run take."""
        ffi, library = self.opened
        sizes = ffi.new("unsigned long[3]")
        library.bg_rows_sizes(sizes)
        program = self._model.program
        if sizes[2] != 8 * (sum(recorded(program)) + len(program.friction)):
            raise SimulationError(
                "the library of this model was compiled for other sizes; empty the cache"
            )
        return sizes[0] // 8 + 1, sizes[1] // 8 + 1


class LanesLibrary(LocatedLibrary):
    """The same with runs side by side, each in a lane of its own."""

    def __init__(self, model: ClosedModel, code: Lanes, flags: Sequence[str]) -> None:
        super().__init__(model, (*flags, *VECTORS))
        self._code = code

    @cached_property
    def sources(self) -> Mapping[str, str]:
        """The files of both."""
        files = {name: runtime_file(name) for name in runtime_names("lanes")}
        return {**super().sources, **lanes_text(self._model.program, self._code), **files}

    @cached_property
    def opened(self) -> tuple[Any, Any]:
        """cffi's interface and the library."""
        return loaded(compiled(self.sources, self._flags), _declared() + _BATCH)

    @property
    def side_by_side(self) -> LocatedLibrary:
        """This one."""
        return self

    @cached_property
    def lanes(self) -> int:
        """So many runs are under way at a time."""
        count: int = self.opened[1].lanes_rooms()
        return count


class LocatedRuns:
    """Runs of one model by generated C; ``library``: of a model with the same program, if there is one.

    Raises `MissingExtraError` without a compiler.
    """

    def __init__(self, model: ClosedModel, library: LocatedLibrary | None = None) -> None:
        self.model, self.library = model, (library or LocatedLibrary(model)).alone
        self.parameters = np.array(
            [float(model.parameters[symbol.name]) for symbol in model.program.parameters] or [0.0]
        )

    def asking(
        self, times: Array, states: Array, signals: Sequence[Signal], settings: Settings,
        first: Mode, corners: bool,
    ) -> "Asking":  # fmt: skip
        """What C is asked, of signals that have a table."""
        ffi, _ = self.library.opened
        begin = np.array([*first, *[1] * max(len(self.model.switching), 1)], dtype=np.intc)
        start = np.append(states, 0.0)
        asked = ffi.new("bg_request *")
        asked.times, asked.states = _pointer(ffi, times), _pointer(ffi, start)
        asked.samples, asked.method = len(times), METHODS.index(settings.method)
        asked.rtol, asked.atol, asked.corners = settings.rtol, settings.atol, corners
        asked.first = _pointer(ffi, begin, "int *")
        table = signal_table(signals, float(times[0]), float(times[-1]))
        inputs, kept = packed_signals(ffi, table)
        return Asking(asked, inputs, (times, start, begin, kept))

    def rows(self, table: Array) -> Any:
        """C's record of where rows go."""
        ffi, _ = self.library.opened
        made = ffi.new("bg_rows *")
        made.table, made.room = _pointer(ffi, table), len(table)
        return made

    def call(self, asking: "Asking", rows: Any) -> int:
        """Call C once; the status."""
        ffi, library = self.library.opened
        room, lanes = self._rooms[:2]
        given = (_pointer(ffi, self.parameters), asking.inputs, asking.record, rows)
        status: int = (
            library.bg_rows_run(room.run, room.model, *given)
            if lanes is None
            else library.lanes_rows_run(lanes, room, *given)
        )
        return status

    def stopped(self, asking: "Asking", status: int) -> Stopped:
        """Why a run could not go on."""
        ffi, library = self.library.opened
        reason = ffi.string(library.bg_model_message(status)).decode()
        return Stopped(reason, float(asking.record.time), status == Status.EVENTS)

    def told(self, table: Array) -> tuple[Snapshots, tuple[Mode, ...]]:
        """Rows as everything at the samples, and the modes there."""
        program = self.model.program
        *parts, modes = np.split(table, np.cumsum(recorded(program)), axis=1)
        return Snapshots(*parts), _modes(modes.astype(int))

    @cached_property
    def handing(self) -> Handing:
        """What C calls to hand over."""
        return Handing(self.library.opened[0])

    @property
    def finite(self) -> int:
        """So many numbers of a row, the states, are finite in a run that is whole."""
        program = self.model.program
        return len(program.states) + len(program.law_states)

    @cached_property
    def _rooms(self) -> tuple[Any, Any, Any]:
        """Where a run is done, what lanes work on, or None, and what these point to."""
        ffi, library = self.library.opened
        instance, run = map(aligned, self.library.sizes)
        room = ffi.new("located_room *")
        room.model = ffi.cast("bg_model *", instance.ctypes.data)
        room.run = ffi.cast("bg_located *", run.ctypes.data)
        if self.library.lanes == 1:
            return room, None, (instance, run)
        lanes = aligned(library.lanes_size() // 8 + 1)
        return room, ffi.cast("bg_lanes *", lanes.ctypes.data), (instance, run, lanes)

    @property
    def width(self) -> int:
        """How many numbers are kept of a sample: its parts, and the modes of the ports."""
        program = self.model.program
        return sum(recorded(program)) + len(program.friction)


def _modes(rows: Array) -> tuple[Mode, ...]:
    """The mode of each sample; there are few, and many samples of each in a row."""
    turns = np.flatnonzero((rows[1:] != rows[:-1]).any(axis=1)) + 1
    found = list[Mode]()
    for begin, end in pairwise([0, *turns.tolist(), len(rows)]):
        found += [tuple(rows[begin].tolist())] * (end - begin) if end > begin else []
    return tuple(found)


def packed_signals(ffi: Any, table: SignalTable) -> tuple[Any, tuple[Any, ...]]:
    """A table as the runtime's record, and what has to be kept while that is used."""
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
    record.segments, record.terms = len(table.fastest), terms
    record.breaks, record.fastest = _pointer(ffi, breaks), _pointer(ffi, fastest)
    record.begins = _pointer(ffi, begins, "int *")
    record.coefficients = _pointer(ffi, coefficients, "double(*)[2]")
    record.waves = len(table.waves)
    waves, parts = ffi.new("bg_wave[]", [*table.waves]), ffi.new("bg_part[]", [*table.parts])
    record.wave, record.parts, more = waves, parts, None
    if table.duties is not None:
        # The field is no owner of what it points to.
        more = packed_signals(ffi, table.duties)
        record.duties = more[0]
    return record, (terms, breaks, fastest, begins, coefficients, waves, parts, more)


def _pointer(ffi: Any, array: Any, kind: str = "double *") -> Any:
    return ffi.cast(kind, array.ctypes.data)


def _declared() -> str:
    """What is called; records that only C looks into have names alone."""
    own = "".join(
        f"typedef struct {n} {n};\n" for n in ("bg_model", "bg_located", "bg_snapshot", "bg_span")
    )
    headers = (
        "port_switch.h", "port_events.h", "model_signals.h", "located_request.h", "located_rows.h",
        "batch_measure.h", "batch_located.h", "located_paused.h",
    )  # fmt: skip
    own += "const char *bg_model_message(int status);\n"
    return own + "".join(declarations(header, {}) for header in headers)

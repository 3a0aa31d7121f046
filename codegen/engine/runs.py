"""Runs of affine models by the C engine; what it cannot do is left to event-located runs."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bondgraph.errors import SimulationError
from codegen.engine.build import FLAGS, check_tools
from codegen.engine.fallback import Stopped
from codegen.engine.handing import Handing
from codegen.engine.happened import told_events
from codegen.engine.inputs import Segments, inputs_over
from codegen.engine.modes import Tables
from codegen.engine.packed import Packed
from codegen.engine.sized import sizes
from codegen.engine.sizes import Engine, aligned, engine
from codegen.engine.status import Status
from codegen.engine.windows import Windows
from codegen.inputs.signal import Signal
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.affine import is_affine
from codegen.program.gains import written_out
from codegen.program.records import Program
from codegen.runs.track import Event, Track
from codegen.tuning import TUNING

CAPACITY = 256
"""Events there is room for at first, at the least."""

MOST_AT_FIRST = 1 << 20
"""The same at the most, where a run before had more."""

WINDOW = 1 << 16
"""So many samples are looked at together."""

NO_END = 2**31 - 1
"""Events that happen without being kept."""


MEANINGS = {
    Status.NOT_AFFINE: "a friction mode is not one affine map",
    Status.NO_HOLD: "nothing holds the ports that would have to stick",
    Status.NEGATIVE: "a friction level falls below zero",
    Status.UNDECIDED: "no way of sticking and slipping is consistent",
    Status.STALLS: "events follow one another and time makes no progress",
    Status.STRUCK: "stops were struck too often in one instant, and what meets them still closes",
    Status.SET_TWICE: "two ports reset one state to two values at once",
    Status.SET_HELD: "a reset contradicts what is held",
    Status.SET_ENDLESSLY: "resets set off one another without end",
    Status.STIFF: "time constants are too short for the span",
    Status.EVENTS: "more events than there is room for",
    Status.WORK: "the search for an event has no end",
    Status.NOT_FINITE: "a number is not finite",
    Status.ENDLESS: "it would take too many steps to look for events in",
    Status.MISSING: "it comes to more friction modes than there is room for",
    Status.CROWDED: "it comes to so many friction modes that steps are quicker than their tables",
    Status.UNTAKEN: "what it has recorded cannot be taken",
}
"""What a run of the engine says beside `Status.BLUNT`, which asks for more."""

LIMITS = frozenset({
    Status.NOT_AFFINE, Status.STIFF, Status.EVENTS, Status.WORK, Status.MISSING, Status.CROWDED,
})  # fmt: skip
"""What is no fault of a model: C alone cannot go on."""


@dataclass(frozen=True)
class Outcome:
    """What the engine said of a run, and when [s] that ended."""

    status: Status
    time: float

    @property
    def stopped(self) -> Stopped:
        """Why it could not go on."""
        return Stopped(MEANINGS[self.status], self.time, self.status in LIMITS)


@dataclass
class Prepared:
    """One run ready to be started: the engine's records, and the arrays they point to.

    The engine only points to what this keeps: it must be alive while its ``arguments`` are used.
    ``rows``: a sample in each, the integrated vector in front. ``grid`` [s]: the distance of samples.
    """

    engine: Engine
    tables: Tables
    context: tuple[Array, Any]
    inputs: Packed
    times: Array
    start: Array
    rows: Array
    modes: Array
    first: Array
    grid: float
    handing: Handing
    capacity: int = CAPACITY
    #: Whether events are kept.
    keeping: bool = True
    events: Any = field(init=False)
    task: Any = field(init=False)

    def __post_init__(self) -> None:
        ffi = self.engine.ffi
        self.task = self.engine.new("ex_task")
        width = self.engine.sizes.numbers["ROW"]
        self.task.times = ffi.cast("double *", self.times.ctypes.data)
        self.task.start = ffi.cast("double *", self.start.ctypes.data)
        self.task.rows = ffi.cast(f"double(*)[{width}]", self.rows.ctypes.data)
        self.task.modes = ffi.cast("int *", self.modes.ctypes.data)
        self.task.samples, self.task.grid = len(self.times), self.grid
        self.task.first = ffi.cast("int *", self.first.ctypes.data)
        self.make_room()

    def call(self, begin: Callable[[], None] | None = None) -> Status:
        """Run, as often as it takes to supply modes and room for events; ``begin``: called each time."""
        library, arguments = self.engine.library, self.arguments
        while True:
            if begin is not None:
                begin()
            status = Status(library.ex_run(*arguments))
            failed = self.tables.failed or self.inputs.failed or self.handing.failed
            if failed is not None:
                self.tables.failed = self.handing.failed = None
                raise failed
            if status == Status.MISSING and self.tables.room:
                self.tables.supply(self.tables.mode_at(self.task.where))
            elif status == Status.BLUNT:
                self.tables.sharpen()
            elif status == Status.EVENTS:
                self.capacity *= 8
                self.make_room()
            else:
                return status

    @property
    def arguments(self) -> tuple[Any, ...]:
        """What the engine's functions take."""
        return self.context[1], self.tables.record, self.inputs.record, self.task

    def track(self, model: ClosedModel) -> Track:
        """The record of the run."""
        events = self._told(model.program.happening, model.program.taken)
        vectors = self.rows[:, : model.size].copy()
        largest = np.abs(vectors).max(axis=0)
        modes = [self.tables.places.known[place] for place in self.modes.tolist()]
        return Track(vectors, modes, largest, events, len(vectors), keeping=self.keeping)

    def _told(self, names: Sequence[Hashable], taken: Mapping[int, str]) -> list[Event]:
        """The events, ports by these names, and transitions by ports."""
        if not self.keeping or not self.task.count:
            return []
        return told_events(self.engine.ffi, self.events, self.task.count, names, taken)

    def make_room(self) -> None:
        """Make room for events, as many as there is capacity."""
        if not self.keeping:
            self.task.events, self.task.capacity = self.engine.ffi.NULL, NO_END
            return
        try:
            self.events = self.engine.ffi.new("bg_event[]", self.capacity)
        except (MemoryError, OverflowError):
            raise SimulationError(
                f"at t = {self.task.time:.9g} the run has had {self.capacity // 8} events: more do not fit "
                "into memory; run it for a shorter time"
            ) from None
        self.task.events, self.task.capacity = self.events, self.capacity


class CRuns:
    """The engine for one model: compiled for each size of its inputs' generators, tables kept."""

    def __init__(self, model: ClosedModel, flags: Sequence[str] = FLAGS) -> None:
        check_tools()
        self.model, self._flags = model, tuple(flags)
        self._ready: dict[int, tuple[Tables, tuple[Array, Any], Handing]] = {}
        self._capacity = CAPACITY

    def expect(self, events: int) -> None:
        """Have room for so many: a run like the latest need not begin again for want of it."""
        self._capacity = min(events, MOST_AT_FIRST)

    def prepare(
        self, times: Array, start: Array, signals: Sequence[Signal], first: Mode = (),
        keeping: bool = True, patient: bool = True, room: int | None = None,
    ) -> Prepared:  # fmt: skip
        """Everything that a run needs; ``room``: for so many samples at a time, where they are taken."""
        made = inputs_over(signals, float(times[0]), float(times[-1]))
        tables, context, handing = self._tables(made)
        held = len(times) if room is None or handing.call is None else min(len(times), room)
        tables.record.most = 0 if patient else tables.places.few
        return Prepared(
            tables.engine,
            tables,
            context,
            Packed(tables.engine, made, float(times[0])),
            np.ascontiguousarray(times, dtype=np.float64),
            np.ascontiguousarray(start, dtype=np.float64),
            aligned(held, tables.engine.sizes.numbers["ROW"]),
            np.empty(held, dtype=np.intc),
            np.array([*first, *[1] * max(len(self.model.switching), 1)], dtype=np.intc),
            grid_of(times),
            handing,
            self._capacity,
            keeping,
        )

    def _tables(self, made: Segments | Windows) -> tuple[Tables, tuple[Array, Any], Handing]:
        compiled = self.built(made.slots)
        if compiled.sizes.G not in self._ready:
            tables, context = Tables(compiled, self.model), compiled.context()
            self._ready[compiled.sizes.G] = tables, context, Handing(compiled.ffi)
        return self._ready[compiled.sizes.G]

    def built(self, slots: int) -> Engine:
        """The engine for inputs whose generators have so many slots."""
        return engine(sizes(self.model, slots), self._flags)


def not_affine(program: Program) -> str | None:
    """Why a model is not affine in each friction mode; None if it is."""
    if not program.guards_affine:
        what = ", or what one resets a state to," if program.resets else ""
        return f"a condition of a switch{what} is not affine"
    if not program.ticks_affine:
        return "what a controller sets is not affine"
    if not program.restitution_given:
        return "the restitution of a stop is not told by parameters alone"
    if program.affine:
        return None
    if program.varying:
        return "values of this one change in time"
    if program.joint:
        return f"the friction at {program.friction[0].name!r} acts back at once on laws or itself"
    groups = [program.known, program.coupled, *program.groups]
    looped = next((group for group in groups if group.loop and group.ports), None)
    if looped is not None:
        return f"the laws at {', '.join(map(repr, looped.ports))} have to be solved for"
    ports = [port for group in groups for port in group.ports]
    laws = [law for group in groups for law in written_out(group.values)]
    ports += [port.name for port in program.friction for _ in range(4)]
    laws += written_out(program.friction_values)
    parameters = {name.name for name in program.parameters}
    for port, law in zip(ports, laws, strict=True):
        if not is_affine([law], parameters):
            return f"the law at {port!r} is {law}"
    return "a law of this one is not"


def grid_of(times: Array) -> float:
    """The distance of samples that are alike but for rounding; 0 where they are not."""
    step = float(times[-1] - times[0]) / (len(times) - 1)
    rounding = 8 * np.spacing(max(abs(times[0]), abs(times[-1])))
    most = min(rounding, TUNING.alike * step)
    for first in range(0, len(times), WINDOW):
        now = times[first : first + WINDOW]
        if np.abs(now - (times[0] + step * np.arange(first, first + len(now)))).max() > most:
            return 0.0
    return step

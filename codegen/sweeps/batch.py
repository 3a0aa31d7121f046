"""A sweep's runs in one call of C for many, where the model is affine and the measures are ready ones."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from threading import Lock
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from bondgraph import BondGraphError
from bondgraph.elements import Kind
from bondgraph.resistances import resistive_loops
from codegen.arrays import Array
from codegen.c.export import to_c
from codegen.engine.inputs import segments
from codegen.engine.runs import KINDS, grid_of, not_affine
from codegen.engine.sizes import Engine, sizes
from codegen.program import Program
from codegen.runs.arguments import named_numbers, signals_for
from codegen.sweeps.batch_engine import Room, batch_engine
from codegen.sweeps.batch_inputs import BatchInputs, each, varied
from codegen.sweeps.family import Family
from codegen.sweeps.measures import READY, Measure

WHATS = (
    "peak", "largest", "smallest", "final", "integral", "samples", "first_event", "event_count",
)  # fmt: skip
"""In the order of ``batch.h``."""

EVENTS = WHATS.index("first_event")

Given = Mapping[str, Any] | Callable[[Mapping[str, float]], Mapping[str, Any]] | None
Found = tuple[Array, ...] | None
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Asked:
    """A sweep as the loop needs it; ``settings`` as of `Simulator.run`."""

    family: Family
    names: tuple[str, ...]
    time: Array
    measures: Mapping[str, Callable[..., Any]]
    initial: Given
    inputs: Given


@dataclass(frozen=True)
class Plan:
    """What to keep of each run: (what, signal, port, kind, place) and the rows of signals."""

    entries: tuple[tuple[int, int, int, int, int], ...]
    rows: tuple[int, ...]
    width: int


class Batch:
    """The loop for one sweep; calls may come from several threads."""

    def __init__(self, asked: Asked, plan: Plan) -> None:
        family = asked.family
        self.asked, self.plan, self.program = asked, plan, family.program
        self._closed = family.simulator().closed
        self._sources = to_c(family.equations, family.parameters, family.laws)
        exact = self._closed.parameters
        self._defaults = np.array([float(exact[p.name]) for p in self.program.parameters])
        self._values = _checked_values(family, self.program)
        self._time, self._grid = np.ascontiguousarray(asked.time), grid_of(asked.time)
        self._engines: dict[int, Engine] = {}
        self._rooms: dict[int, list[Room]] = {}
        self._lock = Lock()
        self._shared: Any = None
        self.statuses: Counter[int] = Counter()

    def __call__(self, rows: Sequence[tuple[float, ...]]) -> list[Found]:
        """For each run its measures, or None where it has to be done another way."""
        found: list[Found] = [None] * len(rows)
        table = np.array(rows, dtype=float).reshape(len(rows), len(self.asked.names))
        with self._lock:
            parameters, usable = self._parameters(table)
            states, settled = self._states(table)
            groups = self._inputs(table, np.flatnonzero(usable & settled))
        for inputs in groups:
            indices = inputs.indices
            results, status = self._run(inputs, parameters[indices], states[indices])
            with self._lock:
                self.statuses.update(Counter(status.tolist()))
            for at, row, one in zip(indices.tolist(), results, status.tolist(), strict=True):
                if one == 0:
                    found[at] = self._measures(row)
        return found

    def _parameters(self, table: Array) -> tuple[Array, Flags]:
        """The parameters of each run, and which runs' elements have values that can be used."""
        parameters = np.tile(self._defaults, (len(table), 1))
        for column, name in enumerate(self.asked.names):
            for at, symbol in enumerate(self.program.parameters):
                if symbol.name == name:
                    parameters[:, at] = table[:, column]
        with np.errstate(all="ignore"):
            usable = self._values(parameters)
        return np.ascontiguousarray(parameters), usable

    def _states(self, table: Array) -> tuple[Array, Flags]:
        """The states at the start of each run, and which of them can be used."""
        asked, names = self.asked, self.asked.family.states
        states, usable = np.zeros((len(table), len(names))), np.ones(len(table), dtype=bool)
        if callable(asked.initial):
            for k, row in enumerate(table.tolist()):
                try:
                    given = dict(asked.initial(dict(zip(asked.names, row, strict=True))) or {})
                    numbers = named_numbers(given, names)
                except Exception:  # noqa: BLE001 - told by whoever does the run then
                    usable[k] = False
                    continue
                states[k] = [numbers.get(name, 0.0) for name in names]
        else:
            numbers = named_numbers(asked.initial or {}, names)
            states[:] = [numbers.get(name, 0.0) for name in names]
        for column, name in enumerate(asked.names):
            if name in names:
                states[:, names.index(name)] = table[:, column]
        return states, usable & np.isfinite(states).all(axis=1)

    def _inputs(self, table: Array, indices: NDArray[np.intp]) -> list[BatchInputs]:
        """The inputs of these runs, those of one engine together."""
        asked, names = self.asked, self.asked.family.inputs
        swept = {name: at for at, name in enumerate(asked.names) if name in names}
        begin, end = float(self._time[0]), float(self._time[-1])
        if not callable(asked.inputs):
            if self._shared is None:
                given = {**(asked.inputs or {}), **dict.fromkeys(swept, 0.0)}
                self._shared = segments(signals_for(given, names), begin, end)
            engine = self._engine(self._shared.slots)
            places = [names.index(name) for name in swept]
            return [varied(engine, self._shared, places, table[:, [*swept.values()]], indices)]
        made: dict[int, list[tuple[int, Any]]] = {}
        for k in indices.tolist():
            values = dict(zip(asked.names, table[k].tolist(), strict=True))
            try:
                given = dict(asked.inputs(values) or {})
                given |= {name: values[name] for name in swept}
                one = segments(signals_for(given, names), begin, end)
            except Exception:  # noqa: BLE001 - told by whoever does the run then
                continue
            made.setdefault(sizes(self._closed, one.slots).G, []).append((k, one))
        return [each(self._engine(slots), found) for slots, found in made.items()]

    def _engine(self, slots: int) -> Engine:
        wanted = sizes(self._closed, slots)
        if wanted.G not in self._engines:
            self._engines[wanted.G] = batch_engine(self._sources, self.program, wanted)
        return self._engines[wanted.G]

    def _run(
        self, inputs: BatchInputs, parameters: Array, states: Array
    ) -> tuple[Array, NDArray[np.intc]]:
        engine, plan = inputs.engine, self.plan
        ffi, count = engine.ffi, len(inputs.indices)
        results, status = np.empty((count, plan.width)), np.empty(count, dtype=np.intc)
        entries = ffi.new("batch_measure[]", list(plan.entries))
        rows = ffi.new("int[]", list(plan.rows))
        job, runs = engine.new("batch_job"), engine.new("batch_runs")
        job.times = ffi.cast("double *", self._time.ctypes.data)
        job.grid, job.samples, job.width = self._grid, len(self._time), plan.width
        job.signals, job.measures = len(plan.rows), len(plan.entries)
        job.signal, job.measure = rows, entries
        runs.runs, runs.inputs = count, inputs.pointers
        for name, kind, array in (
            ("parameters", "double *", parameters), ("states", "double *", states),
            ("results", "double *", results), ("status", "int *", status),
        ):  # fmt: skip
            setattr(runs, name, ffi.cast(kind, array.ctypes.data))
        rooms = self._rooms.setdefault(engine.sizes.G, [])
        try:
            room = rooms.pop()
        except IndexError:
            room = Room(engine, len(self._time), len(plan.rows))
        engine.library.batch_run(room.record, job, runs)
        rooms.append(room)
        return results, status

    def _measures(self, row: Array) -> tuple[Array, ...]:
        if self.plan.width == len(self.plan.entries):
            return tuple(map(np.array, row.tolist()))
        samples = WHATS.index("samples")
        return tuple(
            row[at : at + len(self._time)].copy() if what == samples else np.array(row[at])
            for what, _, _, _, at in self.plan.entries
        )


def batch(asked: Asked) -> Batch | None:
    """The loop for a sweep; None where the model or a measure is none that it can do."""
    try:
        program = asked.family.program
        if not _can(asked.family, program, asked.names):
            return None
        plan = _plan(asked.measures, program, len(asked.time))
        return None if plan is None else Batch(asked, plan)
    except BondGraphError:
        return None


def _can(family: Family, program: Program, names: Sequence[str]) -> bool:
    """Whether the model is affine, steps of its inputs show no impulses, and ranks are certain."""
    layout = program.layout
    if family.backend != "c" or not program.states or not_affine(program) is not None:
        return False
    if layout["K"].rows or (layout["H"].rows and layout["E"].rows):
        return False
    reduction = family.equations.reduction
    loops = [*reduction.structure.loops, *(rows for _, rows in resistive_loops(reduction))]
    entries = [sp.sympify(entry) for rows in loops for row in rows for entry in row.values()]
    return not any(s.name in names for entry in entries for s in entry.free_symbols)


def _plan(
    measures: Mapping[str, Callable[..., Any]], program: Program, samples: int
) -> Plan | None:
    places, ports = _places(program), [port.name for port in program.friction]
    rows: list[int] = []
    entries = []
    width = 0
    for measure in measures.values():
        if not isinstance(measure, Measure) or measure.function not in READY:
            return None
        name = READY[measure.function]
        what, signal, port, kind = WHATS.index(name), -1, -1, -1
        if what >= EVENTS:
            node, event = measure.arguments
            port = ports.index(node) if node in ports else -1
            kind = KINDS.index(event) if event in KINDS else -1
        else:
            row = places.get(measure.arguments[0])
            if row is None:
                return None
            if row not in rows:
                rows.append(row)
            signal = rows.index(row)
        entries.append((what, signal, port, kind, width))
        width += samples if name == "samples" else 1
    return Plan(tuple(entries), tuple(rows), width)


def _places(program: Program) -> dict[str, int]:
    """Each signal's row in affine maps; -1 - j for the external input j."""
    states = len(program.states) + len(program.law_states)
    groups = (
        (program.states, range(states)),
        (program.law_states, range(len(program.states), states)),
        (program.inputs, range(states, states + len(program.inputs))),
        (program.external, range(-1, -1 - len(program.external), -1)),
        (program.readings, range(states + 2 * len(program.inputs), 1 << 20)),
    )
    places: dict[str, int] = {}
    for names, rows in groups:
        for name, row in zip(names, rows, strict=False):
            places.setdefault(name.name, row)
    return places


def _checked_values(family: Family, program: Program) -> Callable[[Array], Flags]:
    """Whether storages and moduli are certain not to be zero, for rows of parameters."""
    elements = [e for e in family.equations.elements.values() if e.kind is not Kind.R]
    values = [sp.sympify(e.value) for e in elements if e.value is not None]
    known = {symbol.name for symbol in program.parameters}
    constant = [v for v in values if {s.name for s in v.free_symbols} <= known]
    pairs = [(value, _size(value)) for value in constant]
    function = sp.lambdify(list(program.parameters), pairs, "numpy", cse=True)

    def usable(parameters: Array) -> Flags:
        found = np.ones(len(parameters), dtype=bool)
        for value, size in function(*parameters.T):
            found &= np.isfinite(size) & (np.abs(value) > 1e-12 * np.abs(size))
        return found

    return usable


def _size(value: sp.Expr) -> sp.Expr:
    """The magnitude of an expression's terms, before they cancel."""
    if value.is_Add:
        return reduce(lambda a, b: a + b, (_size(part) for part in value.args))
    if value.is_Mul:
        return reduce(lambda a, b: a * b, (_size(part) for part in value.args))
    if value.is_Pow and value.exp.is_positive:
        return _size(value.base) ** value.exp
    return abs(value)

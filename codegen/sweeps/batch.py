"""A sweep's runs in one call of C for many, where the model is affine and the measures are ready ones."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from bondgraph import BondGraphError
from bondgraph.resistances import resistive_loops
from codegen.arrays import Array
from codegen.engine.inputs import Packed, segments
from codegen.engine.runs import grid_of, not_affine
from codegen.engine.sizes import Engine, sizes
from codegen.program import Program
from codegen.runs.arguments import named_numbers, signals_for
from codegen.sweeps.batch_engine import Room
from codegen.sweeps.batch_inputs import BatchInputs, each, varied
from codegen.sweeps.batch_model import Flags, batch_model
from codegen.sweeps.batch_plan import Plan, plan
from codegen.sweeps.family import Family

Given = Mapping[str, Any] | Callable[[Mapping[str, float]], Mapping[str, Any]] | None
"""Initial states or inputs, or a function of a run's numbers that gives them."""


@dataclass(frozen=True)
class Asked:
    """A sweep as the loop needs it; ``names``: what each run has numbers for."""

    family: Family
    names: tuple[str, ...]
    time: Array
    measures: Mapping[str, Callable[..., Any]]
    initial: Given
    inputs: Given


class Batch:
    """The loop for one sweep; calls may come from several threads."""

    def __init__(self, asked: Asked, kept: Plan) -> None:
        self.asked, self.plan = asked, kept
        self._model = batch_model(asked.family)
        self._time, self._grid = np.ascontiguousarray(asked.time), grid_of(asked.time)
        self._rooms: dict[int, list[Room]] = {}
        self._lock = Lock()
        self._shared: tuple[Engine, Packed, Array] | None = None
        self.statuses: Counter[int] = Counter()

    def __call__(
        self, rows: Sequence[Sequence[float]] | Array
    ) -> tuple[tuple[Array, ...], list[int]]:
        """A column for each measure, and which runs have to be done another way."""
        table = np.asarray(rows, dtype=float).reshape(len(rows), len(self.asked.names))
        found = np.empty((len(table), self.plan.width))
        done = np.zeros(len(table), dtype=bool)
        with self._lock:
            parameters, usable = self._parameters(table)
            states, settled = self._states(table)
            groups = self._inputs(table, np.flatnonzero(usable & settled))
        for inputs in groups:
            indices = inputs.indices
            results, status = self._run(inputs, parameters[indices], states[indices])
            with self._lock:
                kinds, counts = np.unique(status, return_counts=True)
                self.statuses.update(dict(zip(kinds.tolist(), counts.tolist(), strict=True)))
            found[indices], done[indices] = results, status == 0
        return self.plan.columns(found), np.flatnonzero(~done).tolist()

    def _parameters(self, table: Array) -> tuple[Array, Flags]:
        """The parameters of each run, and which runs' elements have values that can be used."""
        model = self._model
        parameters = np.tile(model.defaults, (len(table), 1))
        for column, name in enumerate(self.asked.names):
            for at, symbol in enumerate(model.program.parameters):
                if symbol.name == name:
                    parameters[:, at] = table[:, column]
        with np.errstate(all="ignore"):
            usable = model.usable(parameters)
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
            shared = self._shared or self._share(asked.inputs or {}, begin, end)
            engine, packed, constants = shared
            places = [names.index(name) for name in swept]
            held = table[:, [*swept.values()]]
            return [varied(engine, packed, constants, places, held, indices)]
        made: dict[int, list[tuple[int, Any]]] = {}
        for k in indices.tolist():
            values = dict(zip(asked.names, table[k].tolist(), strict=True))
            try:
                given = dict(asked.inputs(values) or {})
                given |= {name: values[name] for name in swept}
                one = segments(signals_for(given, names), begin, end)
            except Exception:  # noqa: BLE001 - told by whoever does the run then
                continue
            made.setdefault(sizes(self._model.closed, one.slots).G, []).append((k, one))
        return [each(self._model.engine(slots), found) for slots, found in made.items()]

    def _share(
        self, inputs: Mapping[str, Any], begin: float, end: float
    ) -> tuple[Engine, Packed, Array]:
        """The inputs that all runs have; swept ones are zero."""
        asked, names = self.asked, self.asked.family.inputs
        given = {**inputs, **{n: 0.0 for n in asked.names if n in names}}
        made = segments(signals_for(given, names), begin, end)
        engine = self._model.engine(made.slots)
        self._shared = engine, Packed(engine, made), made.constants
        return self._shared

    def _run(
        self, inputs: BatchInputs, parameters: Array, states: Array
    ) -> tuple[Array, NDArray[np.intc]]:
        engine, kept = inputs.engine, self.plan
        ffi, count = engine.ffi, len(inputs.indices)
        results, status = np.empty((count, kept.width)), np.empty(count, dtype=np.intc)
        entries = ffi.new("batch_measure[]", list(kept.entries))
        rows = ffi.new("int[]", list(kept.rows))
        job, runs = engine.new("batch_job"), engine.new("batch_runs")
        job.times = ffi.cast("double *", self._time.ctypes.data)
        job.grid, job.samples, job.width = self._grid, len(self._time), kept.width
        job.signals, job.measures = len(kept.rows), len(kept.entries)
        job.signal, job.measure = rows, entries
        runs.runs = count
        for name, kind, array in (
            ("inputs", "bg_inputs **", inputs.pointers),
            ("parameters", "double *", parameters), ("states", "double *", states),
            ("results", "double *", results), ("status", "int *", status),
        ):  # fmt: skip
            setattr(runs, name, ffi.cast(kind, array.ctypes.data))
        rooms = self._rooms.setdefault(engine.sizes.G, [])
        try:
            room = rooms.pop()
        except IndexError:
            room = Room(engine, len(self._time), len(kept.rows))
        engine.library.batch_run(room.record, job, runs)
        rooms.append(room)
        return results, status


def batch(asked: Asked) -> Batch | None:
    """The loop for a sweep; None where the model or a measure is none that it can do."""
    try:
        program = asked.family.program
        if not _can(asked.family, program, asked.names):
            return None
        kept = plan(asked.measures.values(), program, len(asked.time))
        return None if kept is None else Batch(asked, kept)
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

"""A sweep's runs in one call of C for many, where the backend is C and the measures are ready ones."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from threading import Lock
from typing import Any, Protocol

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from bondgraph.errors import BondGraphError
from bondgraph.reduce.resistances import resistive_loops
from codegen.batch.asked import Asked
from codegen.batch.energy import ENERGETIC, plan, telling
from codegen.batch.exact import ExactLoop
from codegen.batch.located import LocatedLoop
from codegen.batch.model import BatchModel, batch_model
from codegen.batch.plan import Plan
from codegen.batch.rows import Rows
from codegen.engine.located import METHODS as LOCATED_METHODS
from codegen.engine.status import Status
from codegen.family import Family
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array
from codegen.program.records import Program
from codegen.record.measures import READY, Measure
from codegen.runs.methods import EXACT


class Loop(Protocol):
    """Many runs in one call of C; ``shared`` and inputs are the loop's own records."""

    def shared(self, signals: Sequence[Signal], /) -> Any:
        """Inputs of all runs."""

    def alike(
        self, shared: Any, places: Sequence[int], factors: Array, indices: NDArray[np.intp], /
    ) -> Any:
        """The same inputs for these runs, but those at ``places`` times ``factors``."""

    def different(self, found: Sequence[tuple[int, Sequence[Signal]]], /) -> Sequence[Any]:
        """The inputs of each run by its index, in groups that are run together."""

    def run(
        self, inputs: Any, parameters: Array, states: Array, /
    ) -> tuple[Array, NDArray[np.intc], Array]:
        """For each run a row of results, a status, not 0 where it has to be done another way, and what
        its states gain as the start is completed.
        """


FINAL = (Status.OK, Status.ENDLESS, Status.REFUSED)
"""What a further loop would not end otherwise, as single runs are not tried again either."""


class Batch:
    """The loop for one sweep; calls may come from several threads.

    ``rest``: makes the loop for runs that this one cannot do.
    """

    def __init__(
        self, asked: Asked, kept: Plan, model: BatchModel, loop: Loop,
        rest: Callable[[], "Batch"] | None = None,
    ) -> None:  # fmt: skip
        self.asked, self.plan, self.loop = asked, kept, loop
        self._rows, self._rest = Rows(asked, model), None if rest is None else cache(rest)
        self._shared: Any = None
        self._lock = Lock()
        self.statuses: Counter[int] = Counter()

    def __call__(
        self, rows: Sequence[Sequence[float]] | Array
    ) -> tuple[tuple[Array, ...], list[int]]:
        """A column for each measure, and which runs have to be done another way."""
        columns, left, _ = self.telling(rows)
        return columns, left

    def telling(
        self, rows: Sequence[Sequence[float]] | Array
    ) -> tuple[tuple[Array, ...], list[int], Array]:
        """As a call; and of each run the states that were completed, NaN where one was not."""
        table = np.asarray(rows, dtype=float).reshape(len(rows), len(self.asked.names))
        found = np.empty((len(table), self.plan.width))
        ended = np.full(len(table), Status.REFUSED, dtype=np.intc)
        with self._lock:
            parameters, usable = self._rows.parameters(table)
            states, settled = self._rows.states(table)
            completed = np.full_like(states, np.nan)
            groups = self._inputs(table, np.flatnonzero(usable & settled))
        for inputs in groups:
            indices = inputs.indices
            results, status, moved = self.loop.run(inputs, parameters[indices], states[indices])
            with self._lock:
                kinds, counts = np.unique(status, return_counts=True)
                self.statuses.update(dict(zip(kinds.tolist(), counts.tolist(), strict=True)))
            found[indices], ended[indices] = results, status
            followed = (moved != 0) & (status == 0)[:, None]
            completed[indices] = np.where(followed, states[indices] + moved, np.nan)
        columns = self.plan.told(found, self._rows.numbers(table))
        more = np.flatnonzero(~np.isin(ended, FINAL))
        if self._rest is not None and len(more):
            with self._lock:
                rest = self._rest()
            others, left, completed[more] = rest.telling(table[more])
            for column, other in zip(columns, others, strict=True):
                column[more] = other
            ended[more] = Status.OK
            ended[more[left]] = Status.NOT_AFFINE
        return columns, np.flatnonzero(ended).tolist(), completed

    def _inputs(self, table: Array, indices: NDArray[np.intp]) -> Sequence[Any]:
        """The inputs of these runs, in groups that are run together."""
        rows = self._rows
        if not rows.alike:
            return self.loop.different(rows.each(table, indices))
        if self._shared is None:
            self._shared = self.loop.shared(rows.common())
        places, factors = rows.factors(table)
        indices = indices[np.isfinite(factors[indices]).all(axis=1)]
        if not len(indices):
            return []
        with np.errstate(all="ignore"):
            return [self.loop.alike(self._shared, places, factors, indices)]


def batch(asked: Asked) -> Batch | None:
    """The loop for a sweep; None where the model or a measure is none that one can do."""
    try:
        family = asked.family
        if family.backend != "c" or not _can(family, family.program, asked.names):
            return None
        measures = [m for m in asked.measures.values() if isinstance(m, Measure)]
        if len(measures) < len(asked.measures) or any(m.function not in READY for m in measures):
            return None
        told, made = family, None
        if any(READY[m.function] in ENERGETIC for m in measures):
            told, made = telling(family, measures)
        kept = plan(measures, told, made, asked.time, asked.names)
        begun = None if kept is None else _begun(asked, kept)
        return None if begun is None else _looped(replace(asked, family=told), begun)
    except BondGraphError:
        return None


def _begun(asked: Asked, kept: Plan) -> Plan | None:
    """With how runs begin; None where a function tells which states are given, and switches ask for it."""
    program = asked.family.program
    if program.switches and callable(asked.initial):
        return None
    given = () if callable(asked.initial) else (*map(str, asked.initial or ()), *asked.names)
    return replace(
        kept,
        first=program.before(asked.initially_on),
        named=tuple(int(state.name in given) for state in program.states),
    )


def _looped(asked: Asked, kept: Plan) -> Batch | None:
    family, method = asked.family, asked.settings.method
    model, time = batch_model(family), np.ascontiguousarray(asked.time)
    library = family.library

    def located() -> Batch:
        return Batch(asked, kept, model, LocatedLoop(library, time, kept, asked.settings))

    if library.affine and method in ("auto", EXACT):
        rest = located if method in LOCATED_METHODS else None
        return Batch(asked, kept, model, ExactLoop(model, time, kept), rest)
    return located() if method in LOCATED_METHODS else None


def _can(family: Family, program: Program, names: Sequence[str]) -> bool:
    """Whether there are states, steps of inputs show no impulses, and ranks are certain."""
    layout = program.layout
    driven = layout["E"].rows and (layout["H"].rows or program.varying)
    if not program.states or layout["K"].rows or driven:
        return False
    reduction = family.equations.reduction
    loops = [*reduction.structure.loops, *(rows for _, rows in resistive_loops(reduction))]
    entries = [sp.sympify(entry) for rows in loops for row in rows for entry in row.values()]
    return not any(s.name in names for entry in entries for s in entry.free_symbols)

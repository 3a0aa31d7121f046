"""Runs of an affine model by the loop in C that steps exactly."""

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from codegen.batch.call import Rooms, job_record, outcome_of
from codegen.batch.engine import Room
from codegen.batch.inputs import BatchInputs, each, varied
from codegen.batch.model import BatchModel
from codegen.batch.plan import Plan
from codegen.engine.inputs import Segments, inputs_over
from codegen.engine.packed import Packed
from codegen.engine.runs import grid_of
from codegen.engine.sized import sizes
from codegen.engine.sizes import Engine
from codegen.engine.windows import Windows
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array


class Shared(NamedTuple):
    """Inputs, and the engine's record of them."""

    signals: Sequence[Signal]
    engine: Engine
    packed: Packed


class ExactLoop:
    """One sweep's runs; calls of `run` may come from several threads."""

    def __init__(self, model: BatchModel, time: Array, kept: Plan) -> None:
        self._model, self._plan = model, kept
        self._time, self._grid = time, grid_of(time)
        self._rooms: dict[int, Rooms[Room]] = {}

    def shared(self, signals: Sequence[Signal]) -> Shared:
        """Inputs of all runs."""
        made = self._segments(signals)
        engine = self._model.engine(made.slots)
        return Shared(signals, engine, Packed(engine, made, float(self._time[0])))

    def alike(
        self, shared: Shared, places: Sequence[int], factors: Array, indices: NDArray[np.intp]
    ) -> BatchInputs:
        """The same inputs for these runs, but those at ``places`` times ``factors``."""
        if not shared.packed.whole:
            # What is written on as a run goes is of that run alone.
            found = []
            for k in indices.tolist():
                scale = dict(zip(places, factors[k].tolist(), strict=True))
                own = [one.scaled(scale[j]) if j in scale else one
                       for j, one in enumerate(shared.signals)]  # fmt: skip
                found.append((k, self._segments(own)))
            return each(shared.engine, found, float(self._time[0]))
        return varied(shared.engine, shared.packed, places, factors, indices)

    def different(self, found: Sequence[tuple[int, Sequence[Signal]]]) -> list[BatchInputs]:
        """The inputs of each run by its index, those of one engine together."""
        made: dict[int, list[tuple[int, Segments | Windows]]] = {}
        for k, signals in found:
            one = self._segments(signals)
            made.setdefault(sizes(self._model.closed, one.slots).G, []).append((k, one))
        begin = float(self._time[0])
        return [each(self._model.engine(slots), some, begin) for slots, some in made.items()]

    def run(
        self, inputs: BatchInputs, parameters: Array, states: Array
    ) -> tuple[Array, NDArray[np.intc], Array]:
        """For each run a row of results, a status, not 0 where it has to be done another way, and what
        its states gain as the start is completed.
        """
        engine, kept = inputs.engine, self._plan
        job, pointed = job_record(engine.ffi, kept, self._time, self._grid)
        runs = engine.new("batch_runs")
        found = outcome_of(engine.ffi, runs, inputs.pointers, parameters, states, kept.width)
        with self._rooms_of(engine).one() as room:
            engine.library.batch_run(room.record, job, runs)
        del pointed
        return found

    def _rooms_of(self, engine: Engine) -> Rooms[Room]:
        kept = self._plan
        sizes = len(kept.rows), len(kept.factors), len(kept.products)
        make = partial(Room, engine, kept.samples, *sizes, kept.eventful)
        return self._rooms.setdefault(engine.sizes.G, Rooms(make))

    def _segments(self, signals: Sequence[Signal]) -> Segments | Windows:
        return inputs_over(signals, float(self._time[0]), float(self._time[-1]))

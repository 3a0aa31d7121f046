"""From a chunk of runs to its outcome, in this process or in another."""

import pickle
import time
from collections.abc import Mapping
from functools import lru_cache
from threading import Lock
from weakref import WeakKeyDictionary

import numpy as np

from bondgraph.errors import SignalError
from codegen.abreast.abreast import Abreast, abreast
from codegen.abreast.asked import Asked as Wanted
from codegen.batch.asked import Asked
from codegen.batch.batch import Batch, batch
from codegen.family import Family
from codegen.numbers.arrays import Array
from codegen.packing import packed
from codegen.record.result import Result
from codegen.runs.track import Settings
from codegen.sweeps.chunks import Chunk, Outcome
from codegen.sweeps.columns import Columns
from codegen.sweeps.job import Job
from codegen.tuning import TUNING


def measured(job: Job, chunk: Chunk) -> Outcome:
    """The outcome of a chunk, run after run."""
    start = time.perf_counter()
    loop = batch_of(job)
    rows = np.asarray(chunk.rows, dtype=float)
    fallen: list[str] = []
    starts: list[dict[str, float]] = [{} for _ in rows]
    results: tuple[tuple[Array, ...] | str, ...] | Columns
    if loop is None:
        side = abreast_of(job)
        none: list[Result | None] = [None] * len(rows)
        found = none if side is None else side.results(rows, job.record)
        each = zip(rows.tolist(), starts, found, strict=True)
        results = tuple(
            job.run(row, fallen, own) if one is None else job.measured(one)
            for row, own, one in each
        )
    else:
        columns, left, completed = loop.telling(rows)
        for at in np.flatnonzero(np.isfinite(completed).any(axis=1)):
            named = zip(job.model.states, completed[at].tolist(), strict=True)
            starts[at] |= {name: value for name, value in named if np.isfinite(value)}
        results = Columns(
            columns, {at: job.run(rows[at].tolist(), fallen, starts[at]) for at in left}
        )
    told = {int(index): own for index, own in zip(chunk.indices, starts, strict=True) if own}
    return Outcome(chunk.indices, results, time.perf_counter() - start, tuple(fallen), told)


def batch_of(job: Job) -> Batch | None:
    """The loop in C for the runs of a job, made once; None where there is none."""
    with _making:
        if job not in _batches:
            model, settings = job.model, Settings(**job.settings)
            asked = (
                job.names,
                job.time,
                job.measures,
                job.initial,
                job.inputs,
                settings,
                job.initially_on,
            )
            _batches[job] = None
            if isinstance(model, Family) and not (model.program.steps or model.program.delayed):
                _batches[job] = batch(Asked(model, *asked))
        return _batches[job]


def abreast_of(job: Job) -> Abreast | None:
    """What does the runs of a job side by side in numpy, made once; None where there is none."""
    with _making:
        if job not in _abreast:
            _abreast[job] = _made(job)
        return _abreast[job]


def _made(job: Job) -> Abreast | None:
    model, initial, inputs = job.model, job.initial or {}, job.inputs or {}
    if not isinstance(model, Family) or job.initially_on or job.runs < TUNING.side_by_side:
        return None
    if not isinstance(initial, Mapping) or not isinstance(inputs, Mapping):
        return None
    method = Settings(**job.settings).method
    asked = Wanted(model, job.names, job.time, initial, inputs, method, job.eventful)
    return abreast(asked)


_abreast: WeakKeyDictionary[Job, Abreast | None] = WeakKeyDictionary()
_batches: WeakKeyDictionary[Job, Batch | None] = WeakKeyDictionary()
_making = Lock()


def sent(job: Job) -> bytes:
    """The job for other processes; `SignalError` where a part of it cannot be sent."""
    try:
        return packed(job)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise SignalError(
            f"the sweep cannot be sent to other processes: {error}; define measures at the top of a "
            "module, or let the runs be done in this process with workers=0"
        ) from None


@lru_cache(maxsize=4)
def received(job: bytes) -> Job:
    """The job that was sent; kept, so that a process makes it once."""
    found = pickle.loads(job)
    assert isinstance(found, Job)
    return found


def measured_remotely(job: bytes, chunk: bytes) -> Outcome:
    """The outcome of a chunk in another process."""
    return measured(received(job), pickle.loads(chunk))

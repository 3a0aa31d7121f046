"""One call of C for many runs: its records, and the rooms that threads take turns in."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from codegen.batch.plan import Plan
from codegen.numbers.arrays import Array

T = TypeVar("T")


class Rooms(Generic[T]):
    """What threads need one each of at a time, made when all there are are taken."""

    def __init__(self, make: Callable[[], T]) -> None:
        self._make, self._free = make, list[T]()

    @contextmanager
    def one(self) -> Iterator[T]:
        """One that nobody else has inside."""
        try:
            room = self._free.pop()
        except IndexError:
            room = self._make()
        yield room
        self._free.append(room)


def job_record(ffi: Any, kept: Plan, time: Array, grid: float) -> tuple[Any, list[Any]]:
    """What runs share as ``batch_job``, and what has to be kept while that is used."""
    entries = ffi.new("batch_measure[]", list(kept.entries))
    rows = ffi.new("int[]", [*kept.rows, *kept.factors, 0])
    products = ffi.new("batch_product[]", [*kept.products, (-1, -1)])
    job = ffi.new("batch_job *")
    job.times, job.grid = ffi.cast("double *", time.ctypes.data), grid
    job.samples, job.width = kept.samples, kept.width
    first, named = ffi.new("int[]", [*kept.first, 0]), ffi.new("int[]", [*kept.named, 0])
    job.first, job.named = first, named
    job.signals, job.factors = len(kept.rows), len(kept.factors)
    job.products, job.measures = len(kept.products), len(kept.entries)
    job.signal, job.product, job.measure = rows, products, entries
    return job, [entries, rows, products, first, named]


def outcome_of(
    ffi: Any, runs: Any, inputs: NDArray[np.uintp], parameters: Array, states: Array, width: int
) -> tuple[Array, NDArray[np.intc], Array]:
    """Fill in the record of what each run has of its own.

    For each a row of results, a status, and what its states gain as the start is completed.
    """
    count = len(inputs)
    results, status = np.empty((count, width)), np.empty(count, dtype=np.intc)
    moved = np.zeros_like(states)
    runs.runs = count
    for name, array in (
        ("inputs", inputs), ("parameters", parameters), ("states", states), ("results", results),
        ("status", status), ("moved", moved),
    ):  # fmt: skip
        setattr(runs, name, ffi.cast("void *", array.ctypes.data))
    return results, status, moved

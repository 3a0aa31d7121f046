"""Inputs of many runs as the engine's records."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.engine.inputs import Segments
from codegen.engine.packed import Packed
from codegen.engine.sizes import Engine
from codegen.engine.windows import Windows
from codegen.numbers.arrays import Array


@dataclass(frozen=True)
class BatchInputs:
    """A pointer to a record for each of the runs at ``indices``; ``kept`` is what these point to."""

    engine: Engine
    indices: NDArray[np.intp]
    pointers: NDArray[np.uintp]
    kept: Any


def varied(
    engine: Engine, packed: Packed, places: Sequence[int], factors: Array, indices: NDArray[np.intp]
) -> BatchInputs:
    """The same record for all runs; or for each of them one whose inputs at ``places`` are multiplied.

    ``factors``: a row for each run of the sweep's part, a column for each place.
    """
    count = len(indices)
    pointers = np.empty(count, dtype=np.uintp)
    if not places:
        pointers[:] = _address(engine, packed.record)
        return BatchInputs(engine, indices, pointers, packed)
    scale = np.ones((count, packed.constant.shape[1] + 1))
    scale[:, list(places)] = factors[indices]
    record = np.frombuffer(engine.ffi.buffer(packed.record), dtype=np.uint8)
    records = np.tile(record, (count, 1))
    own, owner = {"constant": packed.constant * scale[:, None, :-1]}, packed.owner
    if np.isin(owner, places).any():
        # Slots without an owner have the last column's one.
        own["polynomial"] = packed.polynomial * scale[:, owner]
    # Results of indexing need not lie in memory run by run.
    own = {name: np.ascontiguousarray(array) for name, array in own.items()}
    for name, array in own.items():
        at = engine.ffi.offsetof("ex_inputs", name)
        addresses = array.ctypes.data + array[0].nbytes * np.arange(count, dtype=np.uintp)
        records[:, at : at + addresses.itemsize] = addresses[:, None].view(np.uint8)
    pointers[:] = records.ctypes.data + len(record) * np.arange(count, dtype=np.uintp)
    return BatchInputs(engine, indices, pointers, (packed, own, records))


def each(
    engine: Engine, found: Sequence[tuple[int, Segments | Windows]], begin: float
) -> BatchInputs:
    """A record for each run, which begins at that time [s]."""
    packed = [Packed(engine, made, begin) for _, made in found]
    pointers = np.array([_address(engine, one.record) for one in packed], dtype=np.uintp)
    return BatchInputs(engine, np.array([k for k, _ in found]), pointers, packed)


def _address(engine: Engine, record: Any) -> int:
    return int(engine.ffi.cast("uintptr_t", record))

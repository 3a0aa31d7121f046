"""Inputs of many runs as the engine's records."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.arrays import Array
from codegen.engine.inputs import Packed, Segments
from codegen.engine.sizes import Engine


@dataclass(frozen=True)
class BatchInputs:
    """A pointer to a record for each of the runs at ``indices``; ``kept`` is what these point to."""

    engine: Engine
    indices: NDArray[np.intp]
    pointers: NDArray[np.uintp]
    kept: Any


def varied(
    engine: Engine,
    packed: Packed,
    constants: Array,
    places: Sequence[int],
    values: Array,
    indices: NDArray[np.intp],
) -> BatchInputs:
    """One record for all runs, or the same with other ``constants`` at ``places`` for each of them."""
    count = len(indices)
    pointers = np.empty(count, dtype=np.uintp)
    if not places:
        pointers[:] = _address(engine, packed.record)
        return BatchInputs(engine, indices, pointers, packed)
    constants = np.tile(constants, (count, 1, 1))
    constants[:, :, list(places)] = values[indices][:, None, :]
    record = np.frombuffer(engine.ffi.buffer(packed.record), dtype=np.uint8)
    records = np.tile(record, (count, 1))
    at = engine.ffi.offsetof("bg_inputs", "constant")
    own = constants.ctypes.data + constants[0].nbytes * np.arange(count, dtype=np.uintp)
    records[:, at : at + own.itemsize] = own[:, None].view(np.uint8)
    pointers[:] = records.ctypes.data + len(record) * np.arange(count, dtype=np.uintp)
    return BatchInputs(engine, indices, pointers, (packed, constants, records))


def each(engine: Engine, found: Sequence[tuple[int, Segments]]) -> BatchInputs:
    """A record for each run."""
    packed = [Packed(engine, made) for _, made in found]
    pointers = np.array([_address(engine, one.record) for one in packed], dtype=np.uintp)
    return BatchInputs(engine, np.array([k for k, _ in found]), pointers, packed)


def _address(engine: Engine, record: Any) -> int:
    return int(engine.ffi.cast("uintptr_t", record))

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
    pointers: Any
    kept: Any


def varied(
    engine: Engine, made: Segments, places: Sequence[int], values: Array, indices: NDArray[np.intp]
) -> BatchInputs:
    """One record for all runs, or the same with other constants at ``places`` for each of them."""
    ffi, count = engine.ffi, len(indices)
    packed = Packed(engine, made)
    if not places:
        pointers = ffi.new("bg_inputs *[]", [packed.record] * count)
        return BatchInputs(engine, indices, pointers, packed)
    constants = np.tile(made.constants, (count, 1, 1))
    constants[:, :, list(places)] = values[indices][:, None, :]
    records = ffi.new("bg_inputs[]", count)
    pointers = ffi.new("bg_inputs *[]", count)
    for k in range(count):
        records[k] = packed.record[0]
        records[k].constant = ffi.cast(
            f"double(*)[{engine.sizes.W}]", constants.ctypes.data + k * constants[0].nbytes
        )
        pointers[k] = records + k
    return BatchInputs(engine, indices, pointers, (packed, constants, records))


def each(engine: Engine, found: Sequence[tuple[int, Segments]]) -> BatchInputs:
    """A record for each run."""
    packed = [Packed(engine, made) for _, made in found]
    pointers = engine.ffi.new("bg_inputs *[]", [one.record for one in packed])
    return BatchInputs(engine, np.array([k for k, _ in found]), pointers, packed)

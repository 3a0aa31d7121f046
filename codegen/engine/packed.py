"""Inputs as the engine's record, which points to rows of segments and may ask for the next ones."""

import math
from contextlib import suppress
from typing import Any

import numpy as np

from codegen.engine.chains import Rows, slots_of
from codegen.engine.handing import asked_by_c
from codegen.engine.inputs import Segments
from codegen.engine.sizes import Engine
from codegen.engine.windows import Windows
from codegen.numbers.arrays import Array

ALL = 1 << 40
"""Segments: more than there are."""


class Packed:
    """Segments as the engine's record, whose arrays have a row for each segment.

    ``constant``: what each input is but for its chains. ``polynomial``: coefficients of the chains by
    slot; ``owner``: the input of a slot, -1 where there is none. ``whole``: whether these are all segments
    of the run; the record of others is written on as a run goes, so it is of one run at a time.
    """

    def __init__(self, engine: Engine, made: Segments | Windows, begin: float) -> None:
        self.record = engine.new("ex_inputs")
        self._engine, self._made, self.failed = engine, made, None
        self._structures(engine, made)
        self._write(made.rows(begin, engine.sizes.G))
        self.whole = self.record.until == math.inf
        if not self.whole:
            with suppress(MemoryError):  # on machines that let no code be made, all at once
                self._answer = asked_by_c(engine.ffi, "int(void *, double)", self._more, self._keep)
                self.record.more = self._answer
                return
            self._write(made.rows(begin, engine.sizes.G, ALL))
            self.whole = True

    failed: BaseException | None

    def _more(self, _: Any, t: float) -> int:
        """Write the segments from t on."""
        self._write(self._made.rows(t, self._engine.sizes.G))
        return 0

    def _keep(self, error: BaseException) -> None:
        self.failed = error

    def _write(self, rows: Rows) -> None:
        ffi, sizes, self._kept = self._engine.ffi, self._engine.sizes, list[Any]()
        self.constant, self.polynomial = rows.constants, rows.polynomials
        for name, array, kind in (
            ("breaks", rows.breaks, "double *"), ("fastest", rows.fastest, "double *"),
            ("constant", rows.constants, f"double(*)[{sizes.W}]"),
            ("start", rows.starts, f"double(*)[{sizes.G}]"),
            ("polynomial", rows.polynomials, f"double(*)[{sizes.G}]"),
            ("chains", rows.chains, "int *"),
        ):  # fmt: skip
            self._kept.append(array)
            setattr(self.record, name, ffi.cast(kind, array.ctypes.data))
        self.record.since, self.record.until = rows.since, rows.until
        self.record.segments = len(rows.chains)
        self._chains = rows.chains

    @property
    def owner(self) -> Array:
        """The input of each slot in each segment, -1 where there is none."""
        owners = np.full((len(self._made.structures), self._engine.sizes.G), -1)
        for row, chains in zip(owners, self._made.structures, strict=True):
            firsts = np.cumsum([0, *map(slots_of, chains)]).tolist()
            for chain, first in zip(chains, firsts, strict=False):
                row[first : first + slots_of(chain)] = chain[0]
        return np.asarray(owners[self._chains])

    def _structures(self, engine: Engine, made: Segments | Windows) -> None:
        records = engine.ffi.new("ex_chains[]", len(made.structures))
        for record, chains in zip(records, made.structures, strict=True):
            first = np.cumsum([0, *map(slots_of, chains)]).tolist()
            record.count = len(chains)
            for i, (j, rate, depth) in enumerate(chains):
                record.input[i], record.first[i], record.depth[i] = j, first[i], depth
                record.width[i] = 2 if rate.imag else 1
                record.rate[i][0], record.rate[i][1] = rate.real, rate.imag
        self._structured = records
        self.record.structures = records

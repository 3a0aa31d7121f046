"""How large the terms are that make up what friction levels are: where they cancel, rounding remains."""

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.instant import Binding, Instant
from codegen.numbers.arrays import Array
from codegen.program.records import Block, Program
from codegen.tuning import TUNING


def without_rounding(values: Array, terms: Array) -> Array:
    """Values of which those are zero that are below zero by no more than the rounding of their terms."""
    return np.where((values < 0) & (values >= -TUNING.rounding * terms), 0.0, values)


class LevelTerms:
    """For each of a program's friction values the sum of the magnitudes of the terms that make it up.

    A term is the effect of a small relative change of one name, divided by the change. What a law gives,
    or a reading shows, is as large as its own terms: a level ``mu F`` with ``F = F_0 - F_0 n`` is zero at
    n = 1, but only to the rounding of ``mu F_0``.
    """

    def __init__(self, program: Program, binding: Binding) -> None:
        self._program, self._binding = program, binding

    def __call__(self, now: Instant) -> Array:
        """At an instant that is complete but for the friction."""
        program = self._program
        pool = self._binding.pool(now)
        sizes, ends = np.abs(pool), np.cumsum([1, len(now.x), len(now.z), len(now.y), len(now.u)])
        if now.seen is not None:
            own = slice(1, ends[2])
            sizes[own] = np.maximum(sizes[own], now.seen[: ends[2] - 1])
        x, y, u = slice(1, ends[1]), slice(ends[2], ends[3]), slice(ends[3], ends[4])

        def show() -> None:
            sizes[y] = np.abs(now.numbers.F) @ sizes[x] + np.abs(now.numbers.D) @ sizes[u]
            sizes[y] += np.abs(now.numbers.G) @ np.abs(now.du)

        for group in (program.known, *program.groups, program.coupled):
            if group.inputs:
                show()
                sizes[ends[3] + np.array(group.inputs)] = self._terms(group.values, pool, sizes)
        show()
        return self._terms(program.friction_values, pool, sizes)

    def _terms(self, code: Block, pool: Array, sizes: Array) -> Array:
        evaluate = self._binding.of_pool(code)
        values = evaluate(pool)
        terms = np.abs(values)
        for at in self._binding.read(code):
            moved = pool.copy()
            moved[at] += np.copysign(TUNING.term * sizes[at], pool[at])
            try:
                change = np.abs(evaluate(moved) - values) / TUNING.term
            except SimulationError:
                continue
            terms += np.nan_to_num(change, nan=0.0, posinf=0.0)
        return terms

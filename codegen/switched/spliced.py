"""A run through several phases as one result: every signal of each, one after the other."""

from collections.abc import Hashable
from dataclasses import dataclass

import numpy as np

from codegen.numbers.arrays import Array
from codegen.record.result import Result


@dataclass(frozen=True)
class Spliced:
    """The results of a run's phases, in turn; signals are those that all phases have."""

    parts: tuple[Result, ...]

    def signal(self, name: str) -> Array:
        """A named effort or flow."""
        return np.concatenate([part[name] for part in self.parts])

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond."""
        pairs = [part.bond(tail, head) for part in self.parts]
        efforts, flows = zip(*pairs, strict=True)
        return np.concatenate(efforts), np.concatenate(flows)

    def power(self, node: Hashable) -> Array:
        """Power that an I, C, R or switch absorbs, or that a source supplies."""
        return np.concatenate([part.power(node) for part in self.parts])

    def energy(self, node: Hashable) -> Array:
        """Energy stored in an I or C."""
        return np.concatenate([part.energy(node) for part in self.parts])

"""Starts of a sweep that tell what storages hold: each run's by its own numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import normal
from codegen.batch.asked import Given
from codegen.family import Family
from codegen.model.starts import by_states


@dataclass(frozen=True)
class ByStates:
    """The initial values of a run, by states, from its numbers."""

    family: Family
    initial: Given

    def __call__(self, values: Mapping[str, float]) -> dict[str, Any]:
        """Raises `SignalError` for what states cannot hold."""
        told = self.initial(values) if callable(self.initial) else self.initial
        numbers = {**self.family.parameters, **values}
        own = {name: numbers[name] for name in map(str, self.family.equations.parameters)
               if name in numbers}  # fmt: skip
        return by_states(self.family.equations, own, told or {})


def by_states_of(model: object, initial: Given) -> Given:
    """As it is given, unless it names what a storage holds, or may: then by each run's numbers."""
    if not isinstance(model, Family):
        return initial
    held = model.equations.held
    if isinstance(initial, Mapping):
        named = {sp.Symbol(str(normal(name))) for name in initial}
        return ByStates(model, initial) if named & held.keys() else initial
    return ByStates(model, initial) if callable(initial) and held else initial

"""Starts of a sweep that tell what storages hold: each run's by its own numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from bondgraph.algebra.atoms import normal
from codegen.batch.asked import Given
from codegen.family import Family
from codegen.model.starts import by_states
from codegen.sweeps.job import Model


@dataclass(frozen=True)
class ByStates:
    """The initial values of a run, by states, from its numbers; ``swept``: of these those that are starts."""

    family: Family
    initial: Given
    swept: tuple[str, ...] = ()

    def __call__(self, values: Mapping[str, float]) -> dict[str, Any]:
        """Raises `SignalError` for what states cannot hold."""
        told = self.initial(values) if callable(self.initial) else self.initial
        told = {**(told or {}), **{name: values[name] for name in self.swept}}
        numbers = {**self.family.parameters, **values}
        own = {name: numbers[name] for name in map(str, self.family.equations.parameters)
               if name in numbers}  # fmt: skip
        return by_states(self.family.equations, own, told)


def by_states_of(model: object, initial: Given, names: Sequence[str] = ()) -> Given:
    """As it is given, unless it or a swept name tells what a storage holds: then by each run's numbers."""
    told = callable(initial) or isinstance(initial, Mapping | None)
    if not told or not isinstance(model, Family):
        return initial
    held = {name.name for name in model.equations.held}
    swept = tuple(name for name in names if name in held or name in model.states)
    named = held if callable(initial) else {str(normal(name)) for name in initial or {}}
    return ByStates(model, initial, swept) if held & {*named, *swept} else initial


def starts_of(model: Model) -> tuple[str, ...]:
    """What a run's initial values may name: states, and of a family what its storages hold."""
    held = map(str, model.equations.held) if isinstance(model, Family) else ()
    return (*model.states, *held)

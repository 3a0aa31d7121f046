"""What a sweep asks of runs side by side: what all share, and what each has numbers for."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from bondgraph.algebra.atoms import normal
from codegen.family import Family
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.inputs.swept import Swept
from codegen.model.exact_values import exact_parameters
from codegen.numbers.arrays import Array
from codegen.runs.arguments import initial_values, signals_for


class Asked(NamedTuple):
    """A family, what each run has numbers for, times [s], initial values, inputs, the method.

    ``events``: whether they are kept.
    """

    family: Family
    names: tuple[str, ...]
    times: Array
    initial: Mapping[str, float]
    inputs: Mapping[str, Any]
    method: str
    events: bool

    @property
    def swept(self) -> frozenset[str]:
        """The parameters that are others in each run."""
        return frozenset(self.names) & frozenset(self.family.parameters)

    def changes(self, row: Array) -> dict[str, float]:
        """A run's own parameters."""
        own = zip(self.names, row.tolist(), strict=True)
        return {name: value for name, value in own if name in self.swept}

    def parameters(self, rows: Array) -> dict[str, float | Array]:
        """All parameters: numbers, or arrays of those of the runs."""
        exact = exact_parameters(self.family.parameters)
        found: dict[str, float | Array] = {name: float(value) for name, value in exact.items()}
        own = {name: rows[:, at].copy() for at, name in enumerate(self.names) if name in self.swept}
        return {**found, **own}

    def states(self, rows: Array) -> Array:
        """The states of the runs at their starts."""
        names = self.family.states
        given = {str(normal(name)): value for name, value in self.initial.items()}
        found = np.tile(initial_values(given, names), (len(rows), 1))
        for at, name in enumerate(self.names):
            if name in names:
                found[:, names.index(name)] = rows[:, at]
        return found


class Sized:
    """The external inputs as all runs share them, and the sizes in which each has them."""

    def __init__(self, asked: Asked) -> None:
        inputs = {str(normal(name)): value for name, value in asked.inputs.items()}
        columns = {name: at for at, name in enumerate(asked.names)}
        names, sized = asked.family.inputs, dict[str, int]()
        for name in names:
            if name in columns:
                inputs[name], sized[name] = Constant(1.0), columns[name]
            elif isinstance(value := inputs.get(name), Swept):
                inputs[name], sized[name] = value.signal, columns[value.name]
        self.units: list[Signal] = signals_for(inputs, names)
        self._columns = {names.index(name): at for name, at in sized.items()}

    def sizes(self, rows: Array) -> Array:
        """Of the runs' inputs, by columns."""
        found = np.ones((len(rows), len(self.units)))
        for at, column in self._columns.items():
            found[:, at] = rows[:, column]
        return found

    def of(self, row: Array) -> list[Signal]:
        """Those of one run."""
        own = self._columns
        return [
            float(row[own[at]]) * unit if at in own else unit for at, unit in enumerate(self.units)
        ]

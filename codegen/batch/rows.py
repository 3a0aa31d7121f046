"""`Rows`: what each run of a sweep is given, from its row of numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bondgraph.algebra.atoms import normal
from codegen.batch.asked import Asked
from codegen.batch.model import BatchModel, Flags
from codegen.inputs.signal import Signal
from codegen.inputs.swept import Swept, settled
from codegen.inputs.tables import has_table
from codegen.model.exact_values import exact_parameters
from codegen.model.sources import source_signals
from codegen.model.starts import starts_of_runs
from codegen.numbers.arrays import Array
from codegen.runs.arguments import named_numbers, signals_for


@dataclass(frozen=True)
class Rows:
    """Parameters, states and inputs of runs, over tables of a row for each run."""

    asked: Asked
    model: BatchModel

    def numbers(self, table: Array) -> Mapping[str, Array]:
        """The parameters of each run by name."""
        exact = exact_parameters(self.asked.family.parameters)
        known = {name: np.full(len(table), float(value)) for name, value in exact.items()}
        swept = {name: table[:, at] for at, name in enumerate(self.asked.names) if name in known}
        return known | swept

    def parameters(self, table: Array) -> tuple[Array, Flags]:
        """The parameters of each run, and which runs' elements have values that can be used."""
        model = self.model
        parameters = np.tile(model.defaults, (len(table), 1))
        for column, name in enumerate(self.asked.names):
            for at, symbol in enumerate(model.program.parameters):
                if symbol.name == name:
                    parameters[:, at] = table[:, column]
        with np.errstate(all="ignore"):
            usable = model.usable(parameters)
        return np.ascontiguousarray(parameters), usable

    def states(self, table: Array) -> tuple[Array, Flags]:
        """The states at the start of each run, and which of them can be used."""
        asked, names = self.asked, self.asked.family.states
        states, usable = np.zeros((len(table), len(names))), np.ones(len(table), dtype=bool)
        equations = self.model.program.equations
        for name, start in starts_of_runs(equations, self.numbers(table), len(table)).items():
            states[:, names.index(name)] = start
        if callable(asked.initial):
            for k, values in enumerate(self._named(table)):
                try:
                    numbers = named_numbers(dict(asked.initial(values) or {}), names)
                except Exception:  # noqa: BLE001 - told by whoever does the run then
                    usable[k] = False
                    continue
                states[k] = [
                    numbers.get(name, begun) for name, begun in zip(names, states[k], strict=True)
                ]
        else:
            numbers = named_numbers(asked.initial or {}, names)
            for name, value in numbers.items():
                states[:, names.index(name)] = value
        for column, name in enumerate(asked.names):
            if name in names:
                states[:, names.index(name)] = table[:, column]
        return states, usable & np.isfinite(states).all(axis=1)

    @property
    def alike(self) -> bool:
        """Whether all runs have the same inputs, but for factors, and the same known sources."""
        sources, names = self.model.program.sources, self.asked.names
        differ = any(s.name in names for expr in sources for s in expr.free_symbols)
        if callable(self.asked.inputs) or differ:
            return False
        given = [one.signal if isinstance(one, Swept) else one for one in self._given.values()]
        return has_table([one for one in given if isinstance(one, Signal)])

    def common(self) -> list[Signal]:
        """The inputs of all runs that are alike, those that factors differ in at the factor 1."""
        units = {name: one.signal for name, one in self._sized.items()}
        return [
            *signals_for({**self._given, **units}, self.asked.family.inputs),
            *self._sources({}),
        ]

    def factors(self, table: Array) -> tuple[Sequence[int], Array]:
        """The places of inputs that factors differ in, and these of each run."""
        asked, sized = self.asked, self._sized
        places = [asked.family.inputs.index(str(normal(name))) for name in sized]
        return places, table[:, [asked.names.index(one.name) for one in sized.values()]]

    def each(self, table: Array, indices: NDArray[np.intp]) -> list[tuple[int, Sequence[Signal]]]:
        """The inputs of each of these runs by itself; without those whose inputs have none."""
        asked, names = self.asked, self.asked.family.inputs
        found: list[tuple[int, Sequence[Signal]]] = []
        for k, values in zip(indices.tolist(), self._named(table[indices]), strict=True):
            try:
                told = asked.inputs(values) if callable(asked.inputs) else asked.inputs
                given = settled(told or {}, values)
                given |= {name: values[name] for name in self._swept}
                found.append((k, [*signals_for(given, names), *self._sources(values)]))
            except Exception:  # noqa: BLE001 - told by whoever does the run then
                continue
        return found

    @property
    def _swept(self) -> list[str]:
        return [name for name in self.asked.names if name in self.asked.family.inputs]

    @property
    def _given(self) -> dict[str, object]:
        inputs = self.asked.inputs
        told = {} if inputs is None or callable(inputs) else inputs
        return {**told, **{name: Swept(name) for name in self._swept}}

    @property
    def _sized(self) -> dict[str, Swept]:
        return {name: one for name, one in self._given.items() if isinstance(one, Swept)}

    def _sources(self, values: Mapping[str, float]) -> list[Signal]:
        """What known sources do in a run with these numbers."""
        family, time = self.asked.family, self.asked.time
        own = {name: value for name, value in values.items() if name in family.parameters}
        numbers = exact_parameters({**family.parameters, **own})
        return source_signals(self.model.program, numbers, float(time[0]), float(time[-1]))

    def _named(self, table: Array) -> list[dict[str, float]]:
        return [dict(zip(self.asked.names, row, strict=True)) for row in table.tolist()]

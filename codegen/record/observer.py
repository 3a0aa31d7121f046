"""Signals of a run that were not recorded, worked out from those that were."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, StructureError, nearest
from bondgraph.nodes.tasks import Transition
from bondgraph.reduce.record import Reading
from codegen.energy.stored import stored_energy
from codegen.model.exact_values import at_parameters
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, real_array
from codegen.numbers.lambdified import lambdified


@dataclass(frozen=True)
class Observer:
    """The states, inputs and both's rates of every sample, and the equations that rule the rest.

    ``x`` and ``dx`` (samples x states), ``u`` and ``du`` (samples x inputs), as the equations number them.
    """

    time: Array
    model: ClosedModel
    columns: Mapping[str, Array]
    x: Array
    dx: Array
    u: Array
    du: Array

    @property
    def _equations(self) -> StateEquations:
        return self.model.equations

    def names(self) -> tuple[str, ...]:
        """Every named effort and flow of the graph, and what its storages hold; not of parts of signals."""
        names = map(str, (*self._equations.signals, *self._equations.held))
        return tuple(name for name in names if name not in self.model.program.inner)

    def nodes(self) -> tuple[Hashable, ...]:
        """The nodes of the graph and the ports of its fields."""
        return self.model.program.nodes

    def transitions(self) -> tuple[Transition, ...]:
        """Those of the graph's state machines."""
        return self.model.program.transitions

    def signal(self, name: str) -> Array:
        """A named effort or flow, or what a storage holds; `KeyError` naming what there is."""
        row = self._equations.signals.get(sp.Symbol(name))
        if row is not None:
            return self._values(self._equations.reduction.reading(row))
        held = self._equations.held
        if sp.Symbol(name) in held:
            return self._at(held[sp.Symbol(name)])
        inner = self.model.program.inner
        known = [*dict.fromkeys([*(n for n in self.columns if n not in inner), *self.names()])]
        raise KeyError(f"no signal {name!r}{nearest(name, known)}; there are {', '.join(known)}")

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond; `StructureError` if there is none."""
        effort, flow = self._equations.bond(tail, head)
        return self._values(effort), self._values(flow)

    def power(self, node: Hashable) -> Array:
        """Effort times flow of a one-port, or of all ports of a field: absorbed, or supplied by a source."""
        structure = self._equations.reduction.structure
        powers = []
        for at, port in enumerate(structure.ports):
            if node in (port.element.name, port.element.owner):
                given = self._values(self._equations.reduction.reading({at: sp.Integer(1)}))
                received = self._values(self._equations.reduction.reading(structure.rows[at]))
                supplies = port.element.kind.supplies and port.inward == 1
                powers.append(-given * received if supplies else given * received)
        if not powers:
            raise StructureError(
                f"{node!r} is not a one-port of the graph; only those have a power"
            )
        return np.asarray(sum(powers), dtype=float)

    def energy(self, node: Hashable) -> Array:
        """The energy in an I or C or a field of them: of its co-energy variables, or its energy function."""
        energy = stored_energy(self._equations, node, self.model.parameters)
        unknown = [name for name in sorted(energy.free_symbols, key=str) if not self._knows(name)]
        if unknown:
            raise ParameterError(
                f"the energy of {node!r} needs a number for {unknown[0]} in parameters, which the run did not"
            )
        return self._at(energy)

    def _at(self, expr: sp.Expr) -> Array:
        """An expression over signals and parameters, at every sample."""
        exact = at_parameters(expr, self.model.parameters)
        names = sorted(exact.free_symbols, key=str)
        given = [self.time if name == TIME else self._named(name.name) for name in names]
        result: Array = np.zeros(len(self.time)) + real_array(lambdified(names, exact)(*given))
        return result

    def _knows(self, name: sp.Symbol) -> bool:
        return name == TIME or name.name in self.columns or name in self._equations.signals

    def _named(self, name: str) -> Array:
        return np.asarray(self.columns[name]) if name in self.columns else self.signal(name)

    def _values(self, reading: Reading) -> Array:
        """A reading at every sample."""
        result = np.zeros(len(self.time))
        tables = (self.x, self.u, self.dx, self.du)
        for row, table in zip(reading.parts, tables, strict=True):
            for column, entry in row.items():
                result += self._number(entry) * table[:, column]
        return result

    def _number(self, entry: sp.Expr) -> float | Array:
        """A coefficient: a number, or a value for every sample where it changes in time."""
        exact = at_parameters(entry, self.model.parameters)
        names = sorted(exact.free_symbols, key=str)
        unknown = [name.name for name in names if name != TIME and name.name not in self.columns]
        if unknown:
            raise ParameterError(
                f"{entry} needs a number for {', '.join(unknown)}; give it in parameters"
            )
        if names:
            given = [self.time if name == TIME else self.columns[name.name] for name in names]
            return real_array(lambdified(names, exact)(*given))
        value = sp.N(exact)
        if not value.is_real:
            raise ParameterError(f"{entry} has no real value at these parameters")
        return float(value)

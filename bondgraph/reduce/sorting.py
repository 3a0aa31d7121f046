"""`Reduction`: the ports of a junction structure, sorted into states, inputs and what follows from them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.called import unguarded
from bondgraph.algebra.exact import combined
from bondgraph.declare.names import energy_name
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.motion import Motion
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import JunctionStructure, Port


@dataclass(frozen=True)
class Energy:
    """A momentum or displacement that is a state: ``symbol``, and the sum of variables that it ``holds``."""

    symbol: sp.Symbol
    holds: tuple[tuple[sp.Expr, sp.Symbol], ...]


@dataclass(frozen=True)
class Reduction:
    """The ports of a junction structure, sorted into states, inputs and what follows from them.

    ``states``, ``dependent``, ``resistive``, ``imposed``: port numbers. ``inputs``: the symbols that
    imposed ports give and that values alone read, each once.
    """

    structure: JunctionStructure
    states: tuple[int, ...]
    dependent: tuple[int, ...]
    resistive: tuple[int, ...]
    imposed: tuple[int, ...]
    inputs: tuple[sp.Symbol, ...]
    #: The names in values that change in time; None where all values are constant.
    motion: Motion | None
    #: What each port gives, by its number.
    columns: Mapping[int, Reading]
    #: The momenta and displacements that are states instead of what their storages give, by port.
    energies: Mapping[int, Energy] = field(default_factory=lambda: MappingProxyType({}))

    @cached_property
    def columns_of_states(self) -> Mapping[int, int]:
        """Each state's column by its port's number."""
        return MappingProxyType({port: at for at, port in enumerate(self.states)})

    def knowing(self, more: Mapping[int, Reading]) -> "Reduction":
        """The same that also knows what these ports give."""
        return replace(self, columns=MappingProxyType({**self.columns, **more}))

    @cached_property
    def names(self) -> tuple[sp.Symbol, ...]:
        """The symbols of the states."""
        ports = self.structure.ports
        energies = self.energies
        return tuple(
            energies[port].symbol if port in energies else ports[port].given for port in self.states
        )

    def driving(self, port: int) -> Mapping[int, sp.Expr]:
        """What rules the rate of a state: a row over what ports give.

        What dependent storages give is in a momentum itself.
        """
        row = self.structure.rows[port]
        if port not in self.energies:
            return row
        return {at: entry for at, entry in row.items() if at not in self.dependent}

    def reading(self, row: Mapping[int, sp.Expr]) -> Reading:
        """A row over what the ports give, rewritten over states, inputs and their rates."""
        used = [(self.columns[port].parts, factor) for port, factor in row.items()]
        F, D, H, K = (combined((parts[at], factor) for parts, factor in used) for at in range(4))
        return Reading(F, D, H, K)


def is_storage(port: Port) -> bool:
    """Whether the port is a storage whose causality is free: linear, or with a law and its inverse."""
    return port.element.kind.stores and not _is_fixed(port)


def detects(port: Port) -> bool:
    """Whether the port only reads."""
    return port.element.kind.detects


def _is_fixed(port: Port) -> bool:
    return port.element.gives is not None


def imposes(port: Port) -> bool:
    """Whether what the port gives is an input: of fixed causality, a switch's, or a law's if integral."""
    law = port.element.law is not None and port.integral and not port.element.by_inverse
    return _is_fixed(port) or port.element.lets_go or law


def field_row(reduction: Reduction, port: int) -> list[tuple[int, sp.Expr]]:
    """The ports of a storage's field with its matrix's entries; of a one-port itself and its value."""
    element = reduction.structure.ports[port].element
    if not element.row:
        return [(port, element.constant)]
    places = reduction.structure.places
    return [(places[name], value) for name, value in element.row if value != 0]


def held(reduction: Reduction, taken: Iterable[sp.Symbol]) -> dict[sp.Symbol, sp.Expr]:
    """Momenta and displacements that are no states, over the flows and efforts of their storages.

    Named as laws name theirs, ``p_m`` and ``q_C``, less what is ``taken``; of what is a state itself none.
    """
    names, found = {name.name for name in taken}, dict[sp.Symbol, sp.Expr]()
    for at in sorted((*reduction.states, *reduction.dependent)):
        element = reduction.structure.ports[at].element
        law = element.law
        if at in reduction.energies:
            continue
        told = law.state if isinstance(law, ExpressionLaw) else None
        symbol = told or energy_name(element, names)
        if element.inverse is not None:
            found[symbol] = unguarded(element.inverse)
            continue
        ports = reduction.structure.ports
        terms = [
            (value, ports[other].element.co_energy) for other, value in field_row(reduction, at)
        ]
        found[symbol] = sp.Add(*(value * variable for value, variable in terms))
    return found

"""`JunctionStructure`: what every port receives, as a linear function of what all ports give."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import FixedRow, matrix_of
from bondgraph.nodes.elements import Bond, Element
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.tables.record import Sampled

PortRow = FixedRow
"""A signal over what the ports give."""


@dataclass(frozen=True)
class Port:
    """A one-port with its causality: it gives one variable and receives the other.

    ``inward`` is 1 if power counts into the port, -1 if it counts out (a source drawn as a tail).
    """

    element: Element
    gives: str
    inward: int

    @property
    def given(self) -> sp.Symbol:
        """The variable the port gives."""
        return self.element.effort if self.gives == "effort" else self.element.flow

    @property
    def received(self) -> sp.Symbol:
        """The variable the port receives."""
        return self.element.flow if self.gives == "effort" else self.element.effort

    @property
    def integral(self) -> bool:
        """Whether the port of a storage has integral causality."""
        kind = self.element.kind
        return kind.stores and self.gives == kind.gives

    @property
    def own_state(self) -> sp.Symbol | None:
        """The state that a law at this port owns, or that a detector makes."""
        law = self.element.law
        if self.element.by_inverse:
            return None
        if isinstance(law, ExpressionLaw) and law.state is not None and self.integral:
            return law.state
        return self.element.integral


@dataclass(frozen=True)
class JunctionStructure:
    """``w = S z``: what the ports receive from what they give, power-conserving.

    ``ports`` in declaration order; S (ports x ports) holds moduli only, and with power counted
    into every port it is skew-symmetric. ``common``: each junction's common variable as a row over z.
    ``bonds``: each bond, as declared, with its effort and its flow as rows over z.
    """

    ports: tuple[Port, ...]
    #: For each port the row of S, sparse: port number to modulus.
    rows: tuple[PortRow, ...]
    common: Mapping[Hashable, PortRow]
    bonds: Mapping[tuple[Hashable, Hashable], tuple[PortRow, PortRow]]
    elements: Mapping[Hashable, Element]
    #: Of each loop of signals ``s = W s + r`` that was solved the rows of ``1 - W``.
    loops: tuple[tuple[FixedRow, ...], ...] = ()
    #: The nodes at the ends of each bond, as the checked graph has them: with the elements the graph itself,
    #: which is derived once more where a law put later needs another causality.
    ends: tuple[Bond, ...] = ()
    #: Names in values that are inputs, though no port gives them.
    opened: tuple[sp.Symbol, ...] = ()
    #: Those that the graph was given; texts of laws that are put later may call them.
    tables: tuple[Sampled, ...] = ()

    @cached_property
    def places(self) -> Mapping[Hashable, int]:
        """Each port's number by its node's name."""
        return MappingProxyType({port.element.name: at for at, port in enumerate(self.ports)})

    @property
    def states_of_laws(self) -> tuple[sp.Symbol, ...]:
        """The states that laws own and that detectors make, in declaration order."""
        found: list[sp.Symbol] = []
        for port in self.ports:
            found += [port.own_state] if port.own_state is not None else []
        return tuple(found)

    @cached_property
    def S(self) -> sp.ImmutableSparseMatrix:
        """The matrix that ``rows`` hold, ports x ports."""
        return matrix_of(self.rows, len(self.rows))

"""`StateEquations`: a graph as ``A x' = J x + B u + E u'``, ``y = F x + D u + G u'``."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.called import unguarded
from bondgraph.algebra.expressions import TIME, callable_in_text
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element
from bondgraph.nodes.lagging import Lagging
from bondgraph.nodes.laws import ExpressionLaw, Law
from bondgraph.nodes.tasks import Machine, Task
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Reduction, held
from bondgraph.reduce.structure import Port, PortRow
from bondgraph.reduce.switch_port import SwitchPort
from bondgraph.tables.record import Sampled

LARGEST_REPR = 100
"""Equations with more states, inputs or outputs are represented by their sizes."""


@dataclass(frozen=True)
class StateEquations:
    """A bond graph's equations, exact and symbolic; the matrices are immutable and sparse.

        A x' = J x + B u + E u'
           y = F x + D u + G u'

    States are flows of inertias and efforts of compliances; A is symmetric. Power counts into open
    ports, so in a structure without resistances their columns of B are ``-F^T``. Entries may hold
    states, integrals, inputs and the time ``t`` where values of the graph do.
    """

    states: tuple[sp.Symbol, ...]
    inputs: tuple[sp.Symbol, ...]
    outputs: tuple[sp.Symbol, ...]
    A: sp.ImmutableSparseMatrix
    J: sp.ImmutableSparseMatrix
    B: sp.ImmutableSparseMatrix
    E: sp.ImmutableSparseMatrix
    F: sp.ImmutableSparseMatrix
    D: sp.ImmutableSparseMatrix
    G: sp.ImmutableSparseMatrix
    #: States that detectors make, each with the signal that is its rate.
    integrals: Mapping[sp.Symbol, sp.Symbol]
    #: Node to the law that closes its port, as declared.
    laws: Mapping[Hashable, Law]
    #: The ports that give inputs, in declaration order.
    ports: tuple[Port, ...]
    #: What ports of inputs receive, and the outputs, as ``F x + D u + H x' + K u'``.
    readings: Mapping[sp.Symbol, Reading] = field(repr=False)
    #: Every named signal of the graph as a row over its ports; see `with_readings`.
    signals: Mapping[sp.Symbol, PortRow] = field(repr=False)
    #: Those of the ports that a switch or a controlled junction holds or lets go.
    switches: tuple[SwitchPort, ...] = field(repr=False)
    #: The ports' reduction, which turns such a row into a reading.
    reduction: Reduction = field(repr=False)

    def __str__(self) -> str:
        """The whole equations: matrices, else row by row; laws and sources; and these put in.

        Of large systems names, sizes and places of entries.
        """
        from bondgraph.show.whole import whole_text

        return whole_text(self)

    def __repr__(self) -> str:
        """Names and matrices; of a large system how many there are."""
        sizes = (len(self.states), len(self.inputs), len(self.outputs))
        if max(sizes) > LARGEST_REPR:
            return "<StateEquations: {} states, {} inputs, {} outputs>".format(*sizes)
        parts = ("states", "inputs", "outputs", *"AJBEFDG")
        return f"StateEquations({', '.join(f'{part}={getattr(self, part)}' for part in parts)})"

    def _repr_latex_(self) -> str:
        from bondgraph.show.latex import notebook_latex

        return notebook_latex(self)

    @property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The names that the matrices, and all signals and bonds, need numbers for, sorted."""
        return tuple(sorted((self._names | self._read) - self._moving, key=str))

    @property
    def starts(self) -> dict[sp.Symbol, sp.Expr]:
        """The values with which runs begin, of states that have one declared."""
        reduction = self.reduction
        own = dict(zip(reduction.states, reduction.names, strict=True))
        told = {}
        for at, port in enumerate(reduction.structure.ports):
            state = own.get(at, port.own_state)
            start, law = port.element.start, port.element.law
            if start is not None and port.element.by_inverse and isinstance(law, ExpressionLaw):
                start = start if law.state is None else law.expression.xreplace({law.state: start})
            if start is not None and state is not None:
                told[state] = start
        return told

    @property
    def further_states(self) -> tuple[sp.Symbol, ...]:
        """States that no row of A has, in declaration order: those of laws, and integrals."""
        return self.reduction.structure.states_of_laws

    @property
    def kept(self) -> frozenset[sp.Symbol]:
        """The states that stay as they are but at instants: what detectors make of nothing at all."""
        rows = {
            name: self.reduction.reading(self.signals[rate])
            for name, rate in self.integrals.items()
        }
        return frozenset(name for name, row in rows.items() if not any(row.parts))

    @property
    def held(self) -> Mapping[sp.Symbol, sp.Expr]:
        """What storages hold that are no states: ``p_m``, ``q_C``, over their flows and efforts."""
        taken = {*self.signals, *self.states, *self.inputs, *self.further_states, *self.parameters}
        return MappingProxyType(held(self.reduction, taken))

    @property
    def starts_back(self) -> dict[sp.Symbol, tuple[Element, sp.Expr]]:
        """Of states that laws give at starts, the storage, and what the law's inverse makes of that again.

        It is the start, unless that lies where the law is on another branch than its inverse.
        """
        found = {}
        starts = self.starts
        for port in self.reduction.structure.ports:
            element = port.element
            given, inverse = element.co_energy, element.inverse
            turned = element.by_inverse and inverse is not None and given in starts
            if turned and given is not None and inverse is not None:
                found[given] = (element, unguarded(inverse).subs(given, starts[given]))
        return found

    @property
    def tasks(self) -> tuple[Task, ...]:
        """What sampled controllers do, and at which instants, in declaration order."""
        return tuple(one.task for one in self.elements.values() if one.task is not None)

    @property
    def delays(self) -> tuple[Lagging, ...]:
        """What is given late, in declaration order."""
        return tuple(one.late for one in self.elements.values() if one.late is not None)

    @property
    def machines(self) -> tuple[Machine, ...]:
        """The state machines, in declaration order."""
        return tuple(one.machine for one in self.elements.values() if one.machine is not None)

    @property
    def plain_switches(self) -> tuple[SwitchPort, ...]:
        """The switches but for those by which state machines take transitions."""
        return tuple(one for one in self.switches if one.switch.transition is None)

    @property
    def tables(self) -> tuple[Sampled, ...]:
        """The tables that the graph was given, which texts of laws may call."""
        return self.reduction.structure.tables

    @property
    def varying(self) -> tuple[sp.Symbol, ...]:
        """The names in the matrices that change in time, sorted; none where all values are constant."""
        return tuple(sorted(self._names & self._moving, key=str))

    @property
    def _moving(self) -> set[sp.Symbol]:
        structure = self.reduction.structure
        return {*self.states, *self.inputs, *structure.states_of_laws, TIME}

    @property
    def _names(self) -> set[sp.Symbol]:
        """Every name in the matrices and the readings."""
        used: set[sp.Symbol] = set()
        for matrix in (self.A, self.J, self.B, self.E, self.F, self.D, self.G):
            used |= matrix.free_symbols
        for reading in self.readings.values():
            for row in (reading.F, reading.D, reading.H, reading.K):
                used.update(*(entry.free_symbols for entry in row.values()))
        return used

    @property
    def _read(self) -> set[sp.Symbol]:
        """Every name in what signals and bonds are made of: a modulus beside a detector is in no matrix."""
        reduction = self.reduction
        rows = [
            *self.signals.values(),
            *(r for pair in reduction.structure.bonds.values() for r in pair),
        ]
        used = {name for row in rows for entry in row.values() for name in entry.free_symbols}
        for port in {port for row in rows for port in row}:
            parts = reduction.columns[port].parts
            used.update(*(entry.free_symbols for part in parts for entry in part.values()))
        return used

    @property
    def elements(self) -> Mapping[Hashable, Element]:
        """The graph's nodes, checked."""
        return self.reduction.structure.elements

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Reading, Reading]:
        """Effort and flow of a bond, as declared, over states and inputs and their rates.

        Their product is the power along the arrow; between a junction and an I, C or R it is the power
        into the element, whichever way the arrow was drawn.

        Raises `StructureError` if there is no such bond.
        """
        bonds = self.reduction.structure.bonds
        if (tail, head) not in bonds:
            raise StructureError(f"no bond {tail!r} -> {head!r} was declared")
        effort, flow = bonds[tail, head]
        return self.reduction.reading(effort), self.reduction.reading(flow)

    def with_tables(self, tables: Iterable[Sampled]) -> "StateEquations":
        """The same equations; texts of laws that are put later may call these tables, beside the graph's.

        Raises `TableError` for what is no table, and for two of one name.
        """
        known = (*self.tables, *tables)
        callable_in_text(known, "tables")
        structure = replace(self.reduction.structure, tables=known)
        return replace(self, reduction=replace(self.reduction, structure=structure))

    def with_readings(self, names: Iterable[sp.Symbol]) -> "StateEquations":
        """The same equations that also know these signals as readings."""
        known = {*self.states, *self.inputs, *self.readings}
        new = sorted({name for name in names if name in self.signals} - known, key=str)
        if not new:
            return self
        more = {name: self.reduction.reading(self.signals[name]) for name in new}
        return replace(self, readings=MappingProxyType({**self.readings, **more}))

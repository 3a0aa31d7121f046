"""Momenta and displacements; those that are more than a constant times a variable get names."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.exact import Row
from bondgraph.algebra.expressions import TIME
from bondgraph.declare.names import energy_name
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.sorting import Reduction, field_row
from bondgraph.show.sums import Sum


@dataclass(frozen=True)
class Momenta:
    """What storages hold: ``stored`` by port number, as a sum over the storages' variables.

    ``symbols``: the momenta and displacements that need a name: of fields, of values and ratios that
    move, and of nonlinear storages in derivative causality.
    """

    stored: Mapping[int, Sum]
    symbols: Mapping[int, sp.Symbol]


def momenta(reduction: Reduction, taken: set[sp.Symbol]) -> Momenta:
    """The momenta of all storages that the reduction sorted, named as laws name theirs."""
    moving = _moving(reduction)
    stored: dict[int, Sum] = {}
    symbols: dict[int, sp.Symbol] = {}
    names = {name.name for name in taken}
    for at in sorted((*reduction.states, *reduction.dependent)):
        port = reduction.structure.ports[at]
        if at in reduction.energies:
            symbols[at], stored[at] = reduction.energies[at].symbol, reduction.energies[at].holds
            continue
        stored[at] = _stored(reduction, at)
        if len(stored[at]) == 1 and port.element.inverse is None:
            ruled: Row = dict(reduction.structure.rows[at]) if at in reduction.dependent else {}
            used = stored[at][0][0].free_symbols.union(*(e.free_symbols for e in ruled.values()))
            if not used & moving and stored[at][0][1] == _variable(reduction, at):
                continue
        law = port.element.law
        if isinstance(law, ExpressionLaw) and law.state is not None:
            symbols[at] = law.state
            continue
        symbols[at] = energy_name(port.element, names)
    return Momenta(stored, symbols)


def _moving(reduction: Reduction) -> set[sp.Symbol]:
    """Every name that changes in time."""
    return {*reduction.names, *reduction.inputs, *reduction.structure.states_of_laws, TIME}


def _stored(reduction: Reduction, at: int) -> Sum:
    port = reduction.structure.ports[at]
    if port.element.inverse is not None and (not port.integral or port.element.by_inverse):
        return ((sp.Integer(1), port.element.inverse),)
    return tuple((value, _variable(reduction, other)) for other, value in field_row(reduction, at))


def _variable(reduction: Reduction, at: int) -> sp.Symbol:
    """The flow of an inertia, the effort of a compliance."""
    element = reduction.structure.ports[at].element
    return element.co_energy

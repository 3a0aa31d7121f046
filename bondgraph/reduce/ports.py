"""Resistances and dependent storages folded away: any row over the ports as ``F x + D u + H x' + K u'``."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import CausalityError, DependentSourceError
from bondgraph.reduce.energies import in_energies
from bondgraph.reduce.motion import Motion, moving_names, settled
from bondgraph.reduce.record import Reading
from bondgraph.reduce.resistances import resistances
from bondgraph.reduce.sorting import Reduction, detects, imposes, is_storage
from bondgraph.reduce.storages import stored_rate
from bondgraph.reduce.structure import JunctionStructure


def _check_dependent(
    structure: JunctionStructure, dependent: tuple[int, ...], later: Collection[int]
) -> None:
    """Refuse derivative causality that was asked for where a storage would wait for what waits for it."""
    for port in dependent:
        for other in structure.rows[port]:
            if other in later:
                name, cause = (structure.ports[i].element.name for i in (port, other))
                raise CausalityError(
                    f"storage {name!r} has derivative causality and follows from what {cause!r} gives, which "
                    "follows from it: these strokes have no state equations; assign causality without "
                    "derivative=, which leaves it dependent only on states and inputs"
                )


def reduce_ports(structure: JunctionStructure) -> Reduction:
    """Sort the ports, close the linear resistances, and differentiate what drives dependent storages.

    Raises `AlgebraicLoopError` for resistances whose loop determinant ``|1 - S_rr L|`` vanishes.
    """
    ports = structure.ports
    states = tuple(
        i for i, p in enumerate(ports) if is_storage(p) and p.integral and not imposes(p)
    )
    dependent = tuple(i for i, p in enumerate(ports) if is_storage(p) and not p.integral)
    resistive = tuple(
        i for i, port in enumerate(ports) if port.element.kind.resists and not imposes(port)
    )
    _check_dependent(structure, dependent, {*dependent, *resistive})
    imposed = tuple(i for i, port in enumerate(ports) if imposes(port) and not detects(port))
    inputs = tuple(dict.fromkeys([*(ports[i].given for i in imposed), *structure.opened]))
    one = sp.Integer(1)
    columns = {port: Reading({at: one}, {}, {}, {}) for at, port in enumerate(states)}
    columns |= {i: Reading({}, {inputs.index(ports[i].given): one}, {}, {}) for i in imposed}
    columns |= {i: Reading({}, {}, {}, {}) for i, port in enumerate(ports) if detects(port)}
    found = Reduction(
        structure, states, dependent, resistive, imposed, inputs, None, MappingProxyType(columns)
    )
    found = found.knowing(resistances(found))
    moving = moving_names(structure)
    if moving or any(ports[i].element.inverse is not None for i in (*states, *dependent)):
        found = _in_motion(found, moving)
    return found.knowing({port: stored_rate(found, port) for port in dependent})


def _in_motion(found: Reduction, moving: set[sp.Symbol]) -> Reduction:
    """The same with values over states, integrals, inputs and time, and the rates of these."""
    structure = found.structure
    base = {*found.names, *found.inputs, *structure.states_of_laws, TIME}
    rows = signal_rows(structure)

    def express(name: sp.Symbol) -> sp.Expr:
        return _expression(found, rows[name], name)

    structure = settled(structure, moving, base, express)
    used = moving | _within(structure)
    found = _over_energies(in_energies(replace(found, structure=structure), used & base), used)
    structure = found.structure
    found = found.knowing(resistances(found))
    one = sp.Integer(1)
    rates = {name: Reading({}, {}, {at: one}, {}) for at, name in enumerate(found.names)}
    rates |= {name: Reading({}, {}, {}, {at: one}) for at, name in enumerate(found.inputs)}
    for at, port in enumerate(structure.ports):
        own = port.own_state
        if own is not None and own in used:
            _independent(found, structure.rows[at], own)
            rates[own] = found.reading(structure.rows[at])
    return replace(found, motion=Motion(found.names, found.inputs, MappingProxyType(rates)))


def _over_energies(found: Reduction, used: set[sp.Symbol]) -> Reduction:
    """The same with values over momenta and displacements where these are states instead."""
    ports = found.structure.ports
    given = {ports[at].given: at for at in found.energies if ports[at].given in used}

    def express(name: sp.Symbol) -> sp.Expr:
        return _expression(found, {given[name]: sp.Integer(1)}, name)

    base = {*found.names, *found.inputs, *found.structure.states_of_laws, TIME}
    return replace(found, structure=settled(found.structure, given, base, express))


def _within(structure: JunctionStructure) -> set[sp.Symbol]:
    """The names in the entries of a structure."""
    return {n for row in structure.rows for entry in row.values() for n in entry.free_symbols}


def _expression(found: Reduction, row: Mapping[int, sp.Expr], name: sp.Symbol) -> sp.Expr:
    """A signal that a value uses, over states and inputs."""
    _independent(found, row, name)
    reading = found.reading(row)
    terms = [entry * found.names[j] for j, entry in reading.F.items()]
    return sp.Add(*terms, *(entry * found.inputs[j] for j, entry in reading.D.items()))


def _independent(found: Reduction, row: Mapping[int, sp.Expr], name: sp.Symbol) -> None:
    """Refuse a signal that shows what a dependent storage gives: it is ruled by accelerations."""
    for port in row:
        if port in found.dependent:
            dependent = found.structure.ports[port].element.name
            raise DependentSourceError(
                f"a value depends on {name}, which shows what the dependent storage {dependent!r} gives, "
                "and so on the rates of states; let it use a state, or an integral of a flow"
            )


def signal_rows(structure: JunctionStructure) -> dict[sp.Symbol, Mapping[int, sp.Expr]]:
    """What every name stands for, over what the ports give; the first of several."""
    rows: dict[sp.Symbol, Mapping[int, sp.Expr]] = {}
    for at, port in enumerate(structure.ports):
        rows.setdefault(port.given, {at: sp.Integer(1)})
        rows.setdefault(port.received, structure.rows[at])
    for name, row in structure.common.items():
        element = structure.elements[name]
        symbol = element.common
        if symbol is not None:
            rows.setdefault(symbol, row)
    return rows

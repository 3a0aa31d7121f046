"""Resistances and dependent storages folded away: any row over the ports as ``F x + D u + H x' + K u'``."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import networkx as nx
import sympy as sp

from bondgraph.elements import DETECTORS, STORAGES, Kind
from bondgraph.errors import AlgebraicLoopError, CausalityError, DependentSourceError
from bondgraph.exact import Row, SingularError, add_scaled, solve
from bondgraph.expressions import TIME
from bondgraph.junction import JunctionStructure, Port
from bondgraph.modulation import Motion, Reading, moving_names, settled


@dataclass(frozen=True)
class Reduction:
    """The ports of a junction structure, sorted into states, inputs and what follows from them.

    ``states``, ``dependent``, ``resistive``, ``imposed``: port numbers. ``inputs``: the symbols that
    imposed ports give, each once.
    """

    structure: JunctionStructure
    states: tuple[int, ...]
    dependent: tuple[int, ...]
    resistive: tuple[int, ...]
    imposed: tuple[int, ...]
    inputs: tuple[sp.Symbol, ...]
    #: The names in values that change in time; None where all values are constant.
    motion: Motion | None
    _columns: Mapping[int, Reading]

    @cached_property
    def columns_of_states(self) -> Mapping[int, int]:
        """Each state's column by its port's number."""
        return {port: at for at, port in enumerate(self.states)}

    @cached_property
    def names(self) -> tuple[sp.Symbol, ...]:
        """The symbols of the states."""
        return tuple(self.structure.ports[port].given for port in self.states)

    def reading(self, row: Mapping[int, sp.Expr]) -> Reading:
        """A row over what the ports give, rewritten over states, inputs and their rates."""
        result = Reading.zero()
        for port, factor in row.items():
            result.add(self._columns[port], factor)
        return result


def reduce_ports(structure: JunctionStructure) -> Reduction:
    """Sort the ports, close the linear resistances, and differentiate what drives dependent storages.

    Raises `AlgebraicLoopError` for resistances whose loop determinant ``|1 - S_rr L|`` vanishes.
    """
    ports = structure.ports
    states = tuple(
        i for i, p in enumerate(ports) if is_storage(p) and p.integral and not _imposes(p)
    )
    dependent = tuple(i for i, p in enumerate(ports) if is_storage(p) and not p.integral)
    resistive = tuple(
        i for i, port in enumerate(ports) if port.element.kind is Kind.R and not _fixed(port)
    )
    imposed = tuple(i for i, port in enumerate(ports) if _imposes(port) and not _detects(port))
    inputs = tuple(dict.fromkeys(ports[i].given for i in imposed))
    one = sp.Integer(1)
    columns = {port: Reading({at: one}, {}, {}, {}) for at, port in enumerate(states)}
    columns |= {i: Reading({}, {inputs.index(ports[i].given): one}, {}, {}) for i in imposed}
    columns |= {i: Reading.zero() for i, port in enumerate(ports) if _detects(port)}
    found = Reduction(structure, states, dependent, resistive, imposed, inputs, None, columns)
    columns |= _resistances(found)
    moving = moving_names(structure)
    if moving or any(ports[i].element.inverse is not None for i in dependent):
        found = _in_motion(found, moving, columns)
    columns |= {port: stored_rate(found, port) for port in dependent}
    return found


def _in_motion(found: Reduction, moving: set[sp.Symbol], columns: dict[int, Reading]) -> Reduction:
    """The same with values over states, integrals, inputs and time, and the rates of these."""
    structure = found.structure
    base = {*found.names, *found.inputs, *structure.states_of_laws, TIME}
    rows = signal_rows(structure)

    def express(name: sp.Symbol) -> sp.Expr:
        return _expression(found, rows[name], name)

    structure = settled(structure, moving, base, express)
    found = replace(found, structure=structure)
    columns |= _resistances(found)
    one = sp.Integer(1)
    rates = {name: Reading({}, {}, {at: one}, {}) for at, name in enumerate(found.names)}
    rates |= {name: Reading({}, {}, {}, {at: one}) for at, name in enumerate(found.inputs)}
    used = moving | _within(structure)
    for at, port in enumerate(structure.ports):
        own = port.own_state
        if own is not None and own in used:
            _independent(found, structure.rows[at], own)
            rates[own] = found.reading(structure.rows[at])
    return replace(found, motion=Motion(found.names, found.inputs, MappingProxyType(rates)))


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
        symbol = element.effort if element.kind is Kind.ZERO else element.flow
        if symbol is not None:
            rows.setdefault(symbol, row)
    return rows


def is_storage(port: Port) -> bool:
    """Whether the port is a storage whose causality is free: linear, or with a law and its inverse."""
    return port.element.kind in STORAGES and not _fixed(port)


def _detects(port: Port) -> bool:
    return port.element.kind in DETECTORS


def _fixed(port: Port) -> bool:
    return port.element.gives is not None


def _imposes(port: Port) -> bool:
    """Whether what the port gives is an input: of fixed causality, or a law's in integral causality."""
    return _fixed(port) or (port.element.law is not None and port.integral)


def stored_rate(reduction: Reduction, port: int) -> Reading:
    """The rate of a linear storage's momentum or displacement, ``(sum_j M_ij v_j)'``.

    v_j is the state of a port with integral causality; of a dependent one it is what states and inputs
    make it. The sum has more than one term in fields alone.
    """
    result = Reading.zero()
    element = reduction.structure.ports[port].element
    if element.inverse is not None and reduction.motion is not None:
        _add_inverse_rate(reduction, port, result)
        return result
    for other, value in _field_row(reduction, port):
        if other in reduction.columns_of_states:
            ruled = Reading({reduction.columns_of_states[other]: sp.Integer(1)}, {}, {}, {})
        else:
            ruled = _ruled(reduction, other)
        add_scaled(result.H, ruled.F, value)
        add_scaled(result.K, ruled.D, value)
    if reduction.motion is not None:
        for symbols, rates in ((reduction.names, result.H), (reduction.inputs, result.K)):
            for j, entry in list(rates.items()):
                reduction.motion.add_rate(result, entry, symbols[j])
    return result


def _add_inverse_rate(reduction: Reduction, port: int, result: Reading) -> None:
    """The rate of a nonlinear storage's state as a function of what it receives."""
    one, ruled = reduction.structure.ports[port], _ruled(reduction, port)
    terms = [entry * reduction.names[j] for j, entry in ruled.F.items()]
    terms += [entry * reduction.inputs[j] for j, entry in ruled.D.items()]
    inverse, motion = one.element.inverse, reduction.motion
    if inverse is None or motion is None:
        raise CausalityError(f"the law at {one.element.name!r} has no inverse")
    motion.add_total_rate(
        result, inverse.xreplace({one.received: sp.Add(*terms)}), one.element.name
    )


def _field_row(reduction: Reduction, port: int) -> list[tuple[int, sp.Expr]]:
    """The ports of a storage's field with its matrix's entries; of a one-port itself and its value."""
    element = reduction.structure.ports[port].element
    if not element.row:
        return [(port, element.constant)]
    places = reduction.structure.places
    return [(places[name], value) for name, value in element.row if value != 0]


def _ruled(reduction: Reduction, port: int) -> Reading:
    """What a dependent storage receives, ruled by states and inputs alone."""
    structure = reduction.structure
    row = structure.rows[port]
    free = {*reduction.dependent, *reduction.resistive}
    strangers = [i for i in row if i in free]
    if strangers:
        names = [structure.ports[i].element.name for i in (port, *strangers)]
        raise CausalityError(
            f"storages and resistances {names} determine each other although one of them could "
            "have integral causality; please report this graph"
        )
    return reduction.reading(row)


def _resistances(reduction: Reduction) -> dict[int, Reading]:
    """What each linear resistance gives, ``z_r = L (1 - S_rr L)^-1 (S_rx x + S_ru u)``, loop by loop."""
    structure, resistive = reduction.structure, set(reduction.resistive)
    loops: nx.Graph[int] = nx.Graph()
    loops.add_nodes_from(reduction.resistive)
    for port in reduction.resistive:
        loops.add_edges_from((port, i) for i in structure.rows[port] if i in resistive)
        loops.add_edges_from((port, i) for i, _ in _field_row(reduction, port))
    result: dict[int, Reading] = {}
    for members in nx.connected_components(loops):
        group = sorted(members)
        for port, given in zip(group, _closed(reduction, group), strict=True):
            result[port] = given
    return result


def _closed(reduction: Reduction, group: Sequence[int]) -> list[Reading]:
    """What the resistances of one loop give."""
    structure = reduction.structure
    place = {port: at for at, port in enumerate(group)}
    laws = _given_by_received(reduction, group, place)
    outside = [
        reduction.reading({i: s for i, s in structure.rows[port].items() if i not in place})
        for port in group
    ]
    inside: list[Row] = []
    for at, port in enumerate(group):
        line: Row = {at: sp.Integer(1)}
        for i, entry in structure.rows[port].items():
            if i in place:
                add_scaled(line, laws[place[i]], -entry)
        inside.append(line)
    if all(len(line) == 1 for line in inside):
        received = [(row.F, row.D) for row in outside]
    else:
        received = _solved(structure, group, inside, outside, len(reduction.states))
    result = []
    for law in laws:
        given = Reading.zero()
        for at, factor in law.items():
            F, D = received[at]
            add_scaled(given.F, F, factor)
            add_scaled(given.D, D, factor)
        result.append(given)
    return result


def _given_by_received(
    reduction: Reduction, group: Sequence[int], place: Mapping[int, int]
) -> list[Row]:
    """Rows L with ``z = L w``: R or 1/R of a one-port; a field's matrix, partly inverted, of its ports."""
    rows: dict[int, Row] = {}
    for port in group:
        element = reduction.structure.ports[port].element
        if not element.row:
            rows[port] = {place[port]: _conductance(reduction.structure.ports[port])}
        elif port not in rows:
            rows |= _field_rows(reduction, port, place)
    return [rows[port] for port in group]


def _field_rows(reduction: Reduction, port: int, place: Mapping[int, int]) -> dict[int, Row]:
    """``e = R f`` of a field solved for what its ports give."""
    structure = reduction.structure
    element = structure.ports[port].element
    ports = [structure.places[name] for name, _ in element.row]
    flows = {i for i in ports if structure.ports[i].gives == "flow"}
    matrix: list[Row] = []
    right: list[Row] = []
    for at, i in enumerate(ports):
        entries = dict(
            zip(ports, (value for _, value in structure.ports[i].element.row), strict=True)
        )
        line: Row = {} if i in flows else {at: sp.Integer(1)}
        known: Row = {place[i]: -sp.Integer(1)} if i in flows else {}
        for k, j in enumerate(ports):
            if j in flows:
                add_scaled(line, {k: sp.Integer(1)}, -entries[j])
            else:
                add_scaled(known, {place[j]: sp.Integer(1)}, entries[j])
        matrix.append({k: e for k, e in line.items() if e != 0})
        right.append({k: e for k, e in known.items() if e != 0})
    try:
        solved = solve(matrix, right)
    except SingularError:
        raise AlgebraicLoopError(
            f"the field {element.owner!r} cannot give flows at "
            f"{', '.join(repr(structure.ports[i].element.name) for i in sorted(flows))}: that part of its "
            "matrix has no inverse; change a value, or put a storage between"
        ) from None
    return dict(zip(ports, solved, strict=True))


def _solved(
    structure: JunctionStructure,
    group: Sequence[int],
    inside: list[Row],
    outside: list[Reading],
    states: int,
) -> list[tuple[Row, Row]]:
    right = [row.F | {states + j: entry for j, entry in row.D.items()} for row in outside]
    try:
        rows = solve(inside, right)
    except SingularError:
        names = ", ".join(repr(structure.ports[port].element.name) for port in group)
        raise AlgebraicLoopError(
            f"the resistances {names} form a loop whose determinant vanishes; "
            "change a value, or put a storage between them"
        ) from None
    return [
        (
            {j: entry for j, entry in row.items() if j < states},
            {j - states: entry for j, entry in row.items() if j >= states},
        )
        for row in rows
    ]


def _conductance(port: Port) -> sp.Expr:
    """What a linear resistance gives per unit of what it receives: R, or 1/R where it gives flow."""
    return port.element.constant if port.gives == "effort" else 1 / port.element.constant

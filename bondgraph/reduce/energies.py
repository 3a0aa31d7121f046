"""Momenta and displacements as states: of storages whose values read inputs, as a filling tank's mass.

What such a storage gives steps with the input; what it holds does not. With dependent storages d behind the
states i by constant ratios, ``pi_i = M_i x_i - sum_d S_id M_d w_d`` is the momentum of all that moves with i,
and its rate is what the other ports bring: no rate of an input is asked for.
"""

from collections.abc import Iterator
from dataclasses import replace
from types import MappingProxyType

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, add_scaled, solve
from bondgraph.declare.names import energy_name, named_by
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Energy, Reduction


def in_energies(found: Reduction, moving: set[sp.Symbol]) -> Reduction:
    """The same with energy variables as states of storages whose values read inputs.

    ``moving``: the names that change in time. Fields, nonlinear storages, values that read
    storages' variables and those behind ratios that change keep their co-energy variables.
    """
    ports = found.structure.ports
    taken = {name.name for port in ports for name in named_by(port.element)}
    energies: dict[int, Energy] = {}
    columns: dict[int, Reading] = {}
    for states, dependent in _groups(found):
        if not _reads_inputs(found, (*states, *dependent)):
            continue
        held = _held(found, states, dependent, moving)
        if held is None:
            continue
        places = [found.columns_of_states[port] for port in states]
        try:
            solved = solve([row for row, _ in held], [{at: sp.Integer(1)} for at in places])
        except SingularError:
            continue
        for k, (port, inverse) in enumerate(zip(states, solved, strict=True)):
            symbol = energy_name(ports[port].element, taken)
            energies[port] = Energy(symbol, _sum(found, states, *held[k]))
            columns[port] = _reading(inverse, places, [known for _, known in held])
    return replace(found, energies=MappingProxyType(energies)).knowing(columns)


def _groups(found: Reduction) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """States that dependent storages join, each with those, in declaration order."""
    joined: nx.Graph[int] = nx.Graph()
    joined.add_nodes_from(found.states)
    rows = found.structure.rows
    for port in found.dependent:
        joined.add_edges_from(
            (port, state) for state in found.states if state in rows[port] or port in rows[state]
        )
    for part in sorted(map(sorted, nx.connected_components(joined))):
        yield (
            tuple(at for at in part if at in found.columns_of_states),
            tuple(at for at in part if at in found.dependent),
        )


def _reads_inputs(found: Reduction, group: tuple[int, ...]) -> bool:
    values = (found.structure.ports[at].element.value for at in group)
    inputs = set(found.inputs)
    return any(value is not None and value.free_symbols & inputs for value in values)


def _held(
    found: Reduction, states: tuple[int, ...], dependent: tuple[int, ...], moving: set[sp.Symbol]
) -> list[tuple[Row, Row]] | None:
    """Each state's momentum, a row over the group's states less one over inputs; None if it is no sum."""
    structure = found.structure
    elements = [structure.ports[at].element for at in (*states, *dependent)]
    for one in elements:
        if one.row or one.law is not None or one.constant.free_symbols & set(found.names):
            return None
    place = {port: k for k, port in enumerate(states)}
    result: list[tuple[Row, Row]] = []
    for k, port in enumerate(states):
        own: Row = {k: structure.ports[port].element.constant}
        known: Row = {}
        for d in dependent:
            behind = structure.rows[port].get(d, sp.Integer(0))
            ratios = [behind, *structure.rows[d].values()]
            if any(entry.free_symbols & moving for entry in ratios):
                return None
            weight = behind * structure.ports[d].element.constant
            ruled = found.reading(structure.rows[d])
            by_states = {place[at]: e for at, e in structure.rows[d].items() if at in place}
            add_scaled(own, by_states, -weight)
            add_scaled(known, ruled.D, weight)
        result.append((own, known))
    return result


def _sum(
    found: Reduction, states: tuple[int, ...], own: Row, known: Row
) -> tuple[tuple[sp.Expr, sp.Symbol], ...]:
    """A momentum as a sum over what storages give and inputs."""
    given = [found.structure.ports[port].given for port in states]
    terms = [(entry, given[k]) for k, entry in sorted(own.items())]
    return (*terms, *((-entry, found.inputs[j]) for j, entry in sorted(known.items())))


def _reading(inverse: Row, places: list[int], known: list[Row]) -> Reading:
    """What a storage gives, ``x = A^-1 (pi + c u)``."""
    by_inputs: Row = {}
    for k, place in enumerate(places):
        if place in inverse:
            add_scaled(by_inputs, known[k], inverse[place])
    return Reading(inverse, by_inputs, {}, {})

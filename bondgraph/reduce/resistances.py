"""Linear resistances and fields of them, solved loop by loop for what they give."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, SingularError, add_scaled, fixed, solve
from bondgraph.causality.vanishing import generic, told
from bondgraph.errors import AlgebraicLoopError
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.structure import JunctionStructure, Port


def resistances(reduction: Reduction) -> dict[int, Reading]:
    """What each linear resistance gives, ``z_r = L (1 - S_rr L)^-1 (S_rx x + S_ru u)``, loop by loop."""
    result: dict[int, Reading] = {}
    for group in _groups(reduction):
        for port, given in zip(group, _closed(reduction, group), strict=True):
            result[port] = given
    return result


@dataclass(frozen=True)
class ResistiveGroup:
    """Ports of resistances that hang together: ``z = L w``, and ``1 - S_rr L``, by places in the group."""

    ports: tuple[int, ...]
    laws: tuple[FixedRow, ...]
    inside: tuple[FixedRow, ...]

    @property
    def is_loop(self) -> bool:
        """Whether what they give comes back to them."""
        return any(len(row) > 1 or row.get(at) != 1 for at, row in enumerate(self.inside))


def resistive_loops(reduction: Reduction) -> Iterator[tuple[list[int], list[FixedRow]]]:
    """Ports of resistances that hang together, and ``1 - S_rr L`` of each such group."""
    for group in resistive_groups(reduction):
        yield [*group.ports], [*group.inside]


def resistive_groups(reduction: Reduction) -> Iterator[ResistiveGroup]:
    """The groups in which `resistances` solves."""
    for group in _groups(reduction):
        place = {port: at for at, port in enumerate(group)}
        laws = _given_by_received(reduction, group, place)
        inside = _inside(reduction.structure, group, place, laws)
        yield ResistiveGroup(tuple(group), tuple(map(fixed, laws)), tuple(map(fixed, inside)))


def _groups(reduction: Reduction) -> Iterator[list[int]]:
    """The ports of resistances, those together that see one another or belong to one field."""
    structure, resistive = reduction.structure, set(reduction.resistive)
    loops: nx.Graph[int] = nx.Graph()
    loops.add_nodes_from(reduction.resistive)
    for port in reduction.resistive:
        loops.add_edges_from((port, i) for i in structure.rows[port] if i in resistive)
        # All ports of a field belong together, whatever entries of its matrix are zero.
        row = structure.ports[port].element.row
        loops.add_edges_from((port, structure.places[name]) for name, _ in row)
    yield from (sorted(members) for members in nx.connected_components(loops))


def _closed(reduction: Reduction, group: Sequence[int]) -> list[Reading]:
    """What the resistances of one loop give."""
    structure = reduction.structure
    place = {port: at for at, port in enumerate(group)}
    laws = _given_by_received(reduction, group, place)
    outside = [
        reduction.reading({i: s for i, s in structure.rows[port].items() if i not in place})
        for port in group
    ]
    inside = _inside(structure, group, place, laws)
    if all(len(line) == 1 for line in inside):
        received = [(row.F, row.D) for row in outside]
    else:
        received = _solved(structure, group, inside, outside, len(reduction.states))
    result = []
    for law in laws:
        given = ReadingSum()
        for at, factor in law.items():
            F, D = received[at]
            add_scaled(given.F, F, factor)
            add_scaled(given.D, D, factor)
        result.append(given.whole())
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
) -> list[tuple[FixedRow, FixedRow]]:
    right = [{**row.F} | {states + j: entry for j, entry in row.D.items()} for row in outside]
    try:
        rows = solve(inside, right)
    except SingularError:
        names = ", ".join(repr(structure.ports[port].element.name) for port in group)
        raise AlgebraicLoopError(
            f"the resistances {names} form a loop whose determinant vanishes{_told(structure, group)}; "
            "change a value, or put a storage between them"
        ) from None
    return [
        (
            {j: entry for j, entry in row.items() if j < states},
            {j - states: entry for j, entry in row.items() if j >= states},
        )
        for row in rows
    ]


def _told(structure: JunctionStructure, group: Sequence[int]) -> str:
    """The determinant that vanishes, over resistances under names of their own."""
    made, values = generic(
        {structure.ports[i].element.name: structure.ports[i].element for i in group}
    )
    if len(made) < len(group):
        return ""
    place = {port: at for at, port in enumerate(group)}
    laws = [
        {
            at: _conductance(
                replace(structure.ports[i], element=made[structure.ports[i].element.name])
            )
        }
        for at, i in enumerate(group)
    ]
    text = told(_inside(structure, group, place, laws), values)
    return "" if text is None else f": {text}"


def _inside(
    structure: JunctionStructure, group: Sequence[int], place: Mapping[int, int], laws: list[Row]
) -> list[Row]:
    """``1 - S_rr L`` of a loop of resistances, as sparse rows."""
    inside: list[Row] = []
    for at, port in enumerate(group):
        line: Row = {at: sp.Integer(1)}
        for i, entry in structure.rows[port].items():
            if i in place:
                add_scaled(line, laws[place[i]], -entry)
        inside.append(line)
    return inside


def _conductance(port: Port) -> sp.Expr:
    """What a linear resistance gives per unit of what it receives: R, or 1/R where it gives flow."""
    return port.element.constant if port.gives == "effort" else 1 / port.element.constant

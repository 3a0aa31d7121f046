"""What is held at a point that moves: how its rows turn as states and inputs leave that point."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.expressions import TIME
from bondgraph.analyse.closed_rows import ClosedRows
from bondgraph.analyse.modes import HeldRows, held_rows
from bondgraph.analyse.unknowns import Moment, Unknowns, still
from bondgraph.nodes.laws import Law, slides
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.readings import depends_on_signals
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port


@dataclass(frozen=True)
class MovingHold:
    """``system``: rows with a column for the time, along the way that leads through the point.

    ``held``: what is held, at the point; ``by_time``: by how much its rows change with the time alone;
    ``bends``: how fast their coefficients change. From ``F x + D v = 0`` follows
    ``F x' + D v' + F' x + D' v = 0``.
    """

    system: ClosedRows
    held: HeldRows
    by_time: tuple[sp.Expr, ...]
    bends: tuple[Reading, ...]


def moving_hold(
    system: ClosedRows, ports: Sequence[Port], laws: Mapping[Hashable, Law], unknowns: Unknowns
) -> MovingHold:
    """Rows of what is held along the way on which everything moves at its rate at the point.

    A row's change takes what laws have beyond their slopes, and how values of the graph change.
    """
    moment, equations = Moment("moment"), system.equations
    seen = _seen(system, ports, laws)
    moving = {*system.signals, *system.states, *system.columns}
    point = {
        name: value + moment * unknowns.rate(name) if name in moving else value
        for name, value in system.point.items()
    }
    point[TIME] = system.point.get(TIME, unknowns.value(TIME)) + moment
    along = ClosedRows(
        equations, system.closed, (*system.columns[len(equations.inputs) :], TIME), point, unknowns,
        system.silent, ports, seen, moment,
    )  # fmt: skip
    found = held_rows(along, ports, laws)
    late = len(along.columns) - 1
    rows = [replace(row, D={j: e for j, e in row.D.items() if j != late}) for row in found.bound]
    bound = tuple(Reading(*map(_still, row.parts)) for row in rows)
    return MovingHold(
        along, HeldRows(bound, found.tied, found.direct),
        tuple(still(row.D.get(late, sp.Integer(0))) for row in found.bound),
        tuple(Reading(*(_slope(part, moment) for part in row.parts)) for row in rows),
    )  # fmt: skip


def turns(system: ClosedRows, ports: Sequence[Port], laws: Mapping[Hashable, Law]) -> bool:
    """Whether the rows of what is held can change with the point."""
    moving = {*system.equations.varying}
    for port in ports:
        row = system.equations.readings[port.received]
        if any(e.free_symbols & moving for part in row.parts for e in part.values()):
            return True
    levels = [law for p in ports if slides(law := laws.get(p.element.name), p.gives)]
    read = {name for level in levels for name in level.free_symbols}
    return bool(_seen(system, ports, laws) or read & system.signals)


def _seen(
    system: ClosedRows, ports: Sequence[Port], laws: Mapping[Hashable, Law]
) -> tuple[Hashable, ...]:
    """The nodes of the laws that what is held depends on at once, by way of others too."""
    equations = system.equations
    owner = {p.given: p.element.name for p in equations.ports if p.element.name in system.closed}
    found: dict[Hashable, None] = {}
    pending = [port.received for port in ports]
    for port in ports:
        law = laws.get(port.element.name)
        pending += sorted(law.free_symbols, key=str) if slides(law, port.gives) else []
    looked = set[sp.Symbol]()
    while pending:
        name = pending.pop()
        if name in looked:
            continue
        looked.add(name)
        if name in owner and depends_on_signals(system.closed[owner[name]], system.signals):
            found.setdefault(owner[name])
            pending += sorted(system.closed[owner[name]].free_symbols, key=str)
        row = equations.readings.get(name)
        if row is not None:
            pending += [equations.inputs[j] for j in row.D]
            used = set().union(*(e.free_symbols for part in row.parts for e in part.values()))
            pending += sorted(used & {*equations.varying}, key=str)
    return tuple(found)


def _slope(row: FixedRow, moment: Moment) -> dict[int, sp.Expr]:
    turning = {j: entry for j, entry in row.items() if moment in entry.free_symbols}
    found = {j: still(slope_of(entry, moment)) for j, entry in turning.items()}
    return {j: entry for j, entry in found.items() if entry != 0}


def _still(row: FixedRow) -> dict[int, sp.Expr]:
    return {j: value for j, entry in row.items() if (value := still(entry)) != 0}

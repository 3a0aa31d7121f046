"""What impulses of switches move: the storages that they bind, and what these hold.

An impulse exchanges momenta (of capacitors charges) and leaves their sum. Of a law that is turned round A has
the slope alone, which moves with the state; so of such storages `momenta` tells what they hold.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.residues import residues
from bondgraph.errors import StructureError
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.storages import stored, stored_behind
from bondgraph.reduce.structure import JunctionStructure, PortRow
from bondgraph.reduce.switch_port import SwitchPort

TOGETHER = 2
"""Of so many switches, and of all, it is asked what they bind that hold together."""


@dataclass(frozen=True)
class Momenta:
    """What impulses exchange, over states and inputs: ``A`` holds the slopes of what ``states`` tells.

    ``states``: for each state the momentum of all that moves with it, 0 where no impulse moves it or where
    it is linear in states that move with it. ``readings``: of signals that show rates what these are of.
    """

    states: tuple[sp.Expr, ...]
    readings: Mapping[sp.Symbol, sp.Expr]


def bound_by_switches(reduction: Reduction) -> set[int]:
    """The ports of nonlinear storages, with states of their own, that switches bind as they hold.

    What laws of resistances beside them give follows at once, so that these bind nothing. Storages whose
    states a switch sets keep them.
    """
    structure = reduction.structure
    ports = [structure.ports[at] for at in reduction.imposed]
    place = {port.given: reduction.inputs.index(port.given) for port in ports}
    stores = {
        place[structure.ports[at].given]: at for at in reduction.imposed if _is_own(structure, at)
    }
    switches = [at for at in reduction.imposed if structure.ports[at].element.switch is not None]
    if not stores or not switches:
        return set()
    rows = [
        (place[structure.ports[at].given], reduction.reading(structure.rows[at])) for at in switches
    ]
    found, answers = set[int](), _answering(reduction)
    for chosen in _sets(rows):
        beside = [{j: e for j, e in one.D.items() if j in stores} for _, one in chosen]
        found |= _bound(chosen, answers, beside)
    return {stores[j] for j in found}


def check_impulses(
    switches: Sequence[SwitchPort], reduction: Reduction, A: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading],
) -> None:  # fmt: skip
    """Refuse a switch whose impulse would go through ratios that move with what it moves.

    What it leaves would depend on the way that these go. Behind a resistance there is no impulse.
    """
    for chosen, moved in _moved(switches, reduction, A, readings):
        names = _jumping(reduction, chosen, moved)
        if not _bends(A, moved, names):
            continue
        rows = [reduction.structure.rows[reduction.states[i]] for i in moved]
        if any(_turns(reduction, row, names) for row in rows):
            listed = ", ".join(sorted(str(reduction.names[i]) for i in moved))
            raise StructureError(
                f"the switch {chosen[0].name!r} would give an impulse to {listed} by way of a ratio that "
                "moves with them: what it leaves depends on the way that the ratio goes. Put a resistance "
                "beside the switch, or let the ratio read what does not jump"
            )


def momenta(
    switches: Sequence[SwitchPort], reduction: Reduction, A: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading], shown: Mapping[sp.Symbol, tuple[Reading, PortRow]],
) -> Momenta | None:  # fmt: skip
    """What impulses exchange where the slopes in A move with the states that jump; None where they stay.

    ``shown``: signals as readings, and as rows over the ports; those that show rates are told.
    """
    bent = False
    for chosen, moved in _moved(switches, reduction, A, readings):
        bent |= _bends(A, moved, _jumping(reduction, chosen, moved))
    if not bent:
        return None
    every = _together(A, {j for one in switches for j in readings[one.port.received].F})
    names = _jumping(reduction, switches, every)
    states = [
        stored(reduction, port) - stored_behind(reduction, reduction.driving(port))
        if at in every else sp.Integer(0)
        for at, port in enumerate(reduction.states)
    ]  # fmt: skip
    behind = {
        name: stored_behind(reduction, row)
        for name, (one, row) in shown.items()
        if every & set(one.H) and not _turns(reduction, row, names)
    }
    return Momenta(tuple(states), MappingProxyType(behind))


def _moved(
    switches: Sequence[SwitchPort], reduction: Reduction, A: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading],
) -> Iterator[tuple[Sequence[SwitchPort], set[int]]]:  # fmt: skip
    """Switches that may hold together, and the states that their impulses move, if there are any."""
    answers = _answering(reduction)
    named = {reduction.inputs.index(one.port.given): one for one in switches}
    for chosen in _sets([(j, readings[one.port.received]) for j, one in named.items()]):
        bound = _bound(chosen, answers, [one.F for _, one in chosen])
        if bound:
            yield [named[j] for j, _ in chosen], _together(A, bound)


def _answering(reduction: Reduction) -> list[int]:
    """The inputs that laws of resistances give: they answer to what ports give at once."""
    ports = [reduction.structure.ports[at] for at in reduction.imposed]
    return [reduction.inputs.index(port.given) for port in ports if port.element.kind.resists]


def _jumping(reduction: Reduction, chosen: Iterable[SwitchPort], moved: set[int]) -> set[sp.Symbol]:
    """The names of what jumps: these states, and what integrates impulses of ports or what shows these."""
    found, given = {reduction.names[i] for i in moved}, {one.port.given for one in chosen}
    columns = {j for j, name in enumerate(reduction.inputs) if name in given}
    for port, row in zip(reduction.structure.ports, reduction.structure.rows, strict=True):
        if port.own_state is not None:
            rate = reduction.reading(row)
            found |= {port.own_state} if columns & set(rate.D) or moved & set(rate.H) else set()
    return found


def _bends(A: Sequence[FixedRow], moved: Iterable[int], names: set[sp.Symbol]) -> bool:
    """Whether slopes of these states move with these names."""
    return any(entry.free_symbols & names for i in moved for entry in A[i].values())


def _turns(reduction: Reduction, row: FixedRow, names: set[sp.Symbol]) -> bool:
    """Whether dependent storages are behind ratios of a row that move with these names."""
    return any(row[d].free_symbols & names for d in reduction.dependent if d in row)


def _is_own(structure: JunctionStructure, at: int) -> bool:
    """Whether a port is a nonlinear storage's whose own momentum or displacement no switch sets."""
    port = structure.ports[at]
    switches = (one.switch for one in structure.elements.values() if one.switch is not None)
    state = port.own_state
    return port.integral and state is not None and not any(
        one.state == state for switch in switches for one in switch.resets
    )  # fmt: skip


def _sets(rows: Sequence[tuple[int, Reading]]) -> Iterator[Sequence[tuple[int, Reading]]]:
    """Those that may hold together, as they are looked at: few at a time, and all."""
    for count in range(1, min(TOGETHER, len(rows)) + 1):
        yield from combinations(rows, count)
    if len(rows) > TOGETHER:
        yield rows


def _bound(
    chosen: Sequence[tuple[int, Reading]], answers: Iterable[int], beside: Sequence[FixedRow]
) -> set[int]:
    """The columns of what rows have beside what answers at once that combinations of them bind."""
    value = residues()
    columns = [-1 - j for j in dict.fromkeys([*answers, *(j for j, _ in chosen)])]
    made = []
    for (_, reading), more in zip(chosen, beside, strict=True):
        row = {-1 - j: value(entry) for j, entry in reading.D.items() if -1 - j in columns}
        row |= {j: value(entry) for j, entry in more.items()}
        made.append({j: entry for j, entry in row.items() if entry})
    rows = ResidueRows(made)
    for column in columns:
        rows.pivot(column, jordan=False)
    return {j for row in rows.rows for j in row}


def _together(A: Sequence[FixedRow], first: Iterable[int]) -> set[int]:
    """The states that move at once with these."""
    found, waiting = set[int](), list(first)
    columns: dict[int, set[int]] = {}
    for i, row in enumerate(A):
        for j in row:
            columns.setdefault(j, set()).add(i)
    while waiting:
        at = waiting.pop()
        if at not in found:
            found.add(at)
            waiting += [*A[at], *columns.get(at, ())]
    return found

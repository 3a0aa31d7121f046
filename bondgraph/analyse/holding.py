"""Ports that stick: which are meant, and what they receive as rows that are solved for what holds them."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, rows_of, solve
from bondgraph.algebra.residues import is_zero
from bondgraph.analyse.constrained import echelon
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port


def stuck_ports(
    equations: StateEquations, stuck: Iterable[Hashable],
    switches: Mapping[Hashable, Port] = MappingProxyType({}),
) -> list[Port]:  # fmt: skip
    """The open ports of these nodes, or the switches allowed; `StructureError` for any that is neither."""
    if isinstance(stuck, str) or not isinstance(stuck, Iterable):
        raise StructureError(f"stuck must be a list of nodes, not {stuck!r}")
    resisting = {p.element.name: p for p in equations.ports if p.element.kind.resists}
    by_name = {**resisting, **switches}
    switched = {one.name for one in equations.plain_switches} - switches.keys()
    ports: list[Port] = []
    for name in stuck:
        if name in switched:
            raise StructureError(f"{name!r} is a switch: tell whether it is on or off in mode")
        port = by_name.get(name)
        if port is None:
            known = list(map(str, by_name))
            raise StructureError(
                f"no open port is called {name!r} that could stick; there are {', '.join(known) or 'none'}"
            )
        if port in ports:
            raise StructureError(f"stuck names {name!r} twice")
        ports.append(port)
    return ports


def split(
    rows: Sequence[Reading], held: Sequence[int]
) -> tuple[list[Reading], list[Reading], tuple[int, ...]]:
    """What sticking ports receive, split into rows that fix efforts at once and rows that bind states.

    The first are those whose D over the held efforts is independent, and which these are is told last; the
    others are the combinations in which these efforts cancel.
    """
    D = sp.Matrix(len(rows), len(held), lambda i, j: rows[i].D.get(held[j], 0))
    _, pivots = echelon(D.T)
    direct = [rows[i] for i in pivots]
    bound = []
    for weights in D.T.nullspace(simplify=sp.cancel, iszerofunc=is_zero):
        total = ReadingSum()
        for row, weight in zip(rows, weights, strict=True):
            total.add(row, weight)
        bound.append(total.whole())
    return direct, bound, pivots


def balances_of(equations: StateEquations) -> tuple[list[Row], list[Reading]]:
    """A by rows, and ``J x + B u + E u'`` by rows."""
    parts = (rows_of(equations.J), rows_of(equations.B), rows_of(equations.E))
    balances = [Reading(F, D, {}, K) for F, D, K in zip(*parts, strict=True)]
    return rows_of(equations.A), balances


def listed(ports: Sequence[Port]) -> str:
    """The nodes of ports, for people."""
    return ", ".join(repr(port.element.name) for port in ports)


def solve_for(
    rows: Sequence[Reading], held: Sequence[int], states: int, ports: Sequence[Port]
) -> list[Row]:
    """``F x + D u = 0`` solved for the held inputs, over the columns of x and then u.

    Raises `StructureError` where they are not unique, `DependentSourceError` if rates come in.
    """
    if any(row.H or row.K for row in rows):
        raise DependentSourceError(
            f"what holds {listed(ports)} depends on the rate of what drives a dependent storage; "
            "put a storage or a resistance between, or simulate it"
        )
    inside = [
        {held.index(column): entry for column, entry in row.D.items() if column in held}
        for row in rows
    ]
    right: list[Row] = []
    for row in rows:
        line = {j: -entry for j, entry in row.F.items()}
        line |= {states + j: -entry for j, entry in row.D.items() if j not in held}
        right.append(line)
    try:
        return solve(inside, right) if held else []
    except SingularError:
        raise StructureError(
            f"the ports {listed(ports)} hold one another: their efforts are not unique; name fewer of them"
        ) from None

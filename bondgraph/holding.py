"""Ports that stick: the efforts that hold them, and the system with their slips taken out."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.exact import Row, SingularError, add_scaled, rows_of, solve
from bondgraph.junction import Port
from bondgraph.rates import resolved
from bondgraph.reduction import Reading
from bondgraph.tidy import tidy


def holding_efforts(
    equations: StateEquations, stuck: Iterable[Hashable]
) -> Mapping[sp.Symbol, sp.Expr]:
    """What ports must give to keep what they receive at zero, over states and the other inputs.

    From ``F_s A^-1 (J x + B u) = 0``, jointly for all ports of ``stuck`` (nodes), or, where a
    resistance lies beside them, from ``F_s x + D_s u = 0`` (Deur, Hancock, Assadian 2008, eq. (8)
    and the stiction torques of Fig. 9).

    Raises `StructureError` for unknown ports and for redundant ones, whose efforts are not unique;
    `DependentSourceError` where the rate of another input would be needed.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("push", "P"), bg.One("block"), bg.I("m", "m"), bg.R("ground", effort="F")])
    >>> g.add_edges_from([("push", "block"), ("block", "m"), ("block", "ground")])
    >>> dict(holding_efforts(bg.derive(g), ["ground"]))
    {F: P}
    """
    ports = stuck_ports(equations, stuck)
    held = [equations.inputs.index(port.given) for port in ports]
    rows = [equations.readings[port.received] for port in ports]
    if all(not any(column in row.D for column in held) for row in rows):
        rows = [_rate(equations, row, port) for row, port in zip(rows, ports, strict=True)]
    solved = _solve_for(rows, held, len(equations.states), ports)
    variables = [*equations.states, *equations.inputs]
    return MappingProxyType({
        port.given: tidy(sp.Add(*(entry * variables[at] for at, entry in sorted(row.items()))))
        for port, row in zip(ports, solved, strict=True)
    })  # fmt: skip


def stuck_ports(equations: StateEquations, stuck: Iterable[Hashable]) -> list[Port]:
    """The open ports of these nodes; `StructureError` for any that is none."""
    if isinstance(stuck, str) or not isinstance(stuck, Iterable):
        raise StructureError(f"stuck must be a list of nodes, not {stuck!r}")
    by_name = {port.element.name: port for port in equations.ports}
    ports: list[Port] = []
    for name in stuck:
        port = by_name.get(name)
        if port is None or port.element.kind != "R":
            known = [str(n) for n, p in by_name.items() if p.element.kind == "R"]
            raise StructureError(
                f"no open port is called {name!r} that could stick; there are {', '.join(known) or 'none'}"
            )
        ports.append(port)
    return ports


def balances_of(equations: StateEquations) -> tuple[list[Row], list[Reading]]:
    """A by rows, and ``J x + B u + E u'`` by rows."""
    parts = (rows_of(equations.J), rows_of(equations.B), rows_of(equations.E))
    balances = [Reading(F, D, {}, K) for F, D, K in zip(*parts, strict=True)]
    return rows_of(equations.A), balances


def _rate(equations: StateEquations, row: Reading, port: Port) -> Reading:
    """How fast what a port receives changes, as a row over states and inputs."""
    if row.H or row.K or row.D:
        raise DependentSourceError(
            f"what holds {port.element.name!r} depends on the rate of an input; "
            "put a storage or a resistance between"
        )
    rate = resolved(*balances_of(equations), Reading({}, {}, row.F, {}))
    if rate.K:
        raise DependentSourceError(
            f"what holds {port.element.name!r} depends on the rate of an input that drives a dependent "
            "storage; simulate it, or lag the input"
        )
    return rate


def _solve_for(
    rows: Sequence[Reading], held: Sequence[int], states: int, ports: Sequence[Port]
) -> list[Row]:
    """``F x + D u = 0`` solved for the held inputs, over the columns of x and then u."""
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
        names = ", ".join(repr(port.element.name) for port in ports)
        raise StructureError(
            f"the ports {names} hold one another: their efforts are not unique; name fewer of them"
        ) from None


@dataclass(frozen=True)
class Reduced:
    """States that remain when slips are held at zero: ``x = T x_r``, ``T`` by rows."""

    kept: tuple[int, ...]
    T: tuple[Row, ...]


def without_slips(slips: Sequence[Row], order: Sequence[int]) -> Reduced:
    """Solve ``F_s x = 0`` for as many states as there are independent slips, in that order of states.

    >>> without_slips([{0: sp.Integer(1), 1: -sp.Integer(2)}], [0, 1]).T
    ({0: 2}, {0: 1})
    """
    matrix = sp.zeros(len(slips), len(order))
    for i, row in enumerate(slips):
        for at, j in enumerate(order):
            matrix[i, at] = row.get(j, 0)
    reduced, pivots = matrix.rref(
        simplify=sp.cancel, iszerofunc=lambda entry: sp.cancel(entry) == 0
    )
    gone = {order[pivot]: i for i, pivot in enumerate(pivots)}
    kept = tuple(j for j in range(len(order)) if j not in gone)
    place = {j: at for at, j in enumerate(kept)}
    T: list[Row] = [{place[j]: sp.Integer(1)} if j in place else {} for j in range(len(order))]
    for j, i in gone.items():
        entries = {at: reduced[i, order.index(k)] for k, at in place.items()}
        T[j] = {at: -entry for at, entry in entries.items() if entry != 0}
    return Reduced(kept, tuple(T))


def multiplied(row: Mapping[int, sp.Expr], T: Sequence[Row]) -> Row:
    """``row * T``."""
    result: Row = {}
    for j, entry in row.items():
        add_scaled(result, T[j], entry)
    return result


def folded(rows: Sequence[Row], T: Sequence[Row], count: int) -> list[Row]:
    """``T^T rows``."""
    result: list[Row] = [{} for _ in range(count)]
    for row, weights in zip(rows, T, strict=True):
        for at, weight in weights.items():
            add_scaled(result[at], row, weight)
    return result

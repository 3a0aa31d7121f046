"""Ports that stick: the efforts that hold them, and the system with their slips taken out."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, rows_of, solve
from bondgraph.algebra.residues import is_zero
from bondgraph.algebra.tidy import tidy
from bondgraph.analyse.constrained import echelon
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port


def holding_efforts(
    equations: StateEquations, stuck: Iterable[Hashable]
) -> Mapping[sp.Symbol, sp.Expr]:
    """What ports must give to keep what they receive at zero, over states and the other inputs.

    From ``F_s A^-1 (J x + B u) = 0``, jointly for all ports of ``stuck`` (nodes, switches too), or, where a
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
    ports = stuck_ports(equations, stuck, {one.name: one.port for one in equations.switches})
    if equations.varying:
        raise StructureError(
            "values of this graph change in time, and with them what a port must give: hold it in a run"
        )
    held = [equations.inputs.index(port.given) for port in ports]
    rows = [equations.readings[port.received] for port in ports]
    direct, bound, _ = split(rows, held)
    rates = [_rate(equations, row, ports) for row in bound]
    solved = solve_for([*direct, *rates], held, len(equations.states), ports)
    variables = [*equations.states, *equations.inputs]
    return MappingProxyType({
        port.given: tidy(sp.Add(*(entry * variables[at] for at, entry in sorted(row.items()))))
        for port, row in zip(ports, solved, strict=True)
    })  # fmt: skip


def stuck_ports(
    equations: StateEquations, stuck: Iterable[Hashable],
    switches: Mapping[Hashable, Port] = MappingProxyType({}),
) -> list[Port]:  # fmt: skip
    """The open ports of these nodes, or the switches allowed; `StructureError` for any that is neither."""
    if isinstance(stuck, str) or not isinstance(stuck, Iterable):
        raise StructureError(f"stuck must be a list of nodes, not {stuck!r}")
    resisting = {p.element.name: p for p in equations.ports if p.element.kind.resists}
    by_name = {**resisting, **switches}
    switched = {one.name for one in equations.switches} - switches.keys()
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


def _rate(equations: StateEquations, row: Reading, ports: Sequence[Port]) -> Reading:
    """How fast a slip changes that efforts don't touch at once, as a row over states and inputs."""
    if not (row.H or row.K or row.D):
        rate = resolved(*balances_of(equations), Reading({}, {}, row.F, {}))
        if not rate.K:
            return rate
    raise DependentSourceError(
        f"what holds {_names(ports)} depends on the rate of an input or of what a law gives; put a storage "
        "or a resistance between, or simulate it"
    )


def _names(ports: Sequence[Port]) -> str:
    return ", ".join(repr(port.element.name) for port in ports)


def solve_for(
    rows: Sequence[Reading], held: Sequence[int], states: int, ports: Sequence[Port]
) -> list[Row]:
    """``F x + D u = 0`` solved for the held inputs, over the columns of x and then u.

    Raises `StructureError` where they are not unique, `DependentSourceError` if rates come in.
    """
    if any(row.H or row.K for row in rows):
        raise DependentSourceError(
            f"what holds {_names(ports)} depends on the rate of what drives a dependent storage; "
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
            f"the ports {_names(ports)} hold one another: their efforts are not unique; name fewer of them"
        ) from None

"""`junction_structure`: what every port receives, as an exact linear function of what all ports give."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import (
    Row,
    SingularError,
    add_scaled,
    combined,
    matrix_of,
    scaled,
    solve,
)
from bondgraph.causality.assign import CausalGraph
from bondgraph.causality.signals import CausalEquations, causal_equations, causal_groups, loop_rows
from bondgraph.causality.strokes import Strokes
from bondgraph.declare.elements import SOURCES, Element, Kind
from bondgraph.declare.laws import ExpressionLaw
from bondgraph.errors import AlgebraicLoopError


@dataclass(frozen=True)
class Port:
    """A one-port with its causality: it gives one variable and receives the other.

    ``inward`` is 1 if power counts into the port, -1 if it counts out (a source drawn as a tail).
    """

    element: Element
    gives: str
    inward: int

    @property
    def given(self) -> sp.Symbol:
        """The variable the port gives."""
        return self.element.effort if self.gives == "effort" else self.element.flow

    @property
    def received(self) -> sp.Symbol:
        """The variable the port receives."""
        return self.element.flow if self.gives == "effort" else self.element.effort

    @property
    def integral(self) -> bool:
        """Whether the port of a storage has integral causality."""
        return self.gives == ("flow" if self.element.kind is Kind.I else "effort")

    @property
    def own_state(self) -> sp.Symbol | None:
        """The state that a law at this port owns, or that a detector makes."""
        law = self.element.law
        if isinstance(law, ExpressionLaw) and law.state is not None and self.integral:
            return law.state
        return self.element.integral


@dataclass(frozen=True)
class JunctionStructure:
    """``w = S z``: what the ports receive from what they give, power-conserving.

    ``ports`` in declaration order; S (ports x ports) holds moduli only, and with power counted
    into every port it is skew-symmetric. ``common``: each junction's common variable as a row over z.
    ``bonds``: each bond, as declared, with its effort and its flow as rows over z.
    """

    ports: tuple[Port, ...]
    #: For each port the row of S, sparse: port number to modulus.
    rows: tuple[Mapping[int, sp.Expr], ...]
    common: Mapping[Hashable, Mapping[int, sp.Expr]]
    bonds: Mapping[tuple[Hashable, Hashable], tuple[Mapping[int, sp.Expr], Mapping[int, sp.Expr]]]
    elements: Mapping[Hashable, Element]
    #: Of each loop of signals ``s = W s + r`` that was solved the rows of ``1 - W``.
    loops: tuple[tuple[Row, ...], ...] = ()

    @cached_property
    def places(self) -> Mapping[Hashable, int]:
        """Each port's number by its node's name."""
        return {port.element.name: at for at, port in enumerate(self.ports)}

    @property
    def states_of_laws(self) -> tuple[sp.Symbol, ...]:
        """The states that laws own and that detectors make, in declaration order."""
        found: list[sp.Symbol] = []
        for port in self.ports:
            found += [port.own_state] if port.own_state is not None else []
        return tuple(found)

    @cached_property
    def S(self) -> sp.ImmutableSparseMatrix:
        """The matrix that ``rows`` hold, ports x ports."""
        return matrix_of(self.rows, len(self.rows))


def junction_structure(causal: CausalGraph) -> JunctionStructure:
    """Eliminate the bonds along causal paths, solving each loop of them on its own.

    Raises `AlgebraicLoopError` for a loop whose determinant vanishes identically.
    """
    strokes = causal.assignment
    equations = causal_equations(strokes)
    one_ports = [node for node, element in enumerate(strokes.elements) if element.one_port]
    index = {node: at for at, node in enumerate(one_ports)}
    signals, loops = _signals(strokes, equations, index)
    rows = []
    for node in one_ports:
        signal, sign = equations.received[node]
        rows.append(signals[signal] if sign == 1 else scaled(signals[signal], sign))
    common = {
        strokes.names[node]: signals[2 * strokes.at[node][0] + (element.kind is Kind.ONE)]
        for node, element in enumerate(strokes.elements)
        if element.kind in (Kind.ZERO, Kind.ONE)
    }
    pairs = zip(signals[::2], signals[1::2], strict=True)
    return JunctionStructure(
        ports=tuple(_port(strokes, node) for node in one_ports),
        rows=tuple(rows),
        common=MappingProxyType(common),
        bonds=MappingProxyType(dict(zip(strokes.declared, pairs, strict=True))),
        elements=MappingProxyType(dict(zip(strokes.names, strokes.elements, strict=True))),
        loops=loops,
    )


def _port(strokes: Strokes, node: int) -> Port:
    element = strokes.elements[node]
    tail = strokes.bonds[strokes.at[node][0]][0] == node
    inward = -1 if element.kind in SOURCES and tail else 1
    return Port(element, strokes.gives(node), inward)


def _signals(
    strokes: Strokes, equations: CausalEquations, index: dict[int, int]
) -> tuple[list[Row], tuple[tuple[Row, ...], ...]]:
    """Every signal as a sparse row over what the ports give, and the loops on the way."""
    signals: list[Row] = [{} for _ in equations.terms]
    loops: list[tuple[Row, ...]] = []
    for group in causal_groups(equations.terms):
        if len(group) == 1:
            signals[group[0]] = _signal(equations, group[0], index, signals)
        else:
            _solve_loop(strokes, equations, group, signals)
            loops.append(tuple(loop_rows(equations, group)))
    return signals, tuple(loops)


def _signal(
    equations: CausalEquations, signal: int, index: dict[int, int], signals: list[Row]
) -> Row:
    if signal in equations.given:
        node, sign = equations.given[signal]
        return {index[node]: sp.Integer(sign)}
    terms = equations.terms[signal]
    if len(terms) == 1:
        # Rows are never changed once made, so equal signals may share one.
        source, factor = terms[0]
        return signals[source] if factor == 1 else scaled(signals[source], factor)
    return combined((signals[source], factor) for source, factor in terms)


def _solve_loop(
    strokes: Strokes, equations: CausalEquations, group: tuple[int, ...], signals: list[Row]
) -> None:
    """Solve ``s = W s + r`` for the signals of one loop, r being known rows."""
    place = {signal: at for at, signal in enumerate(group)}
    matrix: list[Row] = []
    right: list[Row] = []
    for at, signal in enumerate(group):
        inside: Row = {at: sp.Integer(1)}
        outside: Row = {}
        for source, factor in equations.terms[signal]:
            if source in place:
                add_scaled(inside, {place[source]: sp.Integer(1)}, -factor)
            else:
                add_scaled(outside, signals[source], factor)
        matrix.append(inside)
        right.append(outside)
    try:
        solved = solve(matrix, right)
    except SingularError:
        raise AlgebraicLoopError(_loop_message(strokes, group)) from None
    for signal, row in zip(group, solved, strict=True):
        signals[signal] = row


def _loop_message(strokes: Strokes, group: tuple[int, ...]) -> str:
    names = []
    for signal in group[:8]:
        tail, head = strokes.declared[signal // 2]
        names.append(f"{'flow' if signal % 2 else 'effort'} of {tail!r} -> {head!r}")
    more = f" and {len(group) - 8} more" if len(group) > 8 else ""
    return (
        f"the signals {', '.join(names)}{more} form a loop whose determinant vanishes identically; "
        "open the loop, or put a storage or a resistance on it"
    )

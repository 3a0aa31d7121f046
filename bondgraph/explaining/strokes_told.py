"""The causal story as it came about: who imposes what on whom, and who became dependent."""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import Literal

import sympy as sp

from bondgraph.causality.assignments import Assignment
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.record import Reason, Strokes
from bondgraph.causality.stories import deciding_nodes
from bondgraph.explaining.records import Step
from bondgraph.nodes.elements import Bond
from bondgraph.reduce.sorting import Reduction

Symbols = Mapping[tuple[Bond, Literal["effort", "flow"]], sp.Symbol]
"""The symbol of each bond's effort and flow."""

MOST_NODES = 10
"""Of longer chains of nodes the middle is counted only."""


def causality_step(
    causal: CausalGraph, signals: Sequence[Assignment], reduction: Reduction
) -> Step:
    """What one-ports choose, what junctions take from which bond, and what that makes dependent."""
    symbols = {(line.bond, line.variable): line.symbol for line in signals}
    lines = [*_imposed(causal.assignment, symbols), *_dependent(causal, reduction)]
    return Step("causality", "Who imposes what on whom", tuple(lines))


def _imposed(strokes: Strokes, symbols: Symbols) -> Iterator[str]:
    """A sentence for every choice, every two-port and every junction, as their strokes were set."""
    for bond in strokes.trail:
        reason = strokes.reason[bond]
        if reason is None or strokes.elements[strokes.bonds[bond][0]].of_signals:
            continue
        if not strokes.elements[reason.node].kind.joins or not reason.causes:
            yield _decision(strokes, symbols, bond, reason)
        for node in strokes.bonds[bond]:
            zero = strokes.elements[node].kind.common == "effort"
            if strokes.elements[node].kind.joins and (strokes.end[bond] == node) == zero:
                yield _common(strokes, symbols, bond, node)


def _decision(strokes: Strokes, symbols: Symbols, bond: int, reason: Reason) -> str:
    node = reason.node
    gives: Literal["effort", "flow"] = "flow" if strokes.end[bond] == node else "effort"
    symbol = symbols[strokes.declared[bond], gives]
    other = strokes.names[strokes.other(bond, node)]
    return f"{_called(strokes, node)} {reason.text}; it gives the {gives} {symbol} to {other}"


def _common(strokes: Strokes, symbols: Symbols, bond: int, node: int) -> str:
    """A junction, the one bond that brings its common variable, and those that take it from there."""
    zero = strokes.elements[node].kind.common == "effort"
    what: Literal["effort", "flow"] = "effort" if zero else "flow"
    others = [strokes.other(b, node) for b in strokes.at[node] if b != bond]
    reason = strokes.reason[bond]
    last = reason is not None and reason.node == node
    takes = f"has one bond left to take its {what} from" if last else f"takes its {what}"
    return (
        f"{_called(strokes, node)} {takes}{':' if last else ''} {symbols[strokes.declared[bond], what]} "
        f"from {strokes.names[strokes.other(bond, node)]}"
        + (f", and hands it to {_listed(strokes, others)}" if others else "")
    )


def _dependent(causal: CausalGraph, reduction: Reduction) -> Iterator[str]:
    """For each storage in derivative causality: what rules it, and by way of which nodes."""
    strokes = causal.assignment
    numbers: dict[Hashable, int] = {name: at for at, name in enumerate(strokes.names)}
    for port in reduction.dependent:
        one = reduction.structure.ports[port]
        node = numbers[one.element.name]
        chose, passed = deciding_nodes(strokes, node)
        receives = "flow" if one.gives == "effort" else "effort"
        way = f" by way of {_listed(strokes, passed)}" if passed else ""
        yield (
            f"{_called(strokes, node)} is dependent: its {receives} {one.received} is imposed by "
            f"{_listed(strokes, [n for n in chose if n != node])}{way}"
        )


def _called(strokes: Strokes, node: int) -> str:
    return f"{strokes.names[node]} ({strokes.elements[node].kind.word})"


def _listed(strokes: Strokes, nodes: Sequence[int]) -> str:
    names = [str(strokes.names[node]) for node in nodes]
    if len(names) > MOST_NODES:
        left = len(names) - MOST_NODES + 1
        names = [*names[: MOST_NODES // 2], f"{left} more", *names[-(MOST_NODES // 2 - 1) :]]
    return ", ".join(names) or "the structure alone"

"""Causal-order assignments: one line per effort and flow, each from earlier ones, as textbooks write them."""

import re
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.algebra.expressions import TIME
from bondgraph.causality.assign import assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.lines import Line, Rule, is_independent, owner, signal_lines, variable_of
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations, Term, causal_equations, causal_groups
from bondgraph.declare.names import named_by
from bondgraph.nodes.elements import Bond


@dataclass(frozen=True)
class Assignment:
    """``symbol = right``: one effort or flow of a bond.

    ``kind``: "given" is a state, an input (what an open port, a source, a law or a switch gives), or the
    nothing that a detector gives; "balance" the sum at a junction; "transfer" what a junction hands on
    and what a transformer or gyrator makes of it; "law" a linear resistance. Of a "rate", what a storage
    in derivative causality gives, ``right`` is the momentum or displacement: the signal is its rate.

    ``bond`` is as declared, with power as `StateEquations.bond` counts it; ``node`` is the one whose
    equation it is. ``group`` counts up; signals that form a loop share one number and are solved together.
    """

    symbol: sp.Symbol
    right: sp.Expr
    kind: Rule
    variable: Literal["effort", "flow"]
    bond: Bond
    node: Hashable
    group: int


def assignments(graph: Any) -> tuple[Assignment, ...]:
    """The bond equations of a causal or a declared graph in an order in which each follows from earlier ones.

    Right sides hold symbols of earlier groups and, in a loop, of the own one; states, inputs and
    values. A signal is called as its one-port calls it, else as the junction that takes it calls its
    common variable, else ``e_<tail>_<head>`` or ``f_<tail>_<head>``; no two signals share a symbol. A law
    that closes a port is in `StateEquations.laws`, its port's signal is given.

    Raises what `assign_causality` raises.

    >>> import bondgraph as bg
    >>> import networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("source", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> g.add_edges_from([("source", "loop"), ("loop", "L"), ("loop", "R")])
    >>> for line in assignments(g):
    ...     print(line.kind, line.symbol, "=", line.right)
    given u = u
    given i = i
    transfer f_source = i
    transfer f_R = i
    law e_R = R*f_R
    balance e_L = -e_R + u
    """
    causal = graph if isinstance(graph, CausalGraph) else assign_causality(graph)
    strokes = causal.assignment
    equations = causal_equations(strokes)
    symbols = _symbols(strokes, equations)
    signals = _signals_by_name(strokes, equations)
    lines = list(signal_lines(strokes, equations))
    rights = [_right(line, symbols, signals) for line in lines]
    order = [[*line[1], *more] for line, (_, more) in zip(lines, rights, strict=True)]
    result: list[Assignment] = []
    for group, members in enumerate(causal_groups(order)):
        for signal in members:
            bond, node = signal // 2, owner(strokes, signal)
            result.append(
                Assignment(
                    symbols[signal], rights[signal][0], lines[signal][0],
                    "flow" if signal % 2 else "effort", strokes.declared[bond],
                    strokes.elements[node].owner or strokes.names[node], group,
                )
            )  # fmt: skip
    return tuple(result)


def _right(
    line: Line, symbols: list[sp.Symbol], signals: dict[sp.Symbol, Term]
) -> tuple[sp.Expr, list[Term]]:
    """The right side over symbols, and the terms it has beside the line's: signals that values read."""
    _, terms, rest = line
    parts = [rest] if rest != 0 else []
    more: list[Term] = []
    for signal, factor in terms:
        read = [] if factor.is_Rational else [one for one in factor.free_symbols if one in signals]
        more += [signals[one] for one in sorted(read, key=str)]
        put = {one: signals[one][1] * symbols[signals[one][0]] for one in read}
        parts.append((factor.xreplace(put) if put else factor) * symbols[signal])
    return sp.Add(*parts), more


def _names(
    strokes: Strokes, equations: CausalEquations
) -> Iterator[tuple[sp.Symbol, int, int, bool]]:
    """Every name of a signal: symbol, signal, the sign of the signal over it, whether it is independent.

    States and inputs come first, then what else one-ports give, what they receive, and what junctions
    have in common.
    """
    given = [(signal, *equations.given[signal]) for signal in sorted(equations.given)]
    for wanted in (True, False):
        for signal, node, sign in given:
            if is_independent(strokes, node) is wanted:
                element = strokes.elements[node]
                yield variable_of(element, strokes.gives(node)), signal, sign, wanted
    for node, (signal, sign) in equations.received.items():
        which = "flow" if strokes.gives(node) == "effort" else "effort"
        yield variable_of(strokes.elements[node], which), signal, sign, False
    for node, element in enumerate(strokes.elements):
        if not element.kind.joins:
            continue
        zero = element.kind.common == "effort"
        source = next(b for b in strokes.at[node] if (strokes.end[b] == node) == zero)
        name = element.effort if zero else element.flow
        if name is not None:
            yield name, 2 * source + (not zero), 1, False


def _symbols(strokes: Strokes, equations: CausalEquations) -> list[sp.Symbol]:
    """A symbol of its own for every signal."""
    found: dict[int, sp.Symbol] = {}
    taken: set[sp.Symbol] = set()
    names = list(_names(strokes, equations))
    states = {name for name, *_, independent in names if independent}
    for name, signal, sign, independent in names:
        free = name not in taken and (independent or name not in states)
        if sign == 1 and signal not in found and free:
            found[signal] = name
            taken.add(name)
    avoided = {name.name for name in _reserved(strokes)}
    tries: dict[str, int] = {}
    for signal in range(len(equations.terms)):
        if signal not in found:
            found[signal] = _made(strokes, signal, avoided, tries)
    return [found[signal] for signal in range(len(equations.terms))]


def _reserved(strokes: Strokes) -> Iterator[sp.Symbol]:
    """Every name of the graph."""
    yield TIME
    for element in strokes.elements:
        yield from named_by(element)
        conditions = (element.switch.on, element.switch.off) if element.switch else ()
        parts = (element.value, element.law, *(value for _, value in element.row), *conditions)
        for part in parts:
            if part is not None:
                yield from part.free_symbols


def _made(strokes: Strokes, signal: int, avoided: set[str], tries: dict[str, int]) -> sp.Symbol:
    """A new symbol ``e_<tail>_<head>`` or ``f_<tail>_<head>``, with a number where that is taken."""
    tail, head = (strokes.names[end] for end in strokes.bonds[signal // 2])
    text = str(normal(f"{'f' if signal % 2 else 'e'}_{tail}_{head}"))
    text = re.sub(r"\W", "_", text)
    made = text
    while made in avoided:
        tries[text] = tries.get(text, 1) + 1
        made = f"{text}_{tries[text]}"
    avoided.add(made)
    return sp.Symbol(made)


def _signals_by_name(strokes: Strokes, equations: CausalEquations) -> dict[sp.Symbol, Term]:
    """What a name in a value stands for, states and inputs aside: a signal, and its sign."""
    found: dict[sp.Symbol, Term] = {}
    names = list(_names(strokes, equations))
    states = {name for name, *_, independent in names if independent}
    for name, signal, sign, _ in names:
        if name not in states:
            found.setdefault(name, (signal, sp.Integer(sign)))
    return found

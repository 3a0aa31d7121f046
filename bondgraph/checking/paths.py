"""`causal_paths`: how what one node gives comes to another, path by path and loop by loop."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.factored import factored
from bondgraph.causality.assign import assign_causality
from bondgraph.causality.assignments import assignments
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.lines import owner
from bondgraph.checking.mason import Way, circles, transfer, ways
from bondgraph.checking.transfers import SignalGraph, node_of, signal_graph
from bondgraph.errors import StructureError, nearest


@dataclass(frozen=True)
class CausalPath:
    """A row of signals, each following from the one before; of a loop the first follows from the last.

    ``nodes``: whose equations it passes, in its order. ``gain``: the product of the elements' ``1/(I s)``,
    ``1/(C s)``, R, moduli and signs on the way; in derivative causality ``I s`` and ``C s``.
    """

    nodes: tuple[Hashable, ...]
    signals: tuple[sp.Symbol, ...]
    gain: sp.Expr


@dataclass(frozen=True)
class CausalPaths:
    """All causal paths from one node to another, all loops of the graph, and what Mason's rule makes of them.

    ``transfer``: ``sum P D_P / D``, with P the paths' gains, ``D = 1 - sum L + sum L L - ...`` over loops
    without a common signal, and D_P the same of the loops that the path does not touch.
    ``determinant``: D.
    """

    start: Hashable
    end: Hashable
    paths: tuple[CausalPath, ...]
    loops: tuple[CausalPath, ...]
    determinant: sp.Expr
    transfer: sp.Expr

    def __str__(self) -> str:
        lines = [f"paths from {self.start} to {self.end}:"]
        lines += [_line(path) for path in self.paths] or ["  none"]
        lines += ["loops:", *([_line(loop) for loop in self.loops] or ["  none"])]
        return "\n".join([*lines, f"D = {self.determinant}", f"transfer = {self.transfer}"])

    def _repr_markdown_(self) -> str:
        rows = ["| | by way of | gain |", "|---|---|---|"]
        for what, found in (("path", self.paths), ("loop", self.loops)):
            for one in found:
                nodes = " → ".join(map(str, one.nodes)).replace("|", "\\|")
                rows.append(f"| {what} | {nodes} | ${sp.latex(one.gain)}$ |")
        below = f"$$\\Delta = {sp.latex(self.determinant)}$$"
        whole = f"$$\\frac{{\\sum P \\Delta_P}}{{\\Delta}} = {sp.latex(self.transfer)}$$"
        return "\n".join([*rows, "", below, "", whole])


def _line(path: CausalPath) -> str:
    return f"  {' -> '.join(map(str, path.nodes))}: {path.gain}"


def causal_paths(graph: Any, start: Hashable, end: Hashable, s: str = "s") -> CausalPaths:
    """The causal paths of a declared or causal graph from one node to another, and its loops, with gains.

    ``start``: a one-port, whose path begins with what it gives: of a source or an open port its input, of a
    storage or a resistance what is added to what it gives. ``end``: a one-port, which shows what it
    receives, or a junction, which shows its common variable, as the outputs of `derive` do; or a function
    or a state, which shows itself. What functions, states and known sources read is a way, too, where they
    are linear. ``s``: the name of Laplace's variable.

    Raises what `assign_causality` raises, and `StructureError` for nodes that are not there, for laws,
    switches, controllers that work at instants and values that move, and for more paths or loops than can be
    read.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> g.add_edges_from([("u", "loop"), ("loop", "L"), ("loop", "R")])
    >>> print(causal_paths(g, "u", "R"))
    paths from u to R:
      u -> loop -> L -> loop -> R: 1/(L*s)
    loops:
      L -> loop -> R -> loop -> L: -R/(L*s)
    D = (L*s + R)/(L*s)
    transfer = 1/(L*s + R)
    """
    causal = graph if isinstance(graph, CausalGraph) else assign_causality(graph)
    signals = signal_graph(causal, sp.Symbol(s))
    first, turned = _start(signals, start)
    last, sign = _end(signals, end)
    paths = [Way(way.signals, turned * sign * way.gain) for way in ways(signals.graph, first, last)]
    loops = circles(signals.graph)
    above, below = transfer(paths, loops)
    names = {(line.bond, line.variable): line.symbol for line in assignments(causal)}
    return CausalPaths(
        start, end,
        tuple(_told(signals, names, way, [end]) for way in paths),
        tuple(_told(signals, names, _from_storage(signals, way), []) for way in loops),
        factored(below), factored(above / below),
    )  # fmt: skip


def _number(signals: SignalGraph, name: Hashable) -> int:
    names = signals.strokes.names
    if name not in names:
        raise StructureError(
            f"{name!r} is not a node of the graph{nearest(str(name), map(str, names))}"
        )
    return names.index(name)


def _start(signals: SignalGraph, name: Hashable) -> tuple[int, int]:
    node = _number(signals, name)
    element = signals.strokes.elements[node]
    if not element.one_port or element.kind.detects:
        raise StructureError(
            f"{element.kind.word} {name!r} gives nothing of its own; a path starts at a source, a storage, a "
            "resistance or an open port"
        )
    return signals.given[node]


def _end(signals: SignalGraph, name: Hashable) -> tuple[int, sp.Expr]:
    node = _number(signals, name)
    strokes, element = signals.strokes, signals.strokes.elements[node]
    if element.kind.two_port:
        raise StructureError(
            f"{element.kind} {name!r} has two efforts and two flows; a path ends at a junction or a one-port"
        )
    if element.of_signals:
        return _signal_of(signals, name)
    if element.one_port:
        return signals.received[node]
    zero = element.kind.common == "effort"
    bond = next(b for b in strokes.at[node] if (strokes.end[b] == node) == zero)
    return 2 * bond + (not zero), 1


def _signal_of(signals: SignalGraph, name: Hashable) -> tuple[int, sp.Expr]:
    """A function's own signal, or of a state the integral."""
    return next(
        home for one, home in signals.homes.items() if one.name == str(name)
    )  # fmt: skip


def _from_storage(signals: SignalGraph, loop: Way) -> Way:
    """The same loop from what its first storage gives on, else its first one-port."""
    elements = signals.strokes.elements
    givers = [owner(signals.strokes, signal) for signal in loop.signals]
    ranks = [(not elements[n].kind.stores, not elements[n].one_port, n) for n in givers]
    at = ranks.index(min(ranks))
    return Way((*loop.signals[at:], *loop.signals[:at]), loop.gain)


def _told(
    signals: SignalGraph, names: Mapping[Any, sp.Symbol], way: Way, after: list[Hashable]
) -> CausalPath:
    strokes = signals.strokes
    symbols = [
        names[strokes.declared[signal // 2], "flow" if signal % 2 else "effort"]
        for signal in way.signals
    ]
    nodes: list[Hashable] = []
    closing = after or [node_of(strokes, owner(strokes, way.signals[0]))]
    for node in [*(node_of(strokes, owner(strokes, signal)) for signal in way.signals), *closing]:
        if not nodes or nodes[-1] != node:
            nodes.append(node)
    return CausalPath(tuple(nodes), tuple(symbols), factored(way.gain))

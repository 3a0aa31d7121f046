"""What stands beside the matrices: what laws and sources give, what they read, and the rates of other states.

With these the equations are whole: every name is a state, a parameter, the time, an input from outside, what
a switch or dry friction gives, or stated.
"""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import networkx as nx
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw
from bondgraph.reduce.record import Reading
from bondgraph.show.ruled import Ruled, Turning
from bondgraph.show.signal_nodes import SignalNode, signal_nodes
from bondgraph.show.sums import Sum, positive_first, rate, signed_terms, split, total


@dataclass(frozen=True)
class Statement:
    """``left = right``; ``node``: whose equation it is, if it is one node's."""

    left: sp.Expr
    right: Sum
    node: Hashable | None = None
    #: The left side as it is to be written, if not by the names' order.
    left_sum: Sum = ()
    #: Of what has several ways these, instead of a right side.
    ruled: Ruled | None = None

    @property
    def left_terms(self) -> Sum:
        """The left side as factors times names: of rates the rates."""
        if self.left_sum:
            return self.left_sum
        names = self.left.free_symbols
        return split(self.left, {n for n in names if n.name.endswith("'")} or names)

    @property
    def value(self) -> sp.Expr:
        """The right side as one expression."""
        return total(self.right)

    @property
    def reads(self) -> set[sp.Symbol]:
        """The names on the right side."""
        return {*self.value.free_symbols} if self.ruled is None else self.ruled.reads

    @property
    def right_text(self) -> str:
        """The right side as sympy writes it; of what has several ways in words."""
        return str(self.value) if self.ruled is None else self.ruled.text()


@dataclass(frozen=True)
class Statements:
    """``given``: laws, sources and what they read, each after what it needs; ``rates``: of further states.

    ``loops``: names that determine one another at once, which are solved together. ``kept``: the rates, zero,
    of what controllers hold between their instants.
    """

    given: tuple[Statement, ...]
    rates: tuple[Statement, ...]
    loops: tuple[tuple[sp.Symbol, ...], ...]
    kept: tuple[Statement, ...] = ()


def statements(model: StateEquations) -> Statements:
    """All that the matrices leave unsaid.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
    ...                   bg.C("k", law="k*q_k**3")])
    >>> g.add_edges_from([("force", "j"), ("j", "m"), ("j", "k")])
    >>> found = statements(bg.derive(g))
    >>> [(one.left, one.value) for one in (*found.given, *found.rates)]
    [(e_k, k*q_k**3), (q_k', v)]
    """
    nodes = signal_nodes(model)
    rates = _rates(model, nodes)
    held = {name for task in model.tasks for name in task.states} | model.kept
    kept = {rate(name) for name in held}
    stated, hidden = _laws(model, nodes)
    wanted = _read(model, nodes).union(*(one.reads for one in rates if one.left not in kept))
    _add_readings(model, stated, hidden, wanted)
    order, loops = _in_causal_order(stated)
    return Statements(
        tuple(stated[name] for name in order), tuple(one for one in rates if one.left not in kept),
        loops, tuple(one for one in rates if one.left in kept),
    )  # fmt: skip


Stated = dict[sp.Symbol, Statement]


def _laws(model: StateEquations, nodes: Iterable[SignalNode]) -> tuple[Stated, Stated]:
    """What ports give by an expression, and what nodes of signals come to; and what parts of these give."""
    inner = {name for node in nodes for name in node.given - {node.stated}}
    stated: Stated = {}
    hidden: Stated = {}
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, ExpressionLaw):
            one = Statement(port.given, signed_terms(law.expression), port.element.name)
            (hidden if port.given in inner else stated)[port.given] = one
    for node in nodes:
        if isinstance(node.ruled, Turning):
            stated[node.ruled.left] = Statement(node.ruled.left, (), node.name, ruled=node.ruled)
    return stated, hidden


def _rates(model: StateEquations, nodes: Iterable[SignalNode]) -> list[Statement]:
    """Of the states that laws own, and of those that detectors and nodes of signals make."""
    found = []
    own = {node.state: node for node in nodes if node.state is not None}
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, ExpressionLaw) and law.state is not None:
            right = _received(model, port.received)
            found.append(Statement(rate(law.state), right, port.element.name))
    for state in (*model.integrals, *(one for one in own if one not in model.integrals)):
        node = own.get(state)
        if node is None:
            found.append(Statement(rate(state), _received(model, model.integrals[state])))
        elif node.ruled is not None:
            found.append(Statement(rate(state), (), node.name, ruled=node.ruled))
        elif node.rate is not None:
            found.append(Statement(rate(state), signed_terms(node.rate), node.name))
    return found


def _received(model: StateEquations, name: sp.Symbol) -> Sum:
    """A signal over states and inputs; itself where it is one of these, or an output."""
    if name in {*model.states, *model.inputs, *model.outputs}:
        return signed_terms(name)
    return _over_columns(model, name)


def _over_columns(model: StateEquations, name: sp.Symbol) -> Sum:
    reading = model.readings.get(name) or model.reduction.reading(model.signals[name])
    return positive_first(reading_sum(model.states, model.inputs, reading))


def _read(model: StateEquations, nodes: Iterable[SignalNode]) -> set[sp.Symbol]:
    """What matrices, dry friction, switches and controllers read, beside what is received at their ports."""
    told = {name for node in nodes for name in node.given}
    used: set[sp.Symbol] = set()
    for matrix in (model.A, model.J, model.B, model.E, model.F, model.D, model.G):
        used |= matrix.free_symbols
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, DryFriction) and port.given not in told:
            used |= {*law.free_symbols} - {SLIP} | {port.received}
    for switch in model.switches:
        if switch.port.given in told:
            continue
        own = set[sp.Symbol]() if switch.switch.transition else {switch.port.received}
        used |= own.union(*(part.free_symbols for part in switch.read))
    for late in model.delays:
        used |= late.value.free_symbols
    for task in model.tasks:
        used |= {*task.reads}.union(*(one.value.free_symbols for one in task.resets))
    return used


def _add_readings(
    model: StateEquations, stated: Stated, hidden: Stated, wanted: Iterable[sp.Symbol]
) -> None:
    """Of every signal that something reads and that is neither a state, an input nor an output."""
    known = {*model.states, *model.inputs, *model.outputs, *stated} - hidden.keys()
    read = {*wanted}.union(*(one.reads for one in stated.values()))
    waiting = sorted(read, key=str, reverse=True)
    while waiting:
        name = waiting.pop()
        if name in known or (name not in model.signals and name not in hidden):
            continue
        known.add(name)
        stated[name] = hidden.get(name) or Statement(name, _over_columns(model, name))
        waiting += sorted(stated[name].reads - known, key=str, reverse=True)


def reading_sum(x: Sequence[sp.Symbol], u: Sequence[sp.Symbol], reading: Reading) -> Sum:
    """A reading as a sum over states x, inputs u and their rates."""
    columns = (x, u, [rate(name) for name in x], [rate(name) for name in u])
    return tuple(
        (row[j], names[j])
        for row, names in zip(reading.parts, columns, strict=True)
        for j in sorted(row)
    )


def _in_causal_order(
    stated: Mapping[sp.Symbol, Statement],
) -> tuple[list[sp.Symbol], tuple[tuple[sp.Symbol, ...], ...]]:
    """Names as declared, each right after what only it needs; those that need one another side by side."""
    needs: nx.DiGraph[sp.Symbol] = nx.DiGraph()
    needs.add_nodes_from(stated)
    place = {name: at for at, name in enumerate(stated)}
    for name, one in stated.items():
        read = sorted(one.reads & {*stated}, key=place.__getitem__)
        needs.add_edges_from((name, other) for other in read)
    parts = nx.condensation(needs)
    members = {k: sorted(parts.nodes[k]["members"], key=place.__getitem__) for k in parts}
    first = sorted(parts, key=lambda k: place[members[k][0]])
    groups: dict[int, list[sp.Symbol]] = {}
    for start in first:
        # What is needed is told before; what is told already, once.
        for k in nx.dfs_postorder_nodes(parts, start):
            groups.setdefault(k, members[k])
    loops = [tuple(g) for g in groups.values() if len(g) > 1 or needs.has_edge(g[0], g[0])]
    return [name for group in groups.values() for name in group], tuple(loops)

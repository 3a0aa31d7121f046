"""What stands beside the matrices: what laws and sources give, what they read, and the rates of other states.

With these the equations are whole: every name is a state, a parameter, the time, an input from outside, what
a switch or dry friction gives, or stated.
"""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import networkx as nx
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw
from bondgraph.reduce.record import Reading
from bondgraph.show.sums import Sum, positive_first, rate, signed_terms, split, total


@dataclass(frozen=True)
class Statement:
    """``left = right``; ``node``: whose equation it is, if it is one node's."""

    left: sp.Expr
    right: Sum
    node: Hashable | None = None
    #: The left side as it is to be written, if not by the names' order.
    left_sum: Sum = ()

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


@dataclass(frozen=True)
class Statements:
    """``given``: laws, sources and what they read, each after what it needs; ``rates``: of further states.

    ``loops``: names that determine one another at once, which are solved together.
    """

    given: tuple[Statement, ...]
    rates: tuple[Statement, ...]
    loops: tuple[tuple[sp.Symbol, ...], ...]


def without_functions(model: StateEquations) -> StateEquations:
    """The equations whose outputs are none of their inputs: a function is stated as what it is."""
    kept = [at for at, name in enumerate(model.outputs) if name not in model.inputs]
    if len(kept) == len(model.outputs):
        return model
    rows = {letter: _part(model, letter, rows=kept) for letter in "FDG"}
    return replace(model, outputs=tuple(model.outputs[at] for at in kept), **rows)


def without_idle(model: StateEquations) -> StateEquations:
    """The equations for their matrices alone: without the columns of signals that move no state."""
    own = {p.given for p in model.ports if p.element.declared and p.element.declared.signals}
    used = {j for letter in "BEDG" for _, j in getattr(model, letter).todok()}
    kept = [j for j, name in enumerate(model.inputs) if j in used or name not in own]
    if len(kept) == len(model.inputs):
        return model
    columns = {letter: _part(model, letter, columns=kept) for letter in "BEDG"}
    return replace(model, inputs=tuple(model.inputs[j] for j in kept), **columns)


def _part(
    model: StateEquations, letter: str, rows: Sequence[int] | None = None,
    columns: Sequence[int] | None = None,
) -> sp.ImmutableSparseMatrix:  # fmt: skip
    whole = getattr(model, letter)
    every = [list(range(size)) if kept is None else list(kept)
             for size, kept in zip(whole.shape, (rows, columns), strict=True)]  # fmt: skip
    return sp.ImmutableSparseMatrix(whole.extract(*every))


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
    laws, rates = _laws(model), _rates(model)
    stated = {law.left: law for law in laws}
    wanted = _read(model) | {name for one in rates for name in one.value.free_symbols}
    _add_readings(model, stated, wanted)
    order, loops = _in_causal_order(stated)
    return Statements(tuple(stated[name] for name in order), tuple(rates), loops)


def _laws(model: StateEquations) -> list[Statement]:
    """What ports give by an expression."""
    found = []
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, ExpressionLaw):
            found.append(Statement(port.given, signed_terms(law.expression), port.element.name))
    return found


def _rates(model: StateEquations) -> list[Statement]:
    """Of the states that laws own, and of those that detectors make."""
    found = []
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, ExpressionLaw) and law.state is not None:
            right = _received(model, port.received)
            found.append(Statement(rate(law.state), right, port.element.name))
    for state, signal in model.integrals.items():
        found.append(Statement(rate(state), _received(model, signal)))
    return found


def _received(model: StateEquations, name: sp.Symbol) -> Sum:
    """A signal over states and inputs; itself where it is one of these, or an output."""
    if name in {*model.states, *model.inputs, *model.outputs}:
        return signed_terms(name)
    return _over_columns(model, name)


def _over_columns(model: StateEquations, name: sp.Symbol) -> Sum:
    reading = model.readings.get(name) or model.reduction.reading(model.signals[name])
    return positive_first(reading_sum(model.states, model.inputs, reading))


def _read(model: StateEquations) -> set[sp.Symbol]:
    """What matrices, dry friction, switches and controllers read, beside what is received at their ports."""
    used: set[sp.Symbol] = set()
    for matrix in (model.A, model.J, model.B, model.E, model.F, model.D, model.G):
        used |= matrix.free_symbols
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, DryFriction):
            used |= {*law.free_symbols} - {SLIP} | {port.received}
    for switch in model.switches:
        own = set[sp.Symbol]() if switch.switch.transition else {switch.port.received}
        used |= own.union(*(part.free_symbols for part in switch.read))
    for late in model.delays:
        used |= late.value.free_symbols
    for task in model.tasks:
        used |= {*task.reads}.union(*(one.value.free_symbols for one in task.resets))
    return used


def _add_readings(
    model: StateEquations, stated: dict[sp.Symbol, Statement], wanted: Iterable[sp.Symbol]
) -> None:
    """Of every signal that something reads and that is neither a state, an input nor an output."""
    known = {*model.states, *model.inputs, *model.outputs}
    read = {*wanted}.union(*(one.value.free_symbols for one in stated.values()))
    waiting = sorted(read, key=str, reverse=True)
    while waiting:
        name = waiting.pop()
        if name in known or name not in model.signals:
            continue
        known.add(name)
        stated[name] = Statement(name, _over_columns(model, name))
        waiting += sorted(stated[name].value.free_symbols - known, key=str, reverse=True)


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
        read = sorted(one.value.free_symbols & {*stated}, key=place.__getitem__)
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

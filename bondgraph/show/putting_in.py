"""Equations with laws and sources put into one another: what each state's rate comes to."""

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.functions import without_logarithms
from bondgraph.algebra.tidy import tidy
from bondgraph.equations import StateEquations
from bondgraph.errors import AlgebraicLoopError
from bondgraph.reduce.motion import slope_of
from bondgraph.show.display import rows_of_terms
from bondgraph.show.statements import Statement, Statements
from bondgraph.show.sums import over_common, rate, signed_terms, total
from bondgraph.solving.loops import closed as solved_loops

LONGEST = 200
"""What has more operations, put in, is left under its name."""


def closed(model: StateEquations, found: Statements) -> tuple[Statement, ...]:
    """Every state's equation, then every output's, over states, the time and what comes from outside.

    Left under their names are what laws determine together that are not linear, and what would be long;
    `Statements` has both.

    >>> import bondgraph as bg, networkx as nx
    >>> from bondgraph.show.statements import statements
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
    ...                   bg.C("k", law="k*q_k**3")])
    >>> g.add_edges_from([("force", "j"), ("j", "m"), ("j", "k")])
    >>> equations = bg.derive(g)
    >>> [(one.left, one.value) for one in closed(equations, statements(equations))]
    [(m*v', F - k*q_k**3), (q_k', v)]
    """
    put = _PuttingIn(model, found)
    rows = [
        Statement(total(tuple(left)), tuple(right), left_sum=tuple(left))
        for left, right in rows_of_terms(model)
    ]
    n = len(model.states)
    # A function that is shown is stated as what it is.
    shown = [one for one in rows[n:] if one.left not in model.inputs]
    return tuple(put.into_both(one) for one in (*rows[:n], *found.rates, *shown))


class _PuttingIn:
    """What stands for names, and for their rates."""

    def __init__(self, model: StateEquations, found: Statements) -> None:
        self._states, self._inputs = {*model.states}, {*model.inputs}
        self._values: dict[sp.Symbol, sp.Expr] = {}
        self._rates: dict[sp.Symbol, sp.Expr] = {}
        loops = {name: loop for loop in found.loops for name in loop}
        stated = {one.left: one for one in found.given}
        self._plain = {rate(name): name for name in (*model.inputs, *(s.left for s in found.given))}
        for one in found.given:
            if one.left not in loops:
                self._keep({one.left: self._value(one)})
            elif one.left == loops[one.left][0]:
                members = [stated[name] for name in loops[one.left]]
                self._keep(_solved(members, [self._value(member) for member in members]))
        for one in found.rates:
            self._plain.pop(one.left, None)
            value = self._value(one)
            if _short(value):
                self._rates[one.left] = value

    def _value(self, one: Statement) -> sp.Expr:
        return over_common(one.right).xreplace(self._values)

    def _keep(self, values: Mapping[sp.Symbol, sp.Expr]) -> None:
        short = {name: told for name, e in values.items() if _short(told := without_logarithms(e))}
        self._values |= short

    def into_both(self, one: Statement) -> Statement:
        """An equation with names, and rates of what is given, put in on both sides."""
        left = tuple((self.into(factor), self.into(name)) for factor, name in one.left_sum)
        right = without_logarithms(self.into(over_common(one.right)))
        return Statement(self.into(one.left), signed_terms(right), one.node, left)

    def into(self, expr: sp.Expr) -> sp.Expr:
        """An expression with names, and rates of what is given, put in."""
        rates = sorted(expr.free_symbols & self._plain.keys(), key=str)
        put = {name: self._rate(self._plain[name]) for name in rates}
        return expr.xreplace(put).xreplace(self._values)

    def _rate(self, name: sp.Symbol) -> sp.Expr:
        """The rate of what a law or a source gives: by its slopes."""
        if name not in self._values:
            return rate(name)
        value = self._values[name]
        moving = sorted(value.free_symbols & self._moved(value.free_symbols), key=str)
        terms = [slope_of(value, part) * self._rates.get(rate(part), rate(part)) for part in moving]
        if TIME in value.free_symbols:
            terms.append(slope_of(value, TIME))
        return sp.Add(*terms)

    def _moved(self, names: Iterable[sp.Symbol]) -> set[sp.Symbol]:
        """Those of the names that change, the time apart."""
        known = self._states | self._inputs | {*self._plain.values()}
        return {n for n in names if n in known or rate(n) in self._rates} - {TIME}


def _short(value: sp.Expr) -> bool:
    return bool(value.count_ops() <= LONGEST)


def _solved(members: Sequence[Statement], values: Sequence[sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Names that determine one another, where that is linear and has one solution; else none of them."""
    told = {one.left: value for one, value in zip(members, values, strict=True)}
    owners = {one.left: one.node for one in members if one.node is not None}
    try:
        found = solved_loops(told, owners)
    except AlgebraicLoopError:
        return {}
    known = found.told.keys()
    if found.implicit or known != told.keys():
        return {}
    results = dict(found.told)
    while any(value.free_symbols & known for value in results.values()):
        results = {name: tidy(value.xreplace(results)) for name, value in results.items()}
    return results

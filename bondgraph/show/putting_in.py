"""Equations with laws and sources put into one another: what each state's rate comes to."""

from collections.abc import Iterable

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.reduce.motion import slope_of
from bondgraph.show.display import rows_of_terms
from bondgraph.show.statements import Statement, Statements
from bondgraph.show.sums import rate, signed_terms, total

LONGEST = 200
"""What has more operations, put in, is left under its name."""


def closed(model: StateEquations, found: Statements) -> tuple[Statement, ...]:
    """Every state's equation, then every output's, over states, the time and what comes from outside.

    Left under their names are what laws determine together, and what would be long; `Statements` has both.

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
    rows = [Statement(total(tuple(left)), tuple(right)) for left, right in rows_of_terms(model)]
    n = len(model.states)
    return tuple(
        Statement(put.into(one.left), signed_terms(put.into(one.value)), one.node)
        for one in (*rows[:n], *found.rates, *rows[n:])
    )


class _PuttingIn:
    """What stands for names, and for their rates."""

    def __init__(self, model: StateEquations, found: Statements) -> None:
        self._states, self._inputs = {*model.states}, {*model.inputs}
        self._values: dict[sp.Symbol, sp.Expr] = {}
        self._rates: dict[sp.Symbol, sp.Expr] = {}
        together = {name for loop in found.loops for name in loop}
        self._plain = {rate(name): name for name in (*model.inputs, *(s.left for s in found.given))}
        for one in found.given:
            if one.left not in together:
                value = one.value.xreplace(self._values)
                if value.count_ops() <= LONGEST:
                    self._values[one.left] = value
        for one in found.rates:
            self._plain.pop(one.left, None)
            value = one.value.xreplace(self._values)
            if value.count_ops() <= LONGEST:
                self._rates[one.left] = value

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

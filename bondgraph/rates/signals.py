"""Every signal that rates are over, told by other signals: one expression for each name."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.angles import joined
from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.expressions import TIME
from bondgraph.analyse.closures import merged_laws
from bondgraph.analyse.holding import balances_of
from bondgraph.analyse.input_rates import rate_symbol
from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.motion import slope_of
from bondgraph.show.ruled import Turning
from bondgraph.show.signal_nodes import signal_nodes
from bondgraph.show.sums import over_common
from bondgraph.solving.blocks import solved
from bondgraph.solving.steps import Steps


class Signals:
    """What laws give, what they read, and the rates of states, each by name.

    ``told``: a name to its expression over states, inputs, parameters and other names of `told`; rates
    have the names of `rates`. ``owners``: what a law gives to its node.
    """

    def __init__(self, equations: StateEquations, laws: Mapping[Any, object] | None) -> None:
        merged = merged_laws(equations, {} if laws is None else laws)
        ports = {port.element.name: port for port in equations.ports}
        closed = {n: law for n, law in merged.items() if isinstance(law, ExpressionLaw)}
        self._laws = {ports[name].given: law.expression for name, law in closed.items()}
        self.owners: dict[sp.Symbol, Hashable] = {ports[n].given: n for n in closed}
        own = {law.state: ports[n].received for n, law in closed.items() if law.state}
        own |= dict(equations.integrals)
        read = {name for law in closed.values() for name in law.free_symbols}
        self.equations = equations.with_readings({*read, *own.values()})
        self.rates = {state: sp.Dummy(f"d_{state}") for state in (*equations.states, *own)}
        self._slopes: dict[sp.Symbol, sp.Dummy] = {}
        self._steps = Steps()
        self.told: dict[sp.Symbol, sp.Expr] = dict(self._laws)
        known = {*equations.states, *equations.inputs}
        for name, row in self.equations.readings.items():
            if name not in known:
                self.told[name] = self._sum(row.F, row.D, row.K, row.H)
        for node in signal_nodes(self.equations):
            if isinstance(node.ruled, Turning):
                # It stays under its name, as what switches give does.
                self.told.pop(node.ruled.left, None)
        self._tell_rates()
        self.told |= {self.rates[state]: name for state, name in own.items()}
        self.told |= self._steps.parts

    def _tell_rates(self) -> None:
        """x' by ``A x' = J x + B u + E u'``."""
        A, balances = balances_of(self.equations)
        matrix = [{j: joined(entry) for j, entry in row.items()} for row in A]
        right = [self._sum(row.F, row.D, row.K) for row in balances]
        found = solved(matrix, right, self._steps)
        self.told |= {
            self.rates[state]: rate
            for state, rate in zip(self.equations.states, found, strict=True)
        }

    def _sum(self, F: FixedRow, D: FixedRow, K: FixedRow, H: FixedRow | None = None) -> sp.Expr:
        """A row times what stands at its columns, entries with equal denominators over one."""
        states, inputs = self.equations.states, self.equations.inputs
        terms = [(entry, states[j]) for j, entry in F.items()]
        terms += [(entry, inputs[j]) for j, entry in D.items()]
        terms += [(entry, self._input_rate(inputs[j])) for j, entry in K.items()]
        terms += [(entry, self.rates[states[j]]) for j, entry in (H or {}).items()]
        return over_common((joined(entry), name) for entry, name in terms)

    def _input_rate(self, name: sp.Symbol) -> sp.Expr:
        """``d_u`` of an open input; a known law's own slope in time and along what it reads."""
        if name not in self._laws:
            return rate_symbol(name)
        if name not in self._slopes:
            self._slopes[name] = sp.Dummy(f"d_{name}")
            law = self._laws[name]
            inner = sorted(law.free_symbols & set(self.equations.inputs), key=str)
            slopes = [slope_of(law, other) * self._input_rate(other) for other in inner]
            slopes += [slope_of(law, TIME)] if TIME in law.free_symbols else []
            self.told[self._slopes[name]] = sp.Add(*slopes)
        return self._slopes[name]

"""Rates of inputs: symbols of open ones, what known laws tell of theirs over the rates of what they read."""

from collections.abc import Collection, Hashable

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.record import Reading, ReadingSum


def rate_symbol(name: sp.Symbol) -> sp.Symbol:
    """What the rate of an open input is called.

    >>> rate_symbol(sp.Symbol("tau"))
    d_tau
    """
    return sp.Symbol(f"d_{name}")


class InputRates:
    """Rates of inputs over those of states and of open inputs; laws of the nodes ``free`` do not count.

    ``equations``: those given, which also know what laws read.
    """

    def __init__(self, equations: StateEquations, free: Collection[Hashable]) -> None:
        self._nodes = {p.given: p.element.name for p in equations.ports}
        self._laws = {
            port.given: equations.laws[port.element.name]
            for port in equations.ports
            if port.element.name in equations.laws and port.element.name not in free
        }
        read = {name for law in self._laws.values() for name in law.free_symbols}
        self.equations = equations.with_readings(read)
        own = {law.state for law in self._laws.values() if isinstance(law, ExpressionLaw)}
        # Other names that laws read are constant, as for `explicit`.
        self._moving = {*equations.signals, *equations.states, *equations.integrals, *own}

    def symbol(self, name: sp.Symbol) -> sp.Expr:
        """The rate of an input by the time alone: ``d_u`` of an open one, of a law its slope in time."""
        law = self._laws.get(name)
        if law is None:
            return rate_symbol(name)
        if not isinstance(law, ExpressionLaw) or TIME not in law.free_symbols:
            return sp.Integer(0)
        return slope_of(law.expression, TIME)

    def opened(self, row: Reading) -> Reading:
        """Rates of what laws give replaced by those of what they read; what time alone adds stays.

        Raises `DependentSourceError` for the rate of dry friction, of laws in a circle, and of one that reads
        rates or states of laws.
        """
        total = ReadingSum(Reading(row.F, row.D, row.H, {}))
        for j, entry in row.K.items():
            total.add(self._rate(self.equations.inputs[j], ()), entry)
        return total.whole()

    def _rate(self, name: sp.Symbol, above: tuple[sp.Symbol, ...]) -> Reading:
        """The rate of a signal that a law reads, or of an input."""
        states, inputs = self.equations.states, self.equations.inputs
        if name in states:
            return Reading({}, {}, {states.index(name): sp.Integer(1)}, {})
        if name in self._laws:
            return self._rate_of_law(name, above)
        if name in inputs:
            return Reading({}, {}, {}, {inputs.index(name): sp.Integer(1)})
        row = self.equations.readings.get(name)
        if row is None or row.H or row.K or self.equations.varying:
            raise self._refusal(above[-1])
        total = ReadingSum(Reading({}, {}, row.F, {}))
        for j, entry in row.D.items():
            total.add(self._rate(inputs[j], above), entry)
        return total.whole()

    def _rate_of_law(self, name: sp.Symbol, above: tuple[sp.Symbol, ...]) -> Reading:
        law = self._laws[name]
        if name in above or not isinstance(law, ExpressionLaw):
            raise self._refusal(name)
        total = ReadingSum()
        if TIME in law.free_symbols:
            place = self.equations.inputs.index(name)
            total.add(Reading({}, {}, {}, {place: sp.Integer(1)}), sp.Integer(1))
        for read in sorted(law.free_symbols & self._moving, key=str):
            total.add(self._rate(read, (*above, name)), slope_of(law.expression, read))
        return total.whole()

    def _refusal(self, name: sp.Symbol) -> DependentSourceError:
        return DependentSourceError(
            f"what holds depends on the rate of what the law at {self._nodes[name]!r} gives, which cannot be "
            "told over rates of states and inputs; put a storage or a resistance between, or simulate it"
        )

"""Relative degrees: which derivative of a sum of states an input moves first."""

from collections.abc import Collection, Hashable, Mapping

import sympy as sp

from bondgraph.algebra.exact import rows_of
from bondgraph.algebra.residues import is_zero
from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import ExpressionLaw, Law
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading, ReadingSum


class Degrees:
    """Rates of what constant factors make up of states and integrals.

    ``still``: names of constants. ``laws``: what closes ports, by node; those ``abrupt`` give what may jump.
    """

    def __init__(
        self,
        equations: StateEquations,
        still: Collection[str],
        laws: Mapping[Hashable, Law],
        abrupt: Collection[Hashable],
    ) -> None:
        self._equations, self._still = equations, still
        self._laws = {
            equations.inputs.index(port.given): None if port.element.name in abrupt else law
            for port in equations.ports
            if (law := laws.get(port.element.name)) is not None or port.element.kind.switches
        }
        self._A = rows_of(equations.A)
        sides = (rows_of(matrix) for matrix in (equations.J, equations.B, equations.E))
        self._balances = [Reading(J, B, {}, E) for J, B, E in zip(*sides, strict=True)]

    def rate(self, row: Reading, rest: sp.Expr) -> Reading | None:
        """How fast ``row + rest`` changes, as a row over states and inputs that never jump of themselves.

        ``rest``: what of it is not in the row, as integrals are not. None where it is no such row: where a
        factor moves, inputs are part of it, or friction, switches or laws that jump move it at once.
        """
        equations = self._equations
        if row.D or row.H or row.K:
            return None
        total = ReadingSum(self._resolved(row))
        for name in sorted(rest.free_symbols & equations.integrals.keys(), key=str):
            slope = slope_of(rest, name)
            reading = equations.readings.get(equations.integrals[name])
            if reading is None:
                return None
            total.add(reading, slope)
            rest = sp.expand(rest - slope * name)
        found = self._opened(total.whole())
        if found.H or found.K or not self._constant([rest, *row.F.values()]):
            return None
        if not self._constant([*found.F.values(), *found.D.values()]):
            return None
        return found if all(map(self._is_smooth, found.D)) else None

    def moves(self, row: Reading, columns: Mapping[int, sp.Expr]) -> bool:
        """Whether an input with these columns of B moves the rate of what `rate` has found."""
        parts = [(self._resolved(row), sp.Integer(1))]
        for j, entry in row.D.items():
            for name, slope in self._slopes(j).items():
                read = self._read(name)
                rate = self._rate_of(name) if read is None else self._resolved(read)
                parts.append((rate, entry * slope))
        terms = (
            factor * part.D.get(j, sp.Integer(0)) * by
            for part, by in parts
            for j, factor in columns.items()
        )
        return not is_zero(sp.Add(*terms))

    def _rate_of(self, integral: sp.Symbol) -> Reading:
        equations = self._equations
        return equations.readings[equations.integrals[integral]]

    def _slopes(self, column: int) -> Mapping[sp.Symbol, sp.Expr]:
        """How what a law gives hangs on states, integrals and readings; nothing of an open input."""
        law, equations = self._laws.get(column), self._equations
        if not isinstance(law, ExpressionLaw):
            return {}
        names = law.free_symbols & {*equations.states, *equations.integrals, *equations.readings}
        return {n: slope_of(law.expression, n) for n in sorted(names, key=str)}

    def _read(self, name: sp.Symbol) -> Reading | None:
        """A signal over states and inputs; None of an integral."""
        states = self._equations.states
        if name in states:
            return Reading({states.index(name): sp.Integer(1)}, {}, {}, {})
        return self._equations.readings.get(name)

    def _opened(self, row: Reading) -> Reading:
        """What laws give that are sums of signals replaced by these."""
        total = ReadingSum(row)
        for j, entry in row.D.items():
            slopes, law = self._slopes(j), self._laws.get(j)
            read = {name: own for name in slopes if (own := self._read(name)) is not None}
            if not isinstance(law, ExpressionLaw) or len(read) < max(len(slopes), 1):
                continue
            rest = sp.expand(law.expression - sp.Add(*(n * by for n, by in slopes.items())))
            if rest != 0 or not self._constant(slopes.values()):
                continue
            del total.D[j]
            for name, by in slopes.items():
                total.add(read[name], entry * by)
        return total.whole()

    def _is_smooth(self, column: int) -> bool:
        """Whether an input is open, or given by a law of what states and open inputs tell alone."""
        if column not in self._laws:
            return True
        law, equations = self._laws[column], self._equations
        if not isinstance(law, ExpressionLaw) or law.free_symbols & {*equations.inputs}:
            return False
        read = [equations.readings[n] for n in law.free_symbols & equations.readings.keys()]
        return not any(row.H or row.K or row.D.keys() & self._laws.keys() for row in read)

    def _resolved(self, row: Reading) -> Reading:
        """``F x'``."""
        return resolved(self._A, self._balances, Reading({}, {}, row.F, {}))

    def _constant(self, factors: Collection[sp.Expr]) -> bool:
        return all(name.name in self._still for f in factors for name in f.free_symbols)

"""What laws give over states, known inputs and the time alone: what they read of one another is put in."""

from collections.abc import Iterable

import sympy as sp

from bondgraph.nodes.laws import ExpressionLaw
from codegen.program.closing import Closing
from codegen.program.slopes import NoSlopeError, slope


class Totals:
    """The laws of a model that hang on states and on nothing that friction answers at once."""

    def __init__(self, closing: Closing) -> None:
        self._closing, self._equations = closing, closing.equations
        after = (name for names, _ in closing.order[closing.early :] for name in names)
        self._late = {*closing.friction, *closing.coupled, *after}
        self._loop = {name: names for names, loop in closing.order if loop for name in names}
        #: The names of laws that read states.
        self.laws = frozenset(name for names, _ in closing.order for name in names)
        self._found: dict[sp.Symbol, sp.Expr] = {}

    def of(self, name: sp.Symbol) -> sp.Expr:
        """What one law gives; `NoSlopeError` where it hangs on more."""
        if name in self._late:
            raise NoSlopeError(f"{name} answers to friction at once")
        if name not in self.laws:
            return name
        if name not in self._found:
            names = self._loop.get(name, (name,))
            rows = {one: self._over(self._closing.laws[one], names) for one in names}
            self._found |= _solved(rows) if name in self._loop else rows
        return self._found[name]

    def _over(self, law: object, unknown: Iterable[sp.Symbol]) -> sp.Expr:
        """A law, those that its loop is solved for left as they are."""
        if not isinstance(law, ExpressionLaw):
            raise NoSlopeError(f"{law} is no expression")
        inside = {name: self._signal(name, unknown) for name in law.expression.free_symbols}
        return law.expression.xreplace(inside)

    def _signal(self, name: sp.Symbol, unknown: Iterable[sp.Symbol]) -> sp.Expr:
        if name in unknown:
            return name
        if name in self._closing.laws:
            return self.of(name)
        row = self._equations.readings.get(name)
        if row is None or name in self._equations.states:
            return name
        if row.H or row.K:
            raise NoSlopeError(f"{name} shows rates")
        terms = [entry * self._equations.states[j] for j, entry in row.F.items()]
        terms += [
            entry * self._signal(self._equations.inputs[j], unknown) for j, entry in row.D.items()
        ]
        return sp.Add(*terms)


def _solved(rows: dict[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Laws that determine one another with constant or known factors, solved."""
    names = list(rows)
    factors = sp.Matrix([[slope(rows[one], name, set()) for name in names] for one in names])
    if factors.free_symbols & set(names):
        raise NoSlopeError(f"{', '.join(map(str, names))} are found by a search")
    rest = sp.Matrix([row.xreplace(dict.fromkeys(names, sp.Integer(0))) for row in rows.values()])
    found = (sp.eye(len(names)) - factors).LUsolve(rest)
    return dict(zip(names, found, strict=True))

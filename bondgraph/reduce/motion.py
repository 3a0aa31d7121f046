"""Values that move: which names change in time, and what a product of a value and a variable gains by it."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import FixedRow, add_scaled, fixed
from bondgraph.algebra.expressions import TIME
from bondgraph.errors import AlgebraicLoopError, DependentSourceError
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import JunctionStructure, Port


@dataclass(frozen=True)
class Motion:
    """The names that change in time, each with its rate over states, inputs and their rates.

    ``states``, ``inputs``: the symbols behind the columns. The rate of the time is 1.
    """

    states: tuple[sp.Symbol, ...]
    inputs: tuple[sp.Symbol, ...]
    rates: Mapping[sp.Symbol, Reading]

    def add_rate(self, target: ReadingSum, value: sp.Expr, variable: sp.Symbol) -> None:
        """Add ``value' variable`` to a sum: what ``(value variable)'`` has over ``value variable'``.

        The part of ``value'`` in states and inputs goes with the variable's own column, as it does where
        an angle's rate is known; its part in x' goes to H, and so into A.
        """
        for name in sorted(value.free_symbols & {*self.rates, TIME}, key=str):
            slope = slope_of(value, name)
            if name == TIME:
                self._add(target, variable, slope)
                continue
            rate = self.rates[name]
            known = [entry * self.states[j] for j, entry in rate.F.items()]
            known += [entry * self.inputs[j] for j, entry in rate.D.items()]
            if known:
                self._add(target, variable, slope * sp.Add(*known))
            add_scaled(target.H, rate.H, slope * variable)
            add_scaled(target.K, rate.K, slope * variable)

    def add_total_rate(self, target: ReadingSum, value: sp.Expr, where: Hashable) -> None:
        """Add ``value'`` to a sum, the rate of an expression over moving names."""
        if TIME in value.free_symbols:
            raise DependentSourceError(
                f"the storage {where!r} has derivative causality and follows the time itself; give the "
                "time's function as an input"
            )
        for name in sorted(value.free_symbols & self.rates.keys(), key=str):
            target.add(self.rates[name], slope_of(value, name))

    def _add(self, target: ReadingSum, variable: sp.Symbol, factor: sp.Expr) -> None:
        if variable in self.states:
            add_scaled(target.F, {self.states.index(variable): sp.Integer(1)}, factor)
        else:
            add_scaled(target.D, {self.inputs.index(variable): sp.Integer(1)}, factor)


def slope_of(value: sp.Expr, name: sp.Symbol) -> sp.Expr:
    """The derivative by one name, all names being real."""
    real = {symbol: sp.Dummy(symbol.name, real=True) for symbol in value.free_symbols}
    plain = {dummy: symbol for symbol, dummy in real.items()}
    return sp.diff(value.xreplace(real), real[name]).xreplace(plain)


def moving_names(structure: JunctionStructure) -> set[sp.Symbol]:
    """The signals that values of the graph use, and the time if one does."""
    used: set[sp.Symbol] = set()
    for element in structure.elements.values():
        if element.value is not None:
            used |= element.value.free_symbols
        for _, entry in element.row:
            used |= entry.free_symbols
    named = {TIME, *structure.states_of_laws, *structure.opened}
    for port in structure.ports:
        named |= {port.given, port.received}
    for element in structure.elements.values():
        named |= {n for n in (element.effort, element.flow, element.integral) if n is not None}
    return used & named


def settled(
    structure: JunctionStructure, names: Iterable[sp.Symbol], base: set[sp.Symbol],
    express: Callable[[sp.Symbol], sp.Expr],
) -> JunctionStructure:  # fmt: skip
    """The structure with every value over base names: states, integrals, inputs and the time.

    ``express``: a signal over states and inputs, with moving values as they come.

    Raises `AlgebraicLoopError` for a value that depends on a signal that depends on it.
    """
    found: dict[sp.Symbol, sp.Expr] = {}

    def over_base(name: sp.Symbol, above: tuple[sp.Symbol, ...]) -> sp.Expr:
        if name in above:
            raise AlgebraicLoopError(
                f"a value depends on {name}, which depends on that value at once; put a storage between, "
                "or use a state"
            )
        if name not in found:
            expr = express(name)
            inner = expr.free_symbols & set(names) - base
            found[name] = expr.xreplace({n: over_base(n, (*above, name)) for n in inner})
        return found[name]

    exact = {name: over_base(name, ()) for name in sorted(set(names) - base, key=str)}
    return replaced(structure, exact) if exact else structure


def replaced(structure: JunctionStructure, exact: Mapping[sp.Symbol, sp.Expr]) -> JunctionStructure:
    """The structure with expressions for names in all its values: of ports, of fields, in every row."""

    def row(entries: FixedRow) -> FixedRow:
        return fixed({j: entry.xreplace(exact) for j, entry in entries.items()})

    def port(one: Port) -> Port:
        value = one.element.value
        if value is None:
            return one
        coupled = tuple((name, entry.xreplace(exact)) for name, entry in one.element.row)
        return replace(one, element=replace(one.element, value=value.xreplace(exact), row=coupled))

    return replace(
        structure,
        ports=tuple(map(port, structure.ports)),
        rows=tuple(map(row, structure.rows)),
        common=MappingProxyType({name: row(r) for name, r in structure.common.items()}),
        bonds=MappingProxyType({b: (row(e), row(f)) for b, (e, f) in structure.bonds.items()}),
    )

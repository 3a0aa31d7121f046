"""The instant of an operating point: rates of states and what holds ports, as its equations tell them."""

from collections.abc import Collection, Hashable, Mapping, Sequence
from functools import cached_property

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, SingularError, solve
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.residues import is_zero
from bondgraph.analyse.closed_rows import ClosedRows
from bondgraph.analyse.constrained import echelon
from bondgraph.analyse.holding import balances_of
from bondgraph.analyse.moving_hold import MovingHold, moving_hold
from bondgraph.analyse.slopes import as_expression
from bondgraph.analyse.unknowns import Unknown, Unknowns, still
from bondgraph.errors import DependentSourceError, SignalError, SingularStorageError
from bondgraph.nodes.laws import DryFriction, Law, slides
from bondgraph.reduce.rates import reached
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port


class Instant:
    """The equations at the operating point; only those are looked at that what is asked for needs.

    ``laws``: every closed port's; ``held``: the ports that are held; ``rates``: those of open inputs.
    """

    def __init__(
        self, system: ClosedRows, held: Sequence[Port], laws: Mapping[Hashable, Law],
        rates: Mapping[sp.Symbol, sp.Expr], unknowns: Unknowns,
    ) -> None:  # fmt: skip
        self._system, self._held, self._laws, self._rates = system, held, laws, rates
        self._unknowns, self._equations = unknowns, system.equations
        self._ports = {port.given: port for port in self._equations.ports}
        self._done: set[int] = set()
        #: Efforts that hold, where they are asked for, and those of them that others share.
        self._efforts: list[Unknown] = []
        self._shared: list[Unknown] = []

    @cached_property
    def hold(self) -> MovingHold:
        """What is held, as it moves along."""
        return moving_hold(self._system, self._held, self._laws, self._unknowns)

    @cached_property
    def _balances(self) -> tuple[list[Row], list[Reading]]:
        """A at the point, and ``J x + B u + E u'`` by rows."""
        A, rows = balances_of(self._equations)
        return [self._there(row) for row in A], rows

    def _there(self, row: FixedRow) -> Row:
        found = {j: self._system.here.there(entry) for j, entry in row.items()}
        return {j: value for j, value in found.items() if value != 0}

    def solved(self, wanted: Collection[Unknown]) -> dict[sp.Expr, sp.Expr]:
        """What stands for these in rows, and their values."""
        pending = sorted(wanted, key=lambda one: one.dummy_index)
        lines, known = list[sp.Expr](), dict[Unknown, int]()
        while pending:
            one = pending.pop()
            if one in known:
                continue
            known[one] = len(known)
            for line in self._lines(one):
                lines.append(line)
                pending += sorted(line.atoms(Unknown), key=lambda other: other.dummy_index)
            pending += self._efforts
        if any(one in wanted for one in self._shared):
            raise SignalError(
                "at the operating point what single ports hold counts, which hold together and share it as "
                "their limits tell: give what they give a value in at"
            )
        if not known:
            return {}
        inside, right = [_coefficients(line, known) for line in lines], [_rest(x) for x in lines]
        try:
            if len(inside) != len(known):
                raise SingularError
            found = _solved(inside, right)
        except SingularError:
            raise SingularStorageError(
                "at the operating point the rates of states are not determined"
            ) from None
        return {one: found[at].get(0, sp.Integer(0)) for one, at in known.items()}

    def _lines(self, one: Unknown) -> list[sp.Expr]:
        """What vanishes at the point and tells an unknown, beside others."""
        for name, unknown in self._unknowns.rates.items():
            if unknown == one:
                return self._of_rate(name, one)
        name = next(name for name, unknown in self._unknowns.values.items() if unknown == one)
        return self._of_value(name, one)

    def _of_rate(self, name: sp.Symbol, one: Unknown) -> list[sp.Expr]:
        system, states = self._system, self._equations.states
        if name in states:
            A, rows = self._balances
            block = [i for i in reached(A, [states.index(name)]) if i not in self._done]
            self._done |= set(block)
            rates = [self._unknowns.rate(state) for state in states]
            return [
                sp.Add(*(e * rates[j] for j, e in A[i].items())) - self._sum(rows[i].parts)
                for i in block
            ]
        if name in system.rated:
            return [one - self._value(system.rated[name])]
        if name in self._rates or (name in system.columns and name not in self._ports):
            return [one - self._rates.get(name, sp.Integer(0))]
        if name in self._ports:
            law = self._laws.get(self._ports[name].element.name)
            index = self._equations.inputs.index(name)
            if index in system.left and self._ports[name] not in self._held:
                return [one - self._of_time(law)]
            if index in self.hold.held.tied:
                raise DependentSourceError(
                    f"how fast what holds {self._ports[name].element.name!r} changes would be needed at the "
                    "operating point; take one at which nothing moves"
                )
        return [one - self._along(name)]

    def _of_time(self, law: Law | None) -> sp.Expr:
        """The rate of what is given from outside: none but by a law of the time."""
        if law is None or isinstance(law, DryFriction):
            return sp.Integer(0)
        slope = sp.diff(law.expression, TIME)
        return slope.subs({name: self._value(name) for name in slope.free_symbols & {TIME}})

    def _along(self, name: sp.Symbol) -> sp.Expr:
        """The rate of a signal, by the rates of states, inputs and the time."""
        system = self.hold.system
        row = system.put_in(system.signal(name))
        if row.H or row.K:
            raise DependentSourceError(
                f"at the operating point the rate of {name} would be needed, which depends on rates itself; "
                "take a point at which nothing moves"
            )
        rates = [
            (e, self._unknowns.rate(names[j]) if names[j] != TIME else sp.Integer(1))
            for names, part in ((system.states, row.F), (system.columns, row.D))
            for j, e in part.items()
        ]
        return sp.Add(*(still(entry) * rate for entry, rate in rates))

    def _of_value(self, name: sp.Symbol, one: Unknown) -> list[sp.Expr]:
        port = self._ports.get(name)
        if port is None:
            raise SignalError(
                f"at the operating point {name} counts, as states accelerate there: give it a value in at"
            )
        if port not in self._held:
            return [one - self._given(port, self._laws[port.element.name], port.received)]
        return [] if self._efforts else self._holding()

    def _holding(self) -> list[sp.Expr]:
        """What held ports receive stays as it is: at once, or by its rate."""
        hold, lines = self.hold, list[sp.Expr]()
        self._efforts = [self._unknowns.value(port.given) for port in self._held]
        for at in hold.held.direct:
            port = self._held[at]
            law, value = self._laws.get(port.element.name), self._value(port.received)
            lines.append(
                value - (self._given(port, law, port.given) if slides(law, port.gives) else 0)
            )
        system, bound = hold.system, hold.held.bound
        F = sp.Matrix(len(bound), len(system.states), lambda i, j: bound[i].F.get(j, 0))
        rows = echelon(F.T)[1]
        for i in rows:
            parts = ((system.states, bound[i].F), (system.columns, bound[i].D))
            terms = [
                e * self._unknowns.rate(names[j]) for names, part in parts for j, e in part.items()
            ]
            lines.append(sp.Add(hold.by_time[i], *terms))
        return lines + self._redundant(len(rows))

    def _redundant(self, count: int) -> list[sp.Expr]:
        """What holds beside others that do is taken as nothing where only the sum counts."""
        tied, (_, rows) = self.hold.held.tied, self._balances
        there = [self._there(row.D) for row in rows]
        C = sp.Matrix(len(rows), len(tied), lambda i, j: there[i].get(tied[j], 0))
        independent = echelon(C)[1]
        if len(independent) != count:
            ports = ", ".join(repr(port.element.name) for port in self._held)
            raise DependentSourceError(
                f"what is given at {ports} does not hold what is received there; leave one of them free"
            )
        names = [self._equations.inputs[j] for at, j in enumerate(tied) if at not in independent]
        self._shared = [self._unknowns.value(name) for name in names]
        return list(self._shared)

    def _value(self, name: sp.Symbol) -> sp.Expr:
        """A signal at the point, over unknowns if need be."""
        if name == TIME:
            return self._system.point.get(TIME, self._unknowns.value(TIME))
        if name in self._system.point and name not in self._equations.inputs:
            return self._system.point[name]
        row = self._equations.readings.get(name)
        if row is None or name in self._ports:
            return self._system.here.value(name)
        return self._sum(row.parts)

    def _sum(self, parts: Sequence[Mapping[int, sp.Expr]]) -> sp.Expr:
        """A row's value at the point."""
        variables, there = self._system.here.variables, map(self._there, parts)
        return sp.Add(*(
            entry * variable(j)
            for variable, part in zip(variables, there, strict=True) for j, entry in part.items()
        ))  # fmt: skip

    def _given(self, port: Port, law: Law, received: sp.Symbol) -> sp.Expr:
        """What a law gives at the point."""
        system, name = self._system, port.element.name
        point = system.completed(system.point, {*law.free_symbols, received})
        if isinstance(law, DryFriction) and received not in point:
            raise SignalError(
                f"dry friction at {name!r} slips one way or the other: give {received} a number in at"
            )
        expr = as_expression(law, name, received, system.signals, point)
        names = sorted(expr.free_symbols & {*system.signals, TIME}, key=str)
        value = expr.subs({n: point[n] if n in point else self._value(n) for n in names})
        if any(sp.diff(value, one).atoms(Unknown) for one in value.atoms(Unknown)):
            unknown = ", ".join(str(n) for n in names if n not in point)
            raise SignalError(
                f"what the law at {name!r} gives counts at the operating point, as states accelerate there: "
                f"give {port.given} a value in at, or {unknown}"
            )
        return value


def _solved(inside: Sequence[Row], right: Sequence[Row]) -> list[Row]:
    """`solve` with entries as names: multiplied out, sums of many terms would not come to an end."""
    names: dict[sp.Expr, sp.Expr] = {}

    def named(entry: sp.Expr) -> sp.Expr:
        if entry.is_Rational:
            return entry
        sign = -1 if entry.could_extract_minus_sign() else 1
        return sign * names.setdefault(sign * entry, sp.Dummy())

    kept = [
        [{j: e for j, e in row.items() if not is_zero(e)} for row in part]
        for part in (inside, right)
    ]
    found = solve(*([{j: named(e) for j, e in row.items()} for row in part] for part in kept))
    back = {name: entry for entry, name in names.items()}
    if not _vanishes_below(found, back):
        return [{j: e.xreplace(back) for j, e in row.items()} for row in found]
    # Names hide what cancels; polynomials do not, but for what sines and cosines have to one another.
    found = solve(*kept)
    if _vanishes_below(found, {}):
        raise SingularError
    return found


def _vanishes_below(rows: Sequence[Row], back: Mapping[sp.Expr, sp.Expr]) -> bool:
    """Whether something is divided by what vanishes."""
    powers = {part for row in rows for entry in row.values() for part in entry.atoms(sp.Pow)}
    return any(is_zero(part.base.xreplace(back)) for part in powers if part.exp.is_negative)


def _coefficients(line: sp.Expr, known: Mapping[Unknown, int]) -> Row:
    found = {known[one]: sp.diff(line, one) for one in line.atoms(Unknown)}
    return {at: entry for at, entry in found.items() if entry != 0}


def _rest(line: sp.Expr) -> Row:
    rest = -line.xreplace(dict.fromkeys(line.atoms(Unknown), sp.Integer(0)))
    return {0: rest} if rest != 0 else {}

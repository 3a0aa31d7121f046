"""Equations as rows over states and inputs, every closed law replaced by its slopes."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import Row, SingularError, add_scaled, solve
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.residues import residues
from bondgraph.analyse.holding import balances_of, solve_for
from bondgraph.analyse.slopes import Point, slopes, turns_with_slip
from bondgraph.declare.laws import ExpressionLaw, Law, slides
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, SignalError, SingularStorageError
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.readings import depends_on_signals
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port


class ClosedRows:
    """The equations as rows over states, those of laws included, and inputs, laws replaced by slopes.

    ``silent``: ports that give zero.
    """

    def __init__(
        self, equations: StateEquations, closed: Mapping[Hashable, Law],
        outer: tuple[sp.Symbol, ...], point: Point, silent: Iterable[Port] = (),
    ) -> None:  # fmt: skip
        self._equations = equations
        ports = {port.element.name: port for port in equations.ports}
        self._rated = {
            law.state: ports[name].received
            for name, law in closed.items()
            if isinstance(law, ExpressionLaw) and law.state is not None
        } | dict(equations.integrals)
        self._point = point
        self.states = (*equations.states, *self._rated)
        self.columns = (*equations.inputs, *outer)
        signals = self._signals = {*equations.signals, *self._rated, *outer}
        moved: dict[int, Reading] = {}
        owner: dict[int, Hashable] = {}
        for name, law in closed.items():
            if depends_on_signals(law, signals):
                port = ports[name]
                read = set(law.free_symbols)
                read |= {port.received} if turns_with_slip(law, signals) else set()
                slope = slopes(law, name, port.received, signals, self._completed(point, read))
                column = equations.inputs.index(port.given)
                moved[column], owner[column] = self._combined(slope), name
        for port in silent:
            column = equations.inputs.index(port.given)
            moved[column], owner[column] = Reading({}, {}, {}, {}), port.element.name
        self._given = _settled(moved, owner)
        self.left = [j for j in range(len(self.columns)) if j not in moved]

    def _completed(self, point: Point, read: set[sp.Symbol]) -> Point:
        """The point with the signals that a law reads worked out, where states and inputs are known."""
        found = dict(point)
        for name in read - found.keys():
            row = self._equations.readings.get(name)
            if row is None or row.H or row.K:
                continue
            terms = [(self.states[j], e) for j, e in row.F.items()]
            terms += [(self.columns[j], e) for j, e in row.D.items()]
            if all(part in point for part, _ in terms):
                found[name] = sp.Add(*(entry * point[part] for part, entry in terms))
        return found

    def give(self, columns: Sequence[int], rows: Sequence[Reading], ports: Sequence[Port]) -> None:
        """Let ports give, at once, what keeps these rows at zero."""
        size = len(self.states)
        for j, row in zip(columns, solve_for(rows, columns, size, ports), strict=True):
            F = {k: entry for k, entry in row.items() if k < size}
            D = {k - size: entry for k, entry in row.items() if k >= size}
            self._given[j] = Reading(F, D, {}, {})
        # What laws give may hold the efforts that are known now.
        self._given = {j: self.put_in(row) for j, row in self._given.items()}

    def signal(self, name: sp.Symbol) -> Reading:
        """A signal as a row over states, inputs and their rates."""
        one = sp.Integer(1)
        if name in self.states:
            return Reading({self.states.index(name): one}, {}, {}, {})
        if name in self.columns:
            return Reading({}, {self.columns.index(name): one}, {}, {})
        return self._frozen(self._equations.readings[name])

    def received(self, port: Port, laws: Mapping[Hashable, Law]) -> Reading:
        """What a held port receives, less the level of dry friction that gives a flow and slips."""
        law, own = laws.get(port.element.name), self.signal(port.received)
        if not slides(law, port.gives):
            return own
        point = self._completed(self._point, set(law.free_symbols))
        level = slopes(law, port.element.name, port.given, self._signals, point)
        result = ReadingSum(own)
        result.add(self._combined(level), -sp.Integer(1))
        return result.whole()

    def _frozen(self, row: Reading) -> Reading:
        """A row whose coefficients change in time, for deviations from the point, where all rates are 0.

        ``g(xi) v`` deviates by ``g v`` at the point and by the slope of g by each xi, times v there.
        """
        if not self._equations.varying:
            return row
        moving = set(self._equations.varying)
        there = [{j: self._there(entry) for j, entry in part.items()} for part in row.parts]
        kept = ({j: value for j, value in part.items() if value != 0} for part in there)
        result = ReadingSum(Reading(*kept))
        for names, part in ((self.states, row.F), (self.columns, row.D)):
            for j, entry in part.items():
                for name in sorted(entry.free_symbols & moving - {TIME}, key=str):
                    slope = self._there(slope_of(entry, name) * names[j])
                    result.add(self.signal(name), slope)
        return result.whole()

    def _there(self, expr: sp.Expr) -> sp.Expr:
        """An expression at the operating point."""
        moving = {*self._equations.varying, *self.states, *self.columns, TIME}
        missing = sorted((expr.free_symbols & moving) - self._point.keys(), key=str)
        if missing:
            raise SignalError(
                f"values of the graph change with {', '.join(map(str, missing))}: give a value in at"
            )
        return expr.subs({name: self._point[name] for name in expr.free_symbols & moving})

    def _combined(self, slope: Mapping[sp.Symbol, sp.Expr]) -> Reading:
        result = ReadingSum()
        for name, factor in slope.items():
            result.add(self.signal(name), factor)
        return result.whole()

    def put_in(self, row: Reading) -> Reading:
        """A row with what laws give replaced by the signals they read."""
        if any(j in self._given for j in row.K):
            raise DependentSourceError(
                "a law's slope in time would be needed; put a storage between, or let it give the other "
                "variable"
            )
        kept = {j: entry for j, entry in row.D.items() if j not in self._given}
        result = ReadingSum(replace(row, D=kept))
        for j, entry in row.D.items():
            if j in self._given:
                result.add(self._given[j], entry)
        return result.whole()

    def dynamics(self) -> tuple[list[Row], list[Reading]]:
        """A and the right sides of ``A x' =``, the rates of laws' own states below."""
        A, balances = balances_of(self._equations)
        if self._equations.varying:
            A = [{j: self._there(entry) for j, entry in row.items()} for row in A]
        rows = [self.put_in(self._frozen(balance)) for balance in balances]
        for at, received in enumerate(self._rated.values(), start=len(A)):
            A.append({at: sp.Integer(1)})
            rows.append(self.put_in(self.signal(received)))
        if any(row.H for row in rows):
            _take_over(A, rows)
        return A, rows


def _take_over(A: list[Row], rows: Sequence[Reading]) -> None:
    """Move what the right sides hold of x' into A; `SingularStorageError` if that leaves no inverse."""
    for i, row in enumerate(rows):
        add_scaled(A[i], row.H, sp.Integer(-1))
    value = residues()
    exact = ResidueRows({j: v for j, e in row.items() if (v := value(e))} for row in A)
    if not all(exact.pivot(i, jordan=False) for i in range(len(A))):
        raise SingularStorageError(
            "laws that read rates cancel the storages: A is singular; change a law, or a storage's value"
        )
    for i in range(len(A)):
        # Entries in symmetric places, as the solution block by block expects.
        for j in list(A[i]):
            A[j].setdefault(i, sp.Integer(0))


def _settled(moved: Mapping[int, Reading], owner: Mapping[int, Hashable]) -> dict[int, Reading]:
    """What laws give, with what they read of one another at once solved for."""
    coupled = [j for j, row in moved.items() if any(k in moved for k in row.D)]
    coupled += [j for j in moved if j not in coupled and any(j in moved[k].D for k in coupled)]
    if not coupled:
        return dict(moved)
    place = {j: at for at, j in enumerate(coupled)}
    inside: list[Row] = []
    right: list[Row] = []
    for at, j in enumerate(coupled):
        line: Row = {at: sp.Integer(1)}
        add_scaled(line, {place[k]: e for k, e in moved[j].D.items() if k in place}, -sp.Integer(1))
        inside.append(line)
        right.append(_packed(moved[j], place))
    try:
        solved = solve(inside, right)
    except SingularError:
        names = ", ".join(repr(owner[j]) for j in coupled)
        raise SignalError(
            f"the laws at {names} depend on one another at once, and their slopes at the operating point "
            "leave no solution; put a storage between"
        ) from None
    return {**moved, **{j: _unpacked(row) for j, row in zip(coupled, solved, strict=True)}}


def _packed(row: Reading, without: Mapping[int, int]) -> Row:
    """The four parts of a row side by side, column j of part p at 4 j + p."""
    parts = (row.F, {j: e for j, e in row.D.items() if j not in without}, row.H, row.K)
    return {4 * j + at: entry for at, part in enumerate(parts) for j, entry in part.items()}


def _unpacked(row: Row) -> Reading:
    return Reading(*({j // 4: e for j, e in row.items() if j % 4 == at} for at in range(4)))

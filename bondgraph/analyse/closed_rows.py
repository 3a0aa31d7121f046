"""Equations as rows over states and inputs, every closed law replaced by its slopes."""

from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, add_scaled, regular_by_residues, solve
from bondgraph.analyse.deviations import Deviations
from bondgraph.analyse.holding import balances_of, solve_for
from bondgraph.analyse.slopes import Point, slopes, turns_with_slip
from bondgraph.analyse.unknowns import Moment, Unknowns
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, SignalError, SingularStorageError
from bondgraph.nodes.laws import ExpressionLaw, Law, slides
from bondgraph.reduce.readings import depends_on_signals
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port


class ClosedRows:
    """The equations as rows over states, those of laws included, and inputs, laws replaced by slopes.

    ``silent``: ports that give zero; ``held``: those whose inputs hold them; ``seen``: the nodes of the
    laws that rows to be read touch, left out all; ``moment``: the time since the point, for rows that move
    along from there.
    """

    def __init__(
        self, equations: StateEquations, closed: Mapping[Hashable, Law],
        outer: tuple[sp.Symbol, ...], point: Point, unknowns: Unknowns,
        silent: Iterable[Port] = (), held: Iterable[Port] = (),
        seen: Collection[Hashable] | None = None, moment: Moment | None = None,
    ) -> None:  # fmt: skip
        self.equations, self.closed, self.silent = equations, closed, tuple(silent)
        ports = {port.element.name: port for port in equations.ports}
        self.rated = {
            law.state: ports[name].received
            for name, law in closed.items()
            if isinstance(law, ExpressionLaw) and law.state is not None
        } | dict(equations.integrals)
        self.states = (*equations.states, *self.rated)
        self.columns = (*equations.inputs, *outer)
        signals = self.signals = {*equations.signals, *self.rated, *outer}
        given = {port.given for port in (*map(ports.__getitem__, closed), *silent, *held)}
        self.point = point
        holding = {port.given for port in held}
        # What holds is told by the point as a whole, or by the equations.
        there = (
            point
            if holding <= point.keys()
            else {n: v for n, v in point.items() if n not in holding}
        )
        self.here = Deviations(equations, self.states, self.columns, given, there, unknowns, moment)
        moved: dict[int, Reading] = {}
        owner: dict[int, Hashable] = {}
        for name, law in closed.items():
            if (seen is None or name in seen) and depends_on_signals(law, signals):
                port = ports[name]
                read = set(law.free_symbols)
                read |= {port.received} if turns_with_slip(law, signals) else set()
                slope = slopes(law, name, port.received, signals, self.completed(point, read))
                column = equations.inputs.index(port.given)
                moved[column], owner[column] = self._combined(slope), name
        for port in self.silent:
            column = equations.inputs.index(port.given)
            moved[column], owner[column] = Reading({}, {}, {}, {}), port.element.name
        self._given = _settled(moved, owner)
        self.left = [j for j in range(len(self.columns)) if j not in moved]

    def completed(self, point: Point, read: set[sp.Symbol]) -> Point:
        """The point with the signals that a law reads worked out, where states and inputs are known."""
        found = dict(point)
        for name in read - found.keys():
            row = self.equations.readings.get(name)
            if row is None or row.H or row.K:
                continue
            terms = [(self.states[j], e) for j, e in row.F.items()]
            terms += [(self.columns[j], e) for j, e in row.D.items()]
            used = set().union(*(entry.free_symbols for _, entry in terms))
            used &= {*self.equations.varying}
            if used.union(part for part, _ in terms) <= point.keys():
                found[name] = sp.Add(*(self.here.there(e) * point[part] for part, e in terms))
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
        return self.here.row(self.equations.readings[name], self.signal)

    def received(self, port: Port, laws: Mapping[Hashable, Law]) -> Reading:
        """What a held port receives, less the level of dry friction that gives a flow and slips."""
        law, own = laws.get(port.element.name), self.signal(port.received)
        if not slides(law, port.gives):
            return own
        point = self.completed(self.point, set(law.free_symbols))
        level = slopes(law, port.element.name, port.given, self.signals, point)
        result = ReadingSum(own)
        result.add(self._combined(level), -sp.Integer(1))
        return result.whole()

    def _combined(self, slope: Mapping[sp.Symbol, sp.Expr]) -> Reading:
        result = ReadingSum()
        for name, factor in slope.items():
            result.add(self.signal(name), factor)
        return result.whole()

    def value(self, expression: sp.Expr, node: Hashable) -> Reading:
        """An expression that a node reads as a row over states and inputs, by its slopes."""
        law = ExpressionLaw(expression)
        point = self.completed(self.point, set(law.free_symbols))
        return self.put_in(
            self._combined(slopes(law, node, sp.Dummy("nothing"), self.signals, point))
        )

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
        whole = [
            replace(row, H={j: -entry for j, entry in inertia.items()})
            for inertia, row in zip(*balances_of(self.equations), strict=True)
        ]
        whole = [self.here.row(row, self.signal) for row in whole]
        A = [{j: -entry for j, entry in row.H.items()} for row in whole]
        rows = [self.put_in(replace(row, H={})) for row in whole]
        for at, received in enumerate(self.rated.values(), start=len(A)):
            A.append({at: sp.Integer(1)})
            rows.append(self.put_in(self.signal(received)))
        if any(row.H for row in rows):
            _take_over(A, rows)
        return A, rows


def _take_over(A: list[Row], rows: Sequence[Reading]) -> None:
    """Move what the right sides hold of x' into A; `SingularStorageError` if that leaves no inverse."""
    for i, row in enumerate(rows):
        add_scaled(A[i], row.H, sp.Integer(-1))
    if not regular_by_residues(A):
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

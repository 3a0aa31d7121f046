"""`linearize`: equations with laws closed at an operating point, symbolic, for small deviations."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from bondgraph.closures import merged_laws
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, SignalError, SingularStorageError, StructureError
from bondgraph.exact import Row, SingularError, add_scaled, rows_of, solve
from bondgraph.expressions import normal
from bondgraph.holding import balances_of, folded, multiplied, stuck_ports, without_slips
from bondgraph.laws import ExpressionLaw, Law
from bondgraph.rates import resolved
from bondgraph.readings import depends_on_signals
from bondgraph.reduction import Reading
from bondgraph.slopes import operating_point, slopes
from bondgraph.tidy import tidy_matrices

if TYPE_CHECKING:
    from bondgraph.response import StateSpace

LARGEST_SYMBOLIC = 8
"""Transfer functions of more states are too long to be read, or to be found in reasonable time."""


@dataclass(frozen=True)
class LinearModel:
    """Small deviations from an operating point; the matrices are immutable, sparse, symbolic.

    A x' = J x + B u + E u'
       y = F x + D u + G u'
    """

    states: tuple[sp.Symbol, ...]
    inputs: tuple[sp.Symbol, ...]
    outputs: tuple[sp.Symbol, ...]
    A: sp.ImmutableSparseMatrix
    J: sp.ImmutableSparseMatrix
    B: sp.ImmutableSparseMatrix
    E: sp.ImmutableSparseMatrix
    F: sp.ImmutableSparseMatrix
    D: sp.ImmutableSparseMatrix
    G: sp.ImmutableSparseMatrix

    @property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The names that the matrices need numbers for, sorted."""
        matrices = (self.A, self.J, self.B, self.E, self.F, self.D, self.G)
        return tuple(sorted(set().union(*(m.free_symbols for m in matrices)), key=str))

    def transfer_function(self, s: object = "s") -> sp.ImmutableMatrix:
        """Outputs over inputs, ``F (s A - J)^-1 (B + s E) + D + s G``, for up to 8 states.

        Raises `StructureError` above that; `numeric` has no such bound.
        """
        n = len(self.states)
        if n > LARGEST_SYMBOLIC:
            raise StructureError(
                f"a transfer function of {n} states is no expression for people; there is "
                f"numeric(parameters).transfer(s) (symbolic up to {LARGEST_SYMBOLIC} states)"
            )
        at = sp.Symbol(s) if isinstance(s, str) else sp.sympify(s)
        # An own symbol: a parameter may be called s as well.
        rate = sp.Dummy("s")
        pencil, driven = rows_of(rate * self.A - self.J), rows_of(self.B + rate * self.E)
        try:
            states = solve(pencil, driven) if n else []
        except SingularError:
            raise SingularStorageError("s A - J is singular whatever s is") from None
        X = sp.Matrix(n, len(self.inputs), lambda i, j: states[i].get(j, 0))
        found = self.F * X + self.D + rate * self.G
        return sp.ImmutableMatrix(found.applyfunc(lambda g: sp.factor(g).subs(rate, at)))

    def numeric(self, parameters: Mapping[str, object]) -> "StateSpace":
        """The same with numbers: poles, modes, frequency responses, objects for scipy and control.

        Raises `ParameterError` for names without a number, and numbers at which A is singular.
        """
        # numpy is loaded only when numbers are asked for.
        from bondgraph.response import state_space

        names = (self.states, self.inputs, self.outputs)
        matrices = (self.A, self.J, self.B, self.E, self.F, self.D, self.G)
        return state_space(names, matrices, parameters)


def linearize(
    equations: StateEquations,
    at: Mapping[Any, object] | None = None,
    laws: Mapping[Any, object] | None = None,
    inputs: Iterable[str] = (),
    stuck: Iterable[Hashable] = (),
    outputs: Iterable[str] | None = None,
) -> LinearModel:
    """The equations for small deviations, every law replaced by its slopes.

    ``at``: signal to value at the operating point, as far as slopes depend on it. ``laws``: as for a
    simulator, over those declared. ``inputs``: names in laws that become inputs; what else no signal
    has is a parameter. A law that reads no signal and no such input leaves its port an input. ``stuck``:
    nodes of ports that stick; each slip takes a state with it, of the storage of lowest priority, earlier
    ones first. ``outputs``: names of signals, else the equations' outputs.

    Raises `SignalError` where a slope needs a value that ``at`` lacks or the law has a corner there.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("pump", "p"), bg.One("pipe"), bg.I("fluid", "I_f", flow="q"),
    ...                   bg.R("orifice", law="c*q*abs(q)")])
    >>> g.add_edges_from([("pump", "pipe"), ("pipe", "fluid"), ("pipe", "orifice")])
    >>> linearize(bg.derive(g), at={"q": 3}).J
    Matrix([[-6*c]])
    """
    closed = merged_laws(equations, {} if laws is None else laws)
    held = stuck_ports(equations, stuck)
    closed = {
        name: law for name, law in closed.items() if name not in {p.element.name for p in held}
    }
    shown = _shown(equations, outputs)
    read = {name for law in closed.values() for name in law.free_symbols}
    equations = equations.with_readings({*read, *shown})
    outer = _outer(equations, closed, inputs)
    system = _System(equations, closed, outer, operating_point(at))
    A, balances = system.dynamics()
    ys = [system.put_in(system.signal(name)) for name in shown]
    slips = [system.put_in(system.signal(port.received)) for port in held]
    gone = {equations.inputs.index(port.given) for port in held}
    model = _Rows(system.states, A, balances, ys)
    if held:
        model = _locked(model, slips, gone, _least_first(equations, len(system.states)))
    ys = [resolved(model.A, model.balances, y) for y in model.ys]
    left = [j for j in system.left if j not in gone]
    return _model(model, ys, left, system.columns, tuple(shown))


@dataclass(frozen=True)
class _Rows:
    """A by rows, the right sides of ``A x' =`` and the outputs."""

    states: tuple[sp.Symbol, ...]
    A: list[Row]
    balances: list[Reading]
    ys: list[Reading]


class _System:
    """The equations as rows over states, those of laws included, and inputs, laws replaced by slopes."""

    def __init__(
        self, equations: StateEquations, closed: Mapping[Hashable, Law],
        outer: tuple[sp.Symbol, ...], point: Mapping[sp.Symbol, sp.Expr],
    ) -> None:  # fmt: skip
        self._equations = equations
        ports = {port.element.name: port for port in equations.ports}
        self._rated = {
            law.state: ports[name].received
            for name, law in closed.items()
            if isinstance(law, ExpressionLaw) and law.state is not None
        }
        self.states = (*equations.states, *self._rated)
        self.columns = (*equations.inputs, *outer)
        signals = {*equations.signals, *self._rated, *outer}
        moved: dict[int, Reading] = {}
        for name, law in closed.items():
            if depends_on_signals(law, signals):
                port = ports[name]
                slope = slopes(law, name, port.received, signals, point)
                moved[equations.inputs.index(port.given)] = self._combined(slope)
        self._given = _settled(moved, list(closed))
        self.left = [j for j in range(len(self.columns)) if j not in moved]

    def signal(self, name: sp.Symbol) -> Reading:
        """A signal as a row over states, inputs and their rates."""
        one = sp.Integer(1)
        if name in self.states:
            return Reading({self.states.index(name): one}, {}, {}, {})
        if name in self.columns:
            return Reading({}, {self.columns.index(name): one}, {}, {})
        return self._equations.readings[name]

    def _combined(self, slope: Mapping[sp.Symbol, sp.Expr]) -> Reading:
        result = Reading({}, {}, {}, {})
        for name, factor in slope.items():
            _add(result, self.signal(name), factor)
        return result

    def put_in(self, row: Reading) -> Reading:
        """A row with what laws give replaced by the signals they read."""
        if any(j in self._given for j in row.K):
            raise DependentSourceError(
                "a law's slope in time would be needed; put a storage between, or let it give the other "
                "variable"
            )
        kept = {j: entry for j, entry in row.D.items() if j not in self._given}
        result = Reading(dict(row.F), kept, dict(row.H), dict(row.K))
        for j, entry in row.D.items():
            if j in self._given:
                _add(result, self._given[j], entry)
        return result

    def dynamics(self) -> tuple[list[Row], list[Reading]]:
        """A and the right sides of ``A x' =``, the rates of laws' own states below."""
        A, balances = balances_of(self._equations)
        rows = [self.put_in(balance) for balance in balances]
        for at, received in enumerate(self._rated.values(), start=len(A)):
            A.append({at: sp.Integer(1)})
            rows.append(self.put_in(self.signal(received)))
        for i, row in enumerate(rows):
            add_scaled(A[i], row.H, sp.Integer(-1))
            for j in row.H:
                # Entries in symmetric places, as the solution block by block expects.
                A[j].setdefault(i, sp.Integer(0))
                A[i].setdefault(j, sp.Integer(0))
        return A, rows


def _add(target: Reading, row: Reading, factor: sp.Expr) -> None:
    for mine, theirs in (
        (target.F, row.F),
        (target.D, row.D),
        (target.H, row.H),
        (target.K, row.K),
    ):
        add_scaled(mine, theirs, factor)


def _settled(moved: Mapping[int, Reading], names: Sequence[Hashable]) -> dict[int, Reading]:
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
        raise SignalError(
            f"the laws at {', '.join(map(repr, names))} depend on one another at once, and their slopes "
            "at the operating point leave no solution; put a storage between"
        ) from None
    return {**moved, **{j: _unpacked(row) for j, row in zip(coupled, solved, strict=True)}}


def _packed(row: Reading, without: Mapping[int, int]) -> Row:
    """The four parts of a row side by side, column j of part p at 4 j + p."""
    parts = (row.F, {j: e for j, e in row.D.items() if j not in without}, row.H, row.K)
    return {4 * j + at: entry for at, part in enumerate(parts) for j, entry in part.items()}


def _unpacked(row: Row) -> Reading:
    return Reading(*({j // 4: e for j, e in row.items() if j % 4 == at} for at in range(4)))


def _least_first(equations: StateEquations, size: int) -> list[int]:
    """The states in the order in which they become dependent: lowest priority first."""
    ports = [equations.reduction.structure.ports[port] for port in equations.reduction.states]
    priority = [port.element.priority for port in ports] + [0.0] * (size - len(ports))
    return sorted(range(size), key=lambda j: (priority[j], j))


def _locked(model: _Rows, slips: Sequence[Reading], gone: set[int], order: Sequence[int]) -> _Rows:
    """The model with slips held at zero: ``x = T x_r``, and the balances along what is left free."""
    if any(slip.D or slip.H or slip.K for slip in slips):
        raise DependentSourceError(
            "a port beside a resistance or a driven storage sticks; linearize holds ports between "
            "storages only"
        )
    reduced = without_slips([slip.F for slip in slips], order)
    T, kept = reduced.T, reduced.kept
    A = [multiplied(row, T) for row in folded(model.A, T, len(kept))]
    parts = [folded([getattr(row, part) for row in model.balances], T, len(kept)) for part in "FDK"]
    if any(j in gone for row in parts[1] for j in row):
        raise DependentSourceError("the efforts that hold a port do work elsewhere in the graph")
    balances = [Reading(multiplied(F, T), D, {}, K) for F, D, K in zip(*parts, strict=True)]
    ys = [Reading(multiplied(y.F, T), y.D, multiplied(y.H, T), y.K) for y in model.ys]
    if any(j in gone for y in ys for j in y.D):
        raise SignalError("an output shows what holds a sticking port; see holding_efforts")
    return _Rows(tuple(model.states[j] for j in kept), A, balances, ys)


def _outer(
    equations: StateEquations, closed: Mapping[Hashable, Law], inputs: Iterable[str]
) -> tuple[sp.Symbol, ...]:
    """The names in laws that are to be inputs; `SignalError` for one that no law has."""
    asked = {sp.Symbol(str(normal(name))) for name in inputs} - set(equations.inputs)
    read = {name for law in closed.values() for name in law.free_symbols}
    for name in sorted(asked, key=str):
        if name not in read or name in equations.signals:
            raise SignalError(f"no law reads an input {name}")
    return tuple(sorted(asked, key=str))


def _shown(equations: StateEquations, outputs: Iterable[str] | None) -> list[sp.Symbol]:
    if outputs is None:
        return list(equations.outputs)
    if isinstance(outputs, str):
        raise SignalError(f"outputs must be a list of signals, not {outputs!r}")
    shown = [sp.Symbol(str(normal(str(name)))) for name in outputs]
    for name in shown:
        if name not in equations.signals:
            known = ", ".join(sorted(map(str, equations.signals)))
            raise SignalError(f"no signal is called {name}; there are {known}")
    return shown


def _model(
    model: _Rows, ys: Sequence[Reading], left: Sequence[int], columns: Sequence[sp.Symbol],
    outputs: tuple[sp.Symbol, ...],
) -> LinearModel:  # fmt: skip
    """Rows as matrices over the inputs that are left."""
    place = {j: at for at, j in enumerate(left)}

    def over_inputs(rows: Sequence[Row]) -> tuple[list[Row], int]:
        return [{place[j]: entry for j, entry in row.items()} for row in rows], len(left)

    n = len(model.states)
    parts = [
        (model.A, n), ([row.F for row in model.balances], n),
        over_inputs([row.D for row in model.balances]), over_inputs([row.K for row in model.balances]),
        ([y.F for y in ys], n), over_inputs([y.D for y in ys]), over_inputs([y.K for y in ys]),
    ]  # fmt: skip
    matrices = dict(zip("AJBEFDG", tidy_matrices(parts), strict=True))
    return LinearModel(model.states, tuple(columns[j] for j in left), outputs, **matrices)

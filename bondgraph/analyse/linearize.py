"""`linearize`: equations with laws closed at an operating point, symbolic, for small deviations."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, SingularError, fixed, rows_of, solve
from bondgraph.algebra.expressions import TIME, normal
from bondgraph.algebra.tidy import tidy_matrices
from bondgraph.analyse.closed_rows import ClosedRows
from bondgraph.analyse.closures import merged_laws
from bondgraph.analyse.constrained import Rows, locked
from bondgraph.analyse.holding import split, stuck_ports
from bondgraph.analyse.slopes import operating_point, with_given
from bondgraph.declare.laws import ExpressionLaw, Law
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, SignalError, SingularStorageError, StructureError
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port

if TYPE_CHECKING:
    from bondgraph.analyse.state_space import StateSpace

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
        from bondgraph.analyse.state_space import state_space

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
    held = stuck_ports(equations, stuck)
    names = {port.element.name for port in held}
    merged = merged_laws(equations, {} if laws is None else laws)
    closed = {name: law for name, law in merged.items() if name not in names}
    read = {name for law in closed.values() for name in law.free_symbols}
    shown = _shown(equations, closed, outputs)
    equations = equations.with_readings({*read, *shown, *equations.integrals.values()})
    outer = _outer(equations, closed, read, inputs)
    known = {*equations.signals, *equations.integrals, *equations.parameters, *read, TIME}
    by_input = {
        p.given: closed[p.element.name] for p in equations.ports if p.element.name in closed
    }
    own = {law.state for law in closed.values() if isinstance(law, ExpressionLaw) and law.state}
    moving = {*equations.signals, *equations.integrals, *own, *outer, TIME}
    point = with_given(operating_point(at, known), by_input, moving)
    system = ClosedRows(equations, closed, outer, point)
    gone = [equations.inputs.index(port.given) for port in held]
    slips = _slips(system, held, gone)
    A, balances = system.dynamics()
    ys = [system.put_in(system.signal(name)) for name in shown]
    model = Rows(system.states, tuple(map(fixed, A)), tuple(balances), tuple(ys))
    if slips:
        if any(j in gone for y in ys for j in y.D):
            raise SignalError("an output shows what holds a sticking port; see holding_efforts")
        model = locked(model, slips, gone, _least_first(equations, len(system.states)))
    left = [j for j in system.left if j not in gone]
    return _model(model, left, system.columns, tuple(shown))


def _slips(system: ClosedRows, held: Sequence[Port], gone: Sequence[int]) -> list[FixedRow]:
    """The slips that bind states; efforts that a resistance rules at once are put in instead."""
    direct, bound = split([system.put_in(system.signal(port.received)) for port in held], gone)
    if direct and bound:
        names = ", ".join(repr(port.element.name) for port in held)
        raise StructureError(
            f"of the ports {names} some stick beside a resistance and others between storages; "
            "linearize holds one kind at a time"
        )
    if direct:
        system.give(gone, direct, held)
    if any(slip.D or slip.H or slip.K for slip in bound):
        raise DependentSourceError(
            "a slip that is to be held depends on inputs or rates; linearize holds slips between storages"
        )
    return [slip.F for slip in bound]


def _least_first(equations: StateEquations, size: int) -> list[int]:
    """The states in the order in which they become dependent: lowest priority first."""
    ports = [equations.reduction.structure.ports[port] for port in equations.reduction.states]
    priority = [port.element.priority for port in ports] + [0.0] * (size - len(ports))
    return sorted(range(size), key=lambda j: (priority[j], j))


def _outer(
    equations: StateEquations, closed: Mapping[Hashable, Law], read: set[sp.Symbol],
    inputs: Iterable[str],
) -> tuple[sp.Symbol, ...]:  # fmt: skip
    """The names in laws that are to be inputs; `SignalError` for one that can be none."""
    if isinstance(inputs, str):
        raise SignalError(f"inputs must be a list of names, not {inputs!r}")
    given = {port.given for port in equations.ports if port.element.name in closed}
    states = {law.state for law in closed.values() if isinstance(law, ExpressionLaw)}
    states |= set(equations.integrals)
    asked = {sp.Symbol(str(normal(str(name)))) for name in inputs}
    for name in sorted(asked, key=str):
        if name in equations.inputs and name not in given:
            continue
        if name in {*equations.signals, *states, *equations.parameters, TIME}:
            raise SignalError(
                f"{name} can't be an input: it is a signal, a parameter of the matrices or the time"
            )
        if name not in read:
            raise SignalError(f"no law reads an input {name}")
    return tuple(sorted(asked - set(equations.inputs), key=str))


def _shown(
    equations: StateEquations, closed: Mapping[Hashable, Law], outputs: Iterable[str] | None
) -> list[sp.Symbol]:
    if outputs is None:
        return list(equations.outputs)
    if isinstance(outputs, str):
        raise SignalError(f"outputs must be a list of signals, not {outputs!r}")
    own = {law.state for law in closed.values() if isinstance(law, ExpressionLaw) and law.state}
    own |= set(equations.integrals)
    shown = [sp.Symbol(str(normal(str(name)))) for name in outputs]
    for name in shown:
        if name not in equations.signals and name not in own:
            known = ", ".join(sorted(map(str, {*equations.signals, *own})))
            raise SignalError(f"no signal is called {name}; there are {known}")
    return shown


def _model(
    model: Rows, left: Sequence[int], columns: Sequence[sp.Symbol], outputs: tuple[sp.Symbol, ...]
) -> LinearModel:
    """Rows as matrices over the inputs that are left."""
    place = {j: at for at, j in enumerate(left)}

    def over_inputs(rows: Sequence[FixedRow]) -> tuple[list[Row], int]:
        return [{place[j]: entry for j, entry in row.items()} for row in rows], len(left)

    n = len(model.states)
    ys = [_settled(model, y) for y in model.outputs]
    parts = [
        (model.A, n), ([row.F for row in model.balances], n),
        over_inputs([row.D for row in model.balances]), over_inputs([row.K for row in model.balances]),
        ([y.F for y in ys], n), over_inputs([y.D for y in ys]), over_inputs([y.K for y in ys]),
    ]  # fmt: skip
    matrices = dict(zip("AJBEFDG", tidy_matrices(parts), strict=True))
    return LinearModel(model.states, tuple(columns[j] for j in left), outputs, **matrices)


def _settled(model: Rows, y: Reading) -> Reading:
    try:
        return resolved(model.A, model.balances, y)
    except SingularError:
        raise SingularStorageError(
            "A is singular at this point, so the rates that an output shows are not determined"
        ) from None

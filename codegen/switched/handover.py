"""What storages keep when a switch changes over: momenta and displacements, from one phase to the next.

At that instant the efforts of dependent storages may be impulses; nothing else may. So along the rows of
the new phase's structure ``Pi = p_x - S_xd p_d`` does not change, and ``A x - E u = Pi`` gives its state.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
import sympy as sp

from bondgraph.algebra.exact import Row
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import is_storage
from bondgraph.reduce.structure import JunctionStructure
from codegen.model.instant import Binding
from codegen.model.numbers import at_parameters
from codegen.model.snapshot import Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.records import block
from codegen.standalone.instant import Instant
from codegen.standalone.matrices import scaled_solve

_NONE: Array = np.zeros(0)
_NOWHERE = Instant(0.0, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE)
"""Enough for entries that are constant."""

Rows = Sequence[Mapping[int, sp.Expr]]

FAR = 2.0**40
"""An impulse is looked at as a value so much larger than all others."""


class Handover:
    """Linear storages of one phase: what they hold, and the state that they make at its beginning.

    ``storages``: their names, in declaration order, which all phases share.
    """

    def __init__(self, model: ClosedModel) -> None:
        self._model = model
        reduction = model.equations.reduction
        structure, program = reduction.structure, model.program
        ports = [
            i for i, p in enumerate(structure.ports) if is_storage(p) and p.element.law is None
        ]
        _check_linear(model.equations)
        self.storages: tuple[Hashable, ...] = tuple(structure.ports[i].element.name for i in ports)
        self.variables = tuple(
            (p.given if p.integral else p.received).name
            for p in (structure.ports[i] for i in ports)
        )
        column = {port: at for at, port in enumerate(ports)}
        ruling = [self._ruling(port) for port in ports]
        n, m = len(program.states), len(program.inputs)
        self._x = self._matrix([reading.F for reading in ruling], n)
        self._u = self._matrix([reading.D for reading in ruling], m)
        self._values = self._matrix(
            [_values(structure, port, column) for port in ports], len(ports)
        )
        kept: list[dict[int, sp.Expr]] = []
        for port in reduction.states:
            row = structure.rows[port]
            gained = {column[d]: -row[d] for d in row if d in reduction.dependent}
            kept.append({column[port]: sp.Integer(1), **gained})
        self._kept = self._matrix(kept, len(ports))
        self._shown = self._matrix(
            [self._impulses_in(name, column) for name in program.readings], len(ports)
        )

    def momenta(
        self, t: float, now: Snapshot, given: Mapping[str, float] = MappingProxyType({})
    ) -> Array:
        """What every storage holds at an instant, co-energy variables in ``given`` being as they say."""
        at = now.instant(t)
        ruling = self._x(at) @ now.x + self._u(at) @ now.u
        for i, name in enumerate(self.variables):
            ruling[i] = given.get(name, ruling[i])
        return np.asarray(self._values(at) @ ruling, dtype=float)

    def sizes(self, t: float, now: Snapshot, largest: Array | float = 0.0) -> Array:
        """The magnitudes of the terms that make up the momenta: what their rounding is relative to.

        ``largest``: magnitudes that the states have reached.
        """
        at = now.instant(t)
        x = np.maximum(np.abs(now.x), largest)
        terms = np.abs(self._x(at)) @ x + np.abs(self._u(at)) @ np.abs(now.u)
        return np.asarray(np.abs(self._values(at)) @ terms, dtype=float)

    def begin(self, t: float, momenta: Array, own: Array, w: Array, dw: Array) -> Array:
        """The integrated vector with which the phase begins, of momenta and the states of laws."""
        model, program = self._model, self._model.program
        n = len(program.states)
        s = np.zeros(model.size)
        s[n : n + len(own)] = own
        if not program.varying:
            s[:n] = _solved(model.constant.A, self._kept(_NOWHERE) @ momenta)
            return s
        before = model.evaluate(t, s, w, dw, tuple(1 for _ in program.friction))
        s[:n] = _solved(before.numbers.A, self._kept(before.instant(t)) @ momenta)
        # x is integrated itself here, so what sources hold in dependent storages is added.
        s[:n] += before.numbers.R @ before.u
        return s

    def impulses(self, t: float, now: Snapshot, change: Array) -> Array:
        """The impulses in the readings as momenta change by so much."""
        return np.asarray(self._shown(now.instant(t)) @ change, dtype=float)

    def taken(self, t: float, now: Snapshot, before: Array, after: Array) -> float:
        """What an impact takes that changes momenta so: the energy of the lost velocities (Carnot)."""
        change = after - before
        lost = np.linalg.solve(self._values(now.instant(t)), change)
        return float(0.5 * change @ lost)

    def falling(self, t: float, now: Snapshot, change: Array) -> Array:
        """How the guards change with the impulses that change the momenta, per unit of the largest."""
        values = self._model.guards(t, now)
        impulses = self.impulses(t, now, change)
        size = float(np.abs(impulses).max(initial=0.0))
        if size == 0.0:
            return np.zeros_like(values)
        far = FAR * (1 + float(np.abs(now.y).max(initial=0.0)))
        moved = Snapshot(
            now.x, now.z, now.u, now.du, now.y + far / size * impulses, now.rate, now.caps,
            now.external, now.numbers,
        )  # fmt: skip
        return np.asarray((self._model.guards(t, moved) - values) / far, dtype=float)

    def _ruling(self, port: int) -> Reading:
        """A storage's co-energy variable over states and inputs."""
        reduction = self._model.equations.reduction
        if port in reduction.columns_of_states:
            return reduction.reading({port: sp.Integer(1)})
        return reduction.reading(reduction.structure.rows[port])

    def _impulses_in(self, name: sp.Symbol, column: Mapping[int, int]) -> dict[int, sp.Expr]:
        """A reading's row over the rates of what dependent storages hold."""
        equations = self._model.equations
        row, dependent = equations.signals.get(name, {}), equations.reduction.dependent
        return {column[d]: entry for d, entry in row.items() if d in dependent}

    def _matrix(self, rows: Rows, width: int) -> Callable[[Instant], Array]:
        """Sparse rows as a function of an instant that gives a matrix."""
        model = self._model
        places = [(i, j) for i, row in enumerate(rows) for j in row]
        entries = [at_parameters(rows[i][j], model.parameters) for i, j in places]
        evaluate = Binding(model.program, model.parameters).function(block(entries))

        def matrix(now: Instant) -> Array:
            result = np.zeros((len(rows), width))
            for (i, j), value in zip(places, evaluate(now), strict=True):
                result[i, j] = value
            return result

        if model.program.varying:
            return matrix
        constant = matrix(_NOWHERE)
        return lambda now: constant


def _solved(A: Array, right: Array) -> Array:
    return scaled_solve(A, right[:, None])[:, 0]


def _values(structure: JunctionStructure, port: int, column: Mapping[int, int]) -> Row:
    """A storage's value, or a field's row of them."""
    element = structure.ports[port].element
    row = element.row or ((element.name, element.constant),)
    return {column[structure.places[name]]: value for name, value in row if value != 0}


def _check_linear(equations: StateEquations) -> None:
    """Refuse dependent storages with laws, and inertia that states rule: the handover is no linear one."""
    ruling = (equations.A.free_symbols | equations.E.free_symbols) & set(equations.states)
    if ruling:
        raise StructureError(
            f"an inertia depends on the state {min(map(str, ruling))}, which may jump as a switch changes "
            "over; let it depend on an integral of a flow or an effort"
        )
    for port in equations.reduction.structure.ports:
        if port.element.inverse is not None and not port.integral:
            raise StructureError(
                f"switches make the nonlinear storage {port.element.name!r} dependent, which only linear "
                "ones may become in a run; put a resistance or a storage between"
            )

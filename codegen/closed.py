"""The closed model in numbers: at any time, state and friction mode, every input, reading and rate.

The integrated vector is ``s = [xi, z]``: ``xi = x - A^-1 E u`` stays continuous when an input that
drives a dependent storage steps; z are the states that laws own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.optimize
import sympy as sp

from bondgraph import SimulationError, StateEquations
from bondgraph.expressions import TIME
from codegen.affine import AffineMap
from codegen.arrays import Array
from codegen.friction import Hold, exact_rows, fair_share, hold
from codegen.numbers import Numbers, exact_parameters, numbers
from codegen.numpy_backend import compiled
from codegen.program import Block, Group, Program
from codegen.signals import Piece

Mode = tuple[int, ...]
"""For each friction port: 0 sticking, +1 or -1 the sign of its slip."""

LOOP_RESIDUAL = 1e-9


@dataclass(frozen=True)
class Snapshot:
    """Everything at one instant. ``caps``: the breakaway effort of each friction port."""

    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    rate: Array
    caps: Array
    external: Array


class ClosedModel:
    """Equations, laws and parameters bound together; a pure function of time, state, inputs and mode."""

    def __init__(
        self, program: Program, equations: StateEquations, parameters: Mapping[str, object]
    ) -> None:
        exact = exact_parameters(parameters)
        self.program = program
        self.model: Numbers = numbers(program, equations, exact)
        self.friction_inputs = [port.input for port in program.friction]
        self.friction_readings = [port.reading for port in program.friction]
        self._exact_F, self._exact_D = exact_rows(program, equations, exact)
        self._parameters = np.array([float(exact[name.name]) for name in program.parameters])
        self._place = _places(program)
        self._known = self._function(program.known.values)
        self._groups = [self._function(group.values) for group in program.groups]
        self._coupled = self._function(program.coupled.values)
        self._friction = self._function(program.friction_values)
        self._outside = [
            (column, program.external.index(name))
            for column, name in enumerate(program.inputs)
            if name in program.external
        ]
        self._rated = bool(self.model.R.any() or self.model.G.any() or self.model.D.any())
        self._known_rates = self._function(program.known_rates) if self._rated else None
        self.joint = bool(program.coupled.inputs) or bool(self._exact_D.todok())
        self.affine = program.affine and not self.joint
        self._maps: dict[Mode, AffineMap | None] = {}
        self._holds: dict[tuple[int, ...], Hold] = {}

    @property
    def size(self) -> int:
        """The length of the integrated vector; at least 1, so that integrators have something."""
        return max(len(self.program.states) + len(self.program.law_states), 1)

    def coupled_directly(self, port: int) -> bool:
        """Whether a friction port's slip depends at once on efforts of friction ports."""
        return bool(self._exact_D[port, :].todok())

    def hold(self, mode: Mode) -> Hold:
        """The holding equations of the ports that stick in a mode."""
        ports = tuple(i for i, sign in enumerate(mode) if sign == 0)
        if ports not in self._holds:
            found = hold(self.program, self.model, self._exact_F, self._exact_D, ports)
            self._check_differentiable(found)
            self._holds[ports] = found
        return self._holds[ports]

    def at(self, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Snapshot:
        """Every variable at one time, with the inputs' pieces and the friction mode given."""
        w = np.array([piece(t) for piece in pieces])
        if self.affine:
            return self._at_affine(t, s, w, pieces, mode)
        dw = np.zeros(len(w))
        if self._rated:
            dw = np.array([piece.derivative(t) for piece in pieces])
        return self.evaluate(t, s, w, dw, mode)

    def _at_affine(
        self, t: float, s: Array, w: Array, pieces: Sequence[Piece], mode: Mode
    ) -> Snapshot:
        dw = np.array([piece.derivative(t) for piece in pieces]) if self._rated else 0.0 * w
        if mode not in self._maps:
            self._maps[mode] = self._affine_map(mode, len(w))
        found = self._maps[mode]
        if found is None:
            return self.evaluate(t, s, w, dw, mode)
        x, z, u, du, y, rate, caps = found(s, w, dw)
        if mode and min(caps) < 0:
            return self.evaluate(t, s, w, dw, mode)
        return Snapshot(x, z, u, du, y, rate, caps, w)

    def _affine_map(self, mode: Mode, inputs: int) -> AffineMap | None:
        """The mode's matrix, column by column; None where redundant ports share a load, unequally."""
        if 0 in mode and len(self.hold(mode).share):
            return None
        zero = np.zeros(self.size + 2 * inputs)

        def point(v: Array) -> Array:
            s, w, dw = np.split(v, [self.size, self.size + inputs])
            now = self.evaluate(0.0, s, w, dw, mode, checked=False)
            return np.concatenate([now.x, now.z, now.u, now.du, now.y, now.rate, now.caps])

        origin = point(zero)
        columns = [point(row) - origin for row in np.eye(len(zero))]
        sizes = (
            len(self.program.states), len(self.program.law_states), len(self.program.inputs),
            len(self.program.inputs), len(self.program.readings), self.size, len(mode),
        )  # fmt: skip
        return AffineMap(sizes, np.column_stack([*columns, origin]))

    def evaluate(
        self, t: float, s: Array, w: Array, dw: Array, mode: Mode, checked: bool = True
    ) -> Snapshot:
        """As `at`, from the values and rates of the external inputs; ``checked``: levels, for sign."""
        program, model = self.program, self.model
        n = len(program.states)
        xi, z = s[:n], s[n : n + len(program.law_states)]
        u, du = np.zeros(len(program.inputs)), np.zeros(len(program.inputs))
        for column, index in self._outside:
            u[column], du[column] = w[index], dw[index]
        pool = self._pool(t, xi, z, np.zeros(len(program.readings)), u, w, dw)
        for column, value in zip(program.known.inputs, self._known(pool), strict=True):
            u[column] = value
        if self._known_rates is not None:
            for column, value in zip(program.known.inputs, self._known_rates(pool), strict=True):
                du[column] = value
        x = xi + model.R @ u
        y = model.F @ x + model.D @ u + model.G @ du
        for group, function in zip(program.groups, self._groups, strict=True):
            self._give(group, function, t, x, z, y, u, w, dw)
        caps = self._rub(t, x, z, y, u, w, du, dw, mode, checked)
        rate = np.zeros(self.size)
        rate[:n] = model.P @ x + model.Q @ u
        if len(z):
            rate[n : n + len(z)] = y[list(program.law_rates)]
        return Snapshot(x, z, u, du, y, rate, caps, w)

    def _give(self, group: Group, function: Callable[[Array], list[Any]], t: float, x: Array,
              z: Array, y: Array, u: Array, w: Array, dw: Array) -> None:  # fmt: skip
        """Evaluate one group of laws into u, and what follows from it into y."""
        columns = list(group.inputs)
        if group.loop:
            self._solve(columns, lambda at_y, at_u: at_u[columns] - np.array(
                function(self._pool(t, x, z, at_y, at_u, w, dw)), dtype=float
            ), y, u, t, group.ports)  # fmt: skip
            return
        values = np.array(function(self._pool(t, x, z, y, u, w, dw)), dtype=float)
        u[columns] += values
        y += self.model.D[:, columns] @ values

    def _rub(self, t: float, x: Array, z: Array, y: Array, u: Array, w: Array, du: Array,
             dw: Array, mode: Mode, checked: bool) -> Array:  # fmt: skip
        """The friction efforts of a mode into u and y; returns the breakaway efforts."""
        if not self.friction_inputs:
            return np.zeros(0)
        signs = np.array(mode, dtype=float)
        columns = self.friction_inputs + list(self.program.coupled.inputs)
        stuck = [i for i, sign in enumerate(mode) if sign == 0]

        def slipping(at_y: Array, at_u: Array) -> tuple[Array, Array]:
            values = np.array(
                self._friction(self._pool(t, x, z, at_y, at_u, w, dw)), dtype=float
            ).reshape(-1, 3)
            if checked:
                self._check_levels(values, t)
            return values[:, 0] * values[:, 2] * signs, values[:, 1]

        if self.joint:
            held = self.hold(mode) if stuck else None

            def residual(at_y: Array, at_u: Array) -> Array:
                wanted = slipping(at_y, at_u)[0]
                left = at_u[self.friction_inputs] - wanted
                if held is not None:
                    known = held.X @ x + held.U @ at_u + held.V @ du
                    sharing = held.share @ at_u[[self.friction_inputs[i] for i in stuck]]
                    left[stuck] = np.concatenate([known, sharing])
                laws = self._coupled(self._pool(t, x, z, at_y, at_u, w, dw))
                coupled = at_u[list(self.program.coupled.inputs)] - np.array(laws, dtype=float)
                return np.concatenate([left, coupled])

            names = tuple(port.name for port in self.program.friction) + self.program.coupled.ports
            self._solve(columns, residual, y, u, t, names)
            caps = slipping(y, u)[1]
            if held is not None and len(held.share):
                inputs = [self.friction_inputs[i] for i in stuck]
                change = fair_share(u[inputs], held.share, caps[stuck]) - u[inputs]
                u[inputs] += change
                y += self.model.D[:, inputs] @ change
            return caps
        values, caps = slipping(y, u)
        u[self.friction_inputs] = values
        if stuck:
            inputs = [self.friction_inputs[i] for i in stuck]
            u[inputs] = self.hold(mode).efforts(x, u, du, inputs, caps[stuck])
        y += self.model.D[:, self.friction_inputs] @ u[self.friction_inputs]
        return caps

    def _solve(self, columns: list[int], residual: Callable[[Array, Array], Array], y: Array,
               u: Array, t: float, names: Sequence[object]) -> None:  # fmt: skip
        """Solve a loop of laws for the inputs it gives; y and u are completed in place."""
        base_y, base_u = y.copy(), u.copy()

        def left(values: Array) -> Array:
            u[columns] = base_u[columns] + values
            y[:] = base_y + self.model.D[:, columns] @ values
            return residual(y, u)

        start = np.zeros(len(columns))
        scale = 1.0 + float(np.abs(left(start)).max())
        for method in ("hybr", "lm"):
            found = scipy.optimize.root(left, start, method=method, tol=1e-13)
            worst = float(np.abs(left(found.x)).max())
            if worst <= LOOP_RESIDUAL * (scale + float(np.abs(found.x).max())):
                return
        listed = ", ".join(repr(name) for name in names)
        raise SimulationError(
            f"at t = {t:g} the laws at {listed} depend on one another and have no solution that "
            f"could be found (residual {worst:.3g}); check the laws, or put a storage between"
        )

    def _check_levels(self, values: Array, t: float) -> None:
        if (values[:, 0] < 0).any():
            at = int(np.argmin(values[:, 0]))
            raise SimulationError(
                f"at t = {t:g} the friction level at {self.program.friction[at].name!r} is negative "
                f"({values[at, 0]:g}); a level is a magnitude"
            )

    def _check_differentiable(self, found: Hold) -> None:
        """Refuse to stick where the slope of a law that the system rules would be needed."""
        allowed = {column for column, _ in self._outside} | set(self.program.known.inputs)
        found.V[:, self.friction_inputs] = 0.0
        for column in np.flatnonzero(np.abs(found.V).max(axis=0, initial=0.0) > 1e-12):
            if column not in allowed:
                names = ", ".join(repr(self.program.friction[i].name) for i in found.ports)
                raise SimulationError(
                    f"holding {names} would need the slope in time of {self.program.inputs[column]}, "
                    "which a law gives; put a storage between"
                )

    def _pool(self, t: float, x: Array, z: Array, y: Array, u: Array, w: Array, dw: Array) -> Array:
        return np.concatenate(([t], x, z, y, u, w, dw, self._parameters))

    def _function(self, code: Block) -> Callable[[Array], list[Any]]:
        """A block as a function of the pool of all variables."""
        function = compiled(code)
        indices = [self._place[name] for name in code.arguments]
        if not code.results:
            return lambda pool: []
        return lambda pool: function(*pool[indices].tolist())


def _places(program: Program) -> dict[sp.Symbol, int]:
    """Where each name's value stands in the pool; a parameter or a state before its equals."""
    listed = [
        TIME, *program.states, *program.law_states, *program.readings, *program.inputs,
        *program.external, *program.external_rates, *program.parameters,
    ]  # fmt: skip
    places: dict[sp.Symbol, int] = {}
    for at, name in enumerate(listed):
        if name in program.parameters and at < len(listed) - len(program.parameters):
            continue
        places.setdefault(name, at)
    return places

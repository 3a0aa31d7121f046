"""The closed model in numbers: at any time, state and friction mode, every input, reading and rate.

The integrated vector is ``s = [xi, z]``: ``xi = x - A^-1 E u`` stays continuous when an input that
drives a dependent storage steps; z are the states that laws own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bondgraph import SimulationError, StateEquations
from codegen.arrays import Array
from codegen.inputs.pieces import Piece
from codegen.model.affine import AffineMap
from codegen.model.friction import Hold, exact_rows, hold
from codegen.model.instant import Binding, Evaluation, Instant
from codegen.model.loops import solve_loop
from codegen.model.numbers import Numbers, assembled, check_values, exact_parameters, numbers
from codegen.model.sharing import fair_share
from codegen.program import Group, Program

Mode = tuple[int, ...]
"""For each friction port: 0 sticking, +1 or -1 the sign of its slip."""


INPUTS, RATES_OF_INPUTS, READINGS, RATE, CAPS = 2, 3, 4, 5, 6
"""Where the parts of a `Snapshot` stand in an affine map."""

FAR = 2.0**30
"""How far out affine models are probed; a power of two, so that dividing by it is exact."""


@dataclass(frozen=True)
class Snapshot:
    """Everything at one instant: states x and z, inputs, their rates, readings, the rate of s.

    ``caps``: the breakaway effort of each friction port. ``external``: the external inputs.
    ``numbers``: the matrices, as they are at this instant.
    """

    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    rate: Array
    caps: Array
    external: Array
    numbers: Numbers


class ClosedModel:
    """Equations, laws and parameters bound together; a function of time, state, inputs and mode."""

    def __init__(
        self, program: Program, equations: StateEquations, parameters: Mapping[str, object]
    ) -> None:
        exact = exact_parameters(parameters)
        self.program, self.equations, self.parameters = program, equations, exact
        self.friction_inputs = [port.input for port in program.friction]
        self.friction_readings = [port.reading for port in program.friction]
        self._exact_F, self._exact_D = exact_rows(program, equations, exact)
        binding = Binding(program, exact)
        self._known = binding.function(program.known.values)
        self._known_rates = binding.function(program.known_rates)
        self._groups = [binding.function(group.values) for group in program.groups]
        self._coupled = binding.function(program.coupled.values)
        self._friction = binding.function(program.friction_values)
        self._guards = binding.function(program.guards)
        self._outside = [program.inputs.index(n) for n in program.external if n in program.inputs]
        self._coefficients = binding.function(program.coefficients)
        self._constant = None if program.varying else numbers(program, equations, exact)
        if program.varying:
            check_values(equations, exact)
        self._rated = any(program.layout[name].rows for name in "EDHK")
        self._joint = program.joint
        self._maps: dict[Mode, AffineMap | None] = {}
        self._holds: dict[Mode, Hold] = {}

    @property
    def constant(self) -> Numbers:
        """The matrices of a model whose coefficients don't change."""
        if self._constant is None:
            raise SimulationError("the coefficients of this model change in time")
        return self._constant

    @property
    def size(self) -> int:
        """The length of the integrated vector; at least 1, so that integrators have something."""
        return max(len(self.program.states) + len(self.program.law_states), 1)

    def coupled_directly(self, port: int) -> bool:
        """Whether a friction port's slip depends at once on efforts of friction ports."""
        return bool(self._exact_D[port, :].todok())

    def hold(self, mode: Mode, numbers: Numbers) -> Hold:
        """The holding equations of the ports that stick in a mode, with the matrices of an instant."""
        if mode not in self._holds or self.program.varying:
            ports = tuple(i for i, sign in enumerate(mode) if sign == 0)
            found = hold(self.program, numbers, self._exact_F, self._exact_D, ports)
            self._check_differentiable(found)
            self._holds[mode] = found
        return self._holds[mode]

    def numbers(self, now: Instant) -> Numbers:
        """The matrices at an instant, of which the states and the external inputs must be known.

        Raises `SimulationError` where a value has no finite number or A no inverse.
        """
        if self._constant is not None:
            return self._constant
        values = self._coefficients(now)
        if np.isfinite(values).all():
            try:
                return assembled(self.program, values)
            except np.linalg.LinAlgError:
                pass
        raise SimulationError(
            f"at t = {now.t:.9g} a value is not finite, or A has no inverse; state {now.x.tolist()} "
            f"{now.z.tolist()}"
        )

    def at(self, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Snapshot:
        """Every variable at one time, with the inputs' pieces and the friction mode given."""
        w, dw = self.given(t, pieces)
        if self.program.affine:
            affine = self.affine_map(mode, len(w))
            if affine is not None:
                x, z, u, du, y, rate, caps = affine(s, w, dw)
                now = Snapshot(x, z, u, du, y, rate, caps, w, self.constant)
                if not mode or min(now.caps) >= 0:
                    return now
        return self.evaluate(t, s, w, dw, mode)

    def guards(self, t: float, now: Snapshot) -> Array:
        """The conditions at an instant: one below zero ends the run."""
        zeros = np.zeros(len(now.external))
        values = self._guards(
            Instant(
                t, now.x, now.z, now.u, now.du, now.y, now.external, zeros, now.caps, now.numbers
            )
        )
        if not np.isfinite(values).all():
            at = int(np.argmin(np.isfinite(values)))
            raise SimulationError(
                f"at t = {t:.9g} the condition of switch number {at + 1}, in the order of their declaration, "
                "has no finite value"
            )
        return values

    def given(self, t: float, pieces: Sequence[Piece]) -> tuple[Array, Array]:
        """The external inputs, and their rates where anything asks for them."""
        w = np.array([piece(t) for piece in pieces])
        if not self._rated:
            return w, np.zeros(len(w))
        return w, np.array([piece.derivative(t) for piece in pieces])

    @property
    def rated(self) -> bool:
        """Whether anything asks for the rates of the external inputs."""
        return self._rated

    def rates(self, pieces: Sequence[Piece], mode: Mode) -> Callable[[float, Array], Array]:
        """The rate of s in a mode as a function of t and s; quicker than `at`, which gives all else too."""
        affine = self.affine_map(mode, len(pieces))
        if affine is None:
            return lambda t, s: self.at(t, s, pieces, mode).rate
        rows = np.ascontiguousarray(affine.rows(RATE))
        one = (1.0,)

        def rate(t: float, s: Array) -> Array:
            return np.asarray(rows @ np.concatenate((s, *self.given(t, pieces), one)))

        return rate

    def evaluate(
        self, t: float, s: Array, w: Array, dw: Array, mode: Mode, checked: bool = True
    ) -> Snapshot:
        """As `at`, from the external inputs' values and rates; ``checked``: friction levels, for sign."""
        program = self.program
        n, own = len(program.states), len(program.law_states)
        m, p = len(program.inputs), len(program.readings)
        xi, z = s[:n], s[n : n + own]
        u, du, y, caps = np.zeros(m), np.zeros(m), np.zeros(p), np.zeros(len(mode))
        now = Instant(t, xi, z, u, du, y, w, dw, caps, None)  # type: ignore[arg-type]
        now.u[self._outside], now.du[self._outside] = (
            w[: len(self._outside)],
            dw[: len(self._outside)],
        )
        known = list(program.known.inputs)
        now.u[known] = self._known(now)
        if self._rated:
            now.du[known] = self._known_rates(now)
        numbers = now.numbers = self.numbers(now)
        if not program.varying:
            now.x = xi + numbers.R @ now.u
        now.y = numbers.F @ now.x + numbers.D @ now.u + numbers.G @ now.du
        for group, function in zip(program.groups, self._groups, strict=True):
            self._give(now, group, function)
        if mode:
            self._rub(now, mode, checked)
        rate = np.zeros(self.size)
        rate[:n] = numbers.P @ now.x + numbers.Q @ now.u
        if program.varying:
            rate[:n] += numbers.R @ now.du
        rate[n : n + own] = now.y[list(program.law_rates)]
        rate += self._correction(mode, rate, now.du, numbers)
        return Snapshot(now.x, z, now.u, now.du, now.y, rate, now.caps, w, numbers)

    def affine_map(self, mode: Mode, inputs: int) -> AffineMap | None:
        """An affine mode's matrix; None for other models, and where redundant ports share a load."""
        if not self.program.affine:
            return None
        if mode not in self._maps:
            redundant = 0 in mode and len(self.hold(mode, self.constant).share) > 0
            self._maps[mode] = None if redundant else self._affine_map(mode, inputs)
        return self._maps[mode]

    def _affine_map(self, mode: Mode, inputs: int) -> AffineMap:
        def point(v: Array) -> list[Array]:
            s, w, dw = np.split(v, [self.size, self.size + inputs])
            now = self.evaluate(0.0, s, w, dw, mode, checked=False)
            return [now.x, now.z, now.u, now.du, now.y, now.rate, now.caps]

        length = self.size + 2 * inputs
        parts = point(np.zeros(length))
        origin = np.concatenate(parts)
        # Far out the constant part of a law no longer swallows digits of its slope.
        columns = [(np.concatenate(point(FAR * e)) - origin) / FAR for e in np.eye(length)]
        affine = AffineMap([len(part) for part in parts], np.column_stack([*columns, origin]), RATE)
        rate, du = affine.rows(RATE), affine.rows(RATES_OF_INPUTS)
        rate += self._correction(mode, rate, du, self.constant)
        return affine

    def _correction(self, mode: Mode, rate: Array, du: Array, numbers: Numbers) -> Array:
        """What rounding in the holding efforts has to be added to rates, or slips that stick would drift."""
        change = np.zeros_like(rate)
        if 0 in mode:
            held, n = self.hold(mode, numbers), len(self.program.states)
            fixed = held.slip_u + (0.0 if self.program.varying else held.slip_x @ numbers.R)
            change[:n] = held.take_away @ (held.slip_x @ rate[:n] + fixed @ du)
        return change

    def _give(self, now: Instant, group: Group, function: Evaluation) -> None:
        """Evaluate one group of laws, or solve it if it is a loop."""
        columns, D = list(group.inputs), now.numbers.D
        if group.loop:
            rows = list(group.readings)
            solve_loop(now, columns, rows, D, lambda at: at.u[columns] - function(at), group.ports)
        else:
            now.give(columns, function(now), D)

    def _rub(self, now: Instant, mode: Mode, checked: bool) -> None:
        """The friction efforts of a mode: against the slip, or whatever holds."""
        stuck = [i for i, sign in enumerate(mode) if sign == 0]
        held = [self.friction_inputs[i] for i in stuck]
        if self._joint:
            self._rub_jointly(now, mode, stuck, held, checked)
        else:
            against = self._against(now, mode, checked)
            now.u[self.friction_inputs] = against
            if stuck:
                rule = self.hold(mode, now.numbers)
                now.u[held] = rule.efforts(now.x, now.u, now.du, held, now.caps[stuck])
            now.y += now.numbers.D[:, self.friction_inputs] @ now.u[self.friction_inputs]

    def _rub_jointly(
        self, now: Instant, mode: Mode, stuck: list[int], held: list[int], checked: bool
    ) -> None:
        """The same where friction efforts act back on slips or laws at once: all solved together."""
        coupled = list(self.program.coupled.inputs)

        def residual(at: Instant) -> Array:
            left = at.u[self.friction_inputs] - self._against(at, mode, checked)
            if stuck:
                hold = self.hold(mode, at.numbers)
                rule = hold.X @ at.x + hold.U @ at.u + hold.V @ at.du
                left[stuck] = np.concatenate([rule, hold.share @ at.u[held]])
            return np.concatenate([left, at.u[coupled] - self._coupled(at)])

        names = [port.name for port in self.program.friction] + list(self.program.coupled.ports)
        columns = self.friction_inputs + coupled
        rows = self.friction_readings + list(self.program.coupled.readings)
        solve_loop(now, columns, rows, now.numbers.D, residual, names)
        if stuck and len(share := self.hold(mode, now.numbers).share):
            fair = fair_share(now.u[held], share, now.caps[stuck])
            now.give(held, fair - now.u[held], now.numbers.D)

    def _against(self, now: Instant, mode: Mode, checked: bool) -> Array:
        """Slipping ports' efforts, zero at sticking ones; notes every port's breakaway effort."""
        levels, caps, curves, at_rest = self._friction(now).reshape(-1, 4).T
        if checked:
            self._check_friction(now.t, levels, caps, curves, at_rest)
        now.caps = caps
        efforts: Array = levels * curves * np.array(mode, dtype=float)
        return efforts

    def _check_friction(
        self, t: float, levels: Array, caps: Array, curves: Array, at_rest: Array
    ) -> None:
        """Refuse friction that would drive, or hold less than it brakes at standstill."""
        wrong = (levels < 0) | (curves < 0) | (caps < levels * at_rest * (1 - 1e-12))
        if wrong.any():
            at = int(np.argmax(wrong))
            raise SimulationError(
                f"at t = {t:g} the friction at {self.program.friction[at].name!r} has level "
                f"{levels[at]:g}, curve {curves[at]:g} and breakaway effort {caps[at]:g}: level and "
                "curve must not be negative, the breakaway not below the friction at standstill"
            )

    def _check_differentiable(self, found: Hold) -> None:
        """Refuse to stick where the slope of a law that the system rules would be needed."""
        allowed = {*self._outside, *self.program.known.inputs, *self.friction_inputs}
        for column in np.flatnonzero(np.abs(found.V).max(axis=0, initial=0.0) > 1e-12):
            if column not in allowed:
                names = ", ".join(repr(self.program.friction[i].name) for i in found.ports)
                raise SimulationError(
                    f"holding {names} would need the slope in time of {self.program.inputs[column]}, "
                    "which a law gives; put a storage between"
                )

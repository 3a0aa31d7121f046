"""The closed model in numbers: at any time, state and friction mode, every input, reading and rate.

The integrated vector is ``s = [xi, z]``: ``xi = x - A^-1 E u`` stays continuous when an input that
drives a dependent storage steps; z are the states that laws own.
"""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from functools import cached_property
from types import MappingProxyType

import numpy as np

from bondgraph.equations import StateEquations
from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.instant import Binding, Evaluation, Instant
from codegen.model.loops import solve_loop
from codegen.model.numbers import Numbers, assembled, check_values, exact_parameters, numbers
from codegen.model.sharp import NotAffineError, sharp_rates
from codegen.model.snapshot import Mode, Run, Snapshot
from codegen.model.terms import without_rounding
from codegen.numbers.arrays import Array
from codegen.numbers.pairs import Pair, pair
from codegen.ports.friction import Hold
from codegen.ports.rubbing import Rubbing
from codegen.ports.slips import SlipRows
from codegen.program.affine import AffineMap, check_finite, probed
from codegen.program.gains import check_gains
from codegen.program.layout import CAPS, INPUTS, RATE, RATES_OF_INPUTS
from codegen.program.records import Group, Program


class ClosedModel:
    """Equations, laws and parameters bound together; a function of time, state, inputs and mode."""

    def __init__(
        self, program: Program, equations: StateEquations, parameters: Mapping[str, object]
    ) -> None:
        exact = MappingProxyType(exact_parameters(parameters))
        self.program, self.equations, self.parameters = program, equations, exact
        check_gains(program, exact)
        self.friction_inputs = [port.input for port in program.friction]
        self.friction_readings = [port.reading for port in program.friction]
        binding = Binding(program, exact)
        self._known = binding.function(program.known.values)
        self._known_rates = binding.function(program.known_rates)
        self._groups = [binding.function(group.values) for group in program.groups]
        self._rubbing = Rubbing(program, equations, exact, binding)
        self._guards = binding.function(program.guards)
        self._outside = [program.inputs.index(n) for n in program.external if n in program.inputs]
        self._coefficients = binding.function(program.coefficients)
        self._constant = None if program.varying else numbers(program, equations, exact)
        if program.varying:
            check_values(equations, exact)
        self._rated = any(program.layout[name].rows for name in "EDHK")
        self._maps: dict[Mode, AffineMap | None] = {}
        self._run: Run | None = None

    def within(self, run: Run) -> "ClosedModel":
        """The same model in a run: a level that a state rules rounds by what that state has been there."""
        made = copy(self)
        made._run = run
        return made

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
        return self._rubbing.coupled_directly(port)

    @property
    def slips(self) -> SlipRows:
        """What friction ports receive, exact."""
        return self._rubbing.slips

    def hold(self, mode: Mode, numbers: Numbers) -> Hold:
        """The holding equations of the ports that stick in a mode, with the matrices of an instant."""
        return self._rubbing.hold(mode, numbers)

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
                if mode and min(caps) < 0:
                    most = s if self._run is None else np.maximum(np.abs(s), self._run.largest)
                    caps = without_rounding(caps, affine.terms(CAPS, most, w, dw))
                if not mode or min(caps) >= 0:
                    return Snapshot(x, z, u, du, y, rate, caps, w, self.constant)
        return self.evaluate(t, s, w, dw, mode)

    def vector(self, t: float, state: Array, given: Array) -> Array:
        """The integrated vector at a state: x less what inputs that drive dependent storages add."""
        s = np.zeros(self.size)
        s[: len(state)] = state
        if self.program.layout["E"].rows and not self.program.varying:
            slipping = tuple(1 for _ in self.friction_inputs)
            known = self.evaluate(t, s, given, np.zeros(len(given)), slipping)
            s[: len(self.program.states)] -= known.numbers.R @ known.u
        return s

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
        now.seen = None if self._run is None else self._run.largest
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
            self._rubbing.rub(now, mode, checked)
        rate = np.zeros(self.size)
        rate[:n] = numbers.P @ now.x + numbers.Q @ now.u
        if program.varying:
            rate[:n] += numbers.R @ now.du
        rate[n : n + own] = now.y[list(program.law_rates)]
        rate += self._rubbing.correction(mode, rate, now.du, numbers)
        return Snapshot(now.x, z, now.u, now.du, now.y, rate, now.caps, w, numbers)

    def affine_map(self, mode: Mode, inputs: int) -> AffineMap | None:
        """An affine mode's matrix; None for other models, and where redundant ports share a load."""
        if not self.program.affine:
            return None
        if mode not in self._maps:
            redundant = 0 in mode and self.hold(mode, self.constant).shares
            self._maps[mode] = None if redundant else self._affine_map(mode, inputs)
        return self._maps[mode]

    @cached_property
    def sharp_rates(self) -> Pair | None:
        """The rates of s over [s, w, dw, 1] of an affine model without friction, with 32 digits."""
        affine = None if self.program.friction else self.affine_map((), len(self.program.external))
        if affine is None:
            return None
        try:
            return sharp_rates(self.program, self.parameters)
        except NotAffineError:
            return pair(affine.rows(RATE))

    def _affine_map(self, mode: Mode, inputs: int) -> AffineMap:
        def point(v: Array) -> list[Array]:
            s, w, dw = np.split(v, [self.size, self.size + inputs])
            now = self.evaluate(0.0, s, w, dw, mode, checked=False)
            return [now.x, now.z, now.u, now.du, now.y, now.rate, now.caps]

        affine = probed(point, self.size + 2 * inputs, RATE)
        check_finite(affine.rows(INPUTS), affine.matrix, self.program.inputs)
        rate, du = affine.rows(RATE), affine.rows(RATES_OF_INPUTS)
        rate += self._rubbing.correction(mode, rate, du, self.constant)
        return affine

    def _give(self, now: Instant, group: Group, function: Evaluation) -> None:
        """Evaluate one group of laws, or solve it if it is a loop."""
        columns, D = list(group.inputs), now.numbers.D
        if group.loop:
            rows = list(group.readings)
            solve_loop(now, columns, rows, D, lambda at: at.u[columns] - function(at), group.ports)
        else:
            now.give(columns, function(now), D)

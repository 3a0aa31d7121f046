"""The closed model in numbers: at any time, state and friction mode, every input, reading and rate.

The integrated vector is ``s = [xi, z]``: ``xi = x - A^-1 E u`` stays continuous when an input that
drives a dependent storage steps; z are the states that laws own.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from copy import copy
from functools import cached_property, partial
from types import MappingProxyType

import numpy as np

from bondgraph.equations import StateEquations
from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece, are_same
from codegen.model.commands import Command, commands
from codegen.model.exact_values import exact_parameters
from codegen.model.instant import Binding
from codegen.model.moves import Moves, moves
from codegen.model.numbers import assembled, check_values, numbers
from codegen.model.sharp import NotAffineError, sharp_rates
from codegen.model.snapshot import Mode, Run, Snapshot
from codegen.modes.maps import AffineMaps
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest
from codegen.numbers.pairs import Pair, pair
from codegen.ports.forming import formed, rubbing
from codegen.ports.refusals import refusals
from codegen.ports.slips import slip_rows
from codegen.program.affine import AffineMap, probed
from codegen.program.driven import opposed_ports, timed_ports
from codegen.program.gains import check_gains
from codegen.program.layout import (
    CAPS,
    RATE,
    READINGS,
    widths,
)
from codegen.program.records import Program
from codegen.standalone.bending import exchanged
from codegen.standalone.evaluation import Point, evaluated, vector
from codegen.standalone.friction import Friction
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Instant
from codegen.standalone.levels import without_rounding
from codegen.standalone.matrices import Numbers
from codegen.standalone.striking import Strike
from codegen.standalone.switchings import Reset
from codegen.straight.modes import Plain, StraightModes
from codegen.straight.recording import Changing

NONE: Array = np.zeros(0)


class ClosedModel:
    """Equations, laws and parameters bound together; a function of time, state, inputs and mode."""

    def __init__(
        self, program: Program, equations: StateEquations, parameters: Mapping[str, object]
    ) -> None:
        exact = MappingProxyType(exact_parameters(parameters))
        self.program, self.equations, self.parameters = program, program.equations, exact
        #: The equations as declared.
        self.declared = equations
        check_gains(program, exact)
        self._rated = program.rated
        self.friction_inputs = [port.input for port in program.friction]
        self.friction_readings = [port.reading for port in program.friction]
        self.moving = np.array(
            [-1 if port.moving is None else port.moving for port in program.friction], dtype=int
        )
        #: Whether slips have factors that move.
        self.bent = bool((self.moving >= 0).any())
        self.law_rates = np.array(program.law_rates, dtype=np.intp)
        #: Of each port that is a switch when it changes over, None of the others.
        self.switching = [port.switch for port in program.friction]
        #: The places of switches; of those with conditions of their own; of those that time alone drives, of
        #: these of those that go either way by one condition; and whether there is friction beside.
        self.switches = [i for i, switch in enumerate(self.switching) if switch is not None]
        self.guarded = frozenset(
            i for i, switch in enumerate(self.switching) if switch is not None and not switch.side
        )
        #: The places of stops.
        self.stopping = [i for i, switch in enumerate(self.switching) if switch and switch.stops]
        #: The places among the guards of what tasks set, which no mode hangs on.
        self.ticked = tuple(one.value for one in program.resets if one.port < 0)
        #: Jumps of second order, with the guards that they hang on.
        self.hung = dict(program.hanging)
        self.timed = timed_ports(program)
        self.opposed = opposed_ports(program, self.timed)
        self.rubbing = len(self.switches) < len(program.friction)
        binding = Binding(program, exact)
        self._bind(binding)
        self._constant = None if program.varying else numbers(program, self.equations, exact)
        if program.varying:
            check_values(self.equations, exact)
        #: What friction ports receive, exact.
        self.slips = slip_rows(program, self.equations, exact)
        self._evaluate_by(binding)
        #: Of affine models the maps of modes in which no load is shared.
        self.maps = AffineMaps(program, self._form, self._friction, self._constant)
        self._guard_maps = Latest[Mode, Array]()
        self._mixing = Latest[Mode, bool]()
        self._hung_rows: Array | None = None
        self._moves: tuple[Numbers, Moves] | None = None
        self._on_sides: Latest[tuple[int, ...], ClosedModel] = Latest()
        #: The model whose laws these are on one side of each corner.
        self._plain: ClosedModel | None = None
        self._run: Run | None = None
        #: The latest time, pieces, external inputs and rates: an instant is looked at many times.
        self._latest: tuple[float, tuple[Piece, ...], Array, Array] = (np.nan, (), NONE, NONE)

    def within(self, run: Run) -> "ClosedModel":
        """The same model in a run: a level that a state rules rounds by what that state has been there."""
        made = copy(self)
        made._run, made._on_sides = run, Latest()
        return made

    def on_sides(self, sides: tuple[int, ...]) -> "ClosedModel":
        """The same with laws on one side of each corner: 1 above what it hangs on is zero, -1 below."""
        return self._on_sides.of(sides, lambda: self._with_sides(sides))

    def _with_sides(self, sides: tuple[int, ...]) -> "ClosedModel":
        made = copy(self)
        made.program, made._moves, made._plain = self.program.on_sides, None, self
        binding = Binding(made.program, self.parameters, sides)
        made._bind(binding)
        made._evaluate_by(binding, self._friction)
        return made

    def _bind(self, binding: Binding) -> None:
        program = self.program
        self._guards = binding.function(program.guards)
        self._coefficients = binding.function(program.coefficients)
        #: What corners hang on, and for each whether it counts.
        self.corners = None if program.corners is None else binding.function(program.corners.values)

    def _evaluate_by(self, binding: Binding, plain: Friction | None = None) -> None:
        self._form = formed(self.program, binding, self.numbers)
        self._friction = rubbing(self.program, binding, self._form, self.slips, plain)
        looks = {"guards": self._guards}
        if self.corners is not None:
            looks["corners"] = self.corners
        matrices: Numbers | Changing | None = self._constant
        if matrices is None:
            matrices = Changing(self._coefficients, partial(assembled, self.program))
        self.straight = StraightModes(self.program, self._form, self._friction, matrices, looks)

    def place_name(self, place: int) -> str:
        """What a place in the integrated vector is called."""
        return str((*self.program.states, *self.program.law_states)[place])

    def largest(self, s: Array) -> Array:
        """The magnitudes that the integrated vector's components have reached, of a run; else these."""
        return np.abs(s) if self._run is None else np.maximum(np.abs(s), self._run.largest)

    @property
    def constant(self) -> Numbers:
        """The matrices of a model whose coefficients don't change."""
        if self._constant is None:
            raise SimulationError("the coefficients of this model change in time")
        return self._constant

    @property
    def size(self) -> int:
        """The length of the integrated vector; at least 1, so that integrators have something."""
        return self.program.size

    def coupled_directly(self, port: int) -> bool:
        """Whether a friction port's slip depends at once on efforts of friction ports."""
        return self._friction.ports.beside[port]

    def hold(self, mode: Mode, numbers: Numbers) -> Hold:
        """The holding equations of the ports that stick in a mode, with the matrices of an instant."""
        with refusals():
            return self._friction.hold(mode, numbers)

    def exchange(self, mode: Mode, now: Instant, aims: Array | None = None) -> Strike:
        """The impulses of what a mode holds, at an instant with all let go; ``aims``: of slips."""
        if self._plain is not None:
            return self._plain.exchange(mode, now, aims)
        with refusals():
            return exchanged(self._form, lambda at: self._friction.hold(mode, at), now, aims)

    def momenta(self, now: Instant) -> Array | None:
        """What storages hold of each state; None where slopes are the same whatever jumps."""
        formula = (self._plain or self)._form.momenta
        return None if formula is None else formula(now)[: len(now.x)]

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
            f"{now.z.tolist()}{self._turned}"
        )

    @property
    def _turned(self) -> str:
        """Which laws are turned round, and so may have no value for what they receive."""
        elements = self.equations.elements.values()
        names = ", ".join(repr(one.name) for one in elements if one.turned)
        told = f"; the law of {names} is turned round: it may have no value for what it never gives"
        return told if names else ""

    def at(self, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Snapshot:
        """Every variable at one time, with the inputs' pieces and the friction mode given.

        Where a law has no value beyond a corner, as `sqrt(abs(p))` beyond zero, it is the law as it is.
        """
        w, dw = self.given(t, pieces)
        if self._plain is not None:
            return self._on_a_side(t, s, pieces, mode) or self._plain.at(t, s, pieces, mode)
        if self.program.affine:
            affine = self.affine_map(mode, len(w))
            if affine is not None:
                x, z, u, du, y, rate, caps = affine(s, w, dw)
                if affine.limited and caps.min() < 0:
                    caps = without_rounding(caps, affine.terms(CAPS, self.largest(s), w, dw))
                if not affine.limited or caps.min() >= 0:
                    return Snapshot(x, z, u, du, y, rate, caps, w, self.constant)
        return self.evaluate(t, s, w, dw, mode)

    def _on_a_side(
        self, t: float, s: Array, pieces: Sequence[Piece], mode: Mode
    ) -> Snapshot | None:
        """The same by laws on one side of each corner; None where they have no value."""
        try:
            found = self.evaluate(t, s, *self.given(t, pieces), mode)
        except SimulationError:
            return None
        finite = all(bool(np.isfinite(part).all()) for part in (found.rate, found.u, found.y))
        return found if finite else None

    def vector(self, t: float, state: Array, given: Array) -> Array:
        """The integrated vector at a state: x less what inputs that drive dependent storages add."""
        s = np.zeros(self.size)
        s[: len(state)] = state
        with refusals():
            return vector(self._form, t, s, given, np.zeros(len(given)))

    def guards(self, t: float, now: Snapshot) -> Array:
        """The conditions of switches at an instant, to turn on and to turn off in turn."""
        return self.guards_at(now.instant(t))

    def guards_at(self, now: Instant) -> Array:
        """The same of an instant as formulas see it."""
        values = self._guards(now)
        if not np.isfinite(values).all():
            raise self._no_value(now.t, int(np.argmin(np.isfinite(values))))
        return values

    def _no_value(self, t: float, at: int) -> SimulationError:
        """Whose condition has no finite value, or what is reset to none."""
        ports = self.program.friction
        for one in self.program.resets:
            if one.value == at:
                what = f"what {self.owner(one)!r} resets {self.place_name(one.place)} to"
                return SimulationError(f"at t = {t:.9g} {what} has no finite value")
        name = next(p.name for p in ports if p.switch and p.switch.guard in (at, at - 1))
        return SimulationError(
            f"at t = {t:.9g} the condition of switch {name!r} has no finite value"
        )

    def owner(self, one: Reset) -> Hashable:
        """Whose reset it is: a port's, or a task's."""
        program = self.program
        if one.port >= 0:
            return program.friction[one.port].name
        return program.equations.tasks[-1 - one.port].name

    def taken_by(self, fired: Sequence[Reset]) -> str:
        """The state machines whose transitions these resets are of, and these; nothing of others."""
        ports = [self.program.friction[one.port] for one in fired if one.port >= 0]
        taken = dict.fromkeys(one.transition for one in ports if one.transition is not None)
        return ", ".join(f"{one.machine.name!r} ({one.words})" for one in taken)

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """The commands of switches that go by one alone."""
        return commands(self.equations, self.parameters)

    @cached_property
    def timed_guards(self) -> Array:
        """The conditions of switches over [w, 1], as far as these rule them."""
        program, zeros = self.program, np.zeros

        def point(w: Array) -> list[Array]:
            x, z, u, du, y = (zeros(size) for size in widths(program)[: READINGS + 1])
            u[program.given], still = w[: len(program.given)], zeros(len(w))
            return [self._guards(Instant(0.0, x, z, u, du, y, w, still, still))]

        return probed(point, len(program.external), 0).matrix

    def moves(self, numbers: Numbers) -> Moves:
        """How slips change, with the matrices of an instant."""
        if self._moves is None or numbers is not self._moves[0]:
            found = moves(numbers, self.friction_readings, self.friction_inputs)
            self._moves = numbers, found
        return self._moves[1]

    def hangs_on(self, t: float, now: Snapshot) -> Array:
        """What tells on which side each port is: its slip, of jumps of second order what they hang on."""
        found: Array = now.y[self.friction_readings]
        if self.hung:
            found[list(self.hung)] = self.guards(t, now)[list(self.hung.values())]
        return found

    def hung_rows(self, now: Snapshot) -> Array:
        """What jumps of second order hang on, as rows over [s, 1]: these do not change."""
        if self._hung_rows is None:
            states, size = len(now.x), self.size

            def point(s: Array) -> list[Array]:
                y = now.numbers.F @ s[:states]
                zero, w = np.zeros(len(now.u)), np.zeros(len(now.external))
                still = now._replace(x=s[:states], z=s[states:], u=zero, du=zero, y=y, external=w)
                return [self._guards(still.instant(0.0))[list(self.hung.values())]]

            self._hung_rows = probed(point, size, 0).matrix
        return self._hung_rows

    def guard_rows(self, mode: Mode, inputs: int) -> Array | None:
        """The conditions of switches in a mode as rows over [s, w, w', 1]; None where they are not affine."""
        affine = self.affine_map(mode, inputs)
        if affine is None or not self.program.guards_affine:
            return None
        size, program = self.size, self.program
        if not program.guards.results:
            return np.zeros((0, size + 2 * inputs + 1))

        def point(v: Array) -> list[Array]:
            s, w, dw = np.split(v, [size, size + inputs])
            x, z, u, du, y, rate, caps = affine(s, w, dw)
            now = Snapshot(x, z, u, du, y, rate, caps, w, self.constant)
            found = self._guards(now.instant(0.0))
            if not program.ticks_affine:
                found[list(self.ticked)] = 0.0
            return [found]

        return self._guard_maps.of(mode, lambda: probed(point, size + 2 * inputs, 0).matrix)

    def given(self, t: float, pieces: Sequence[Piece]) -> tuple[Array, Array]:
        """The external inputs, and their rates where anything asks for them; read-only."""
        latest = self._latest
        if latest[0] == t and are_same(latest[1], pieces):
            return latest[2], latest[3]
        w, dw = np.array([piece(t) for piece in pieces]), np.zeros(len(pieces))
        if self._rated:
            dw = np.array([piece.derivative(t) for piece in pieces])
        w.setflags(write=False)
        dw.setflags(write=False)
        self._latest = t, tuple(pieces), w, dw
        return w, dw

    def rates(self, pieces: Sequence[Piece], mode: Mode) -> Callable[[float, Array], Array]:
        """The rate of s in a mode as a function of t and s; quicker than `at`, which gives all else too."""
        affine = self.affine_map(mode, len(pieces))
        if affine is None:
            plain = self.plainly(pieces, mode, "rate")

            def found(t: float, s: Array) -> Array:
                values = None if plain is None else plain(t, s)
                # Where that has no value the evaluation tells why.
                return (
                    self.at(t, s, pieces, mode).rate
                    if values is None
                    else np.array(values, dtype=float)
                )

            return found
        rows = np.ascontiguousarray(affine.rows(RATE))
        one = (1.0,)

        def rate(t: float, s: Array) -> Array:
            return np.asarray(rows @ np.concatenate((s, *self.given(t, pieces), one)))

        return rate

    def plainly(self, pieces: Sequence[Piece], mode: Mode, *parts: str) -> Plain | None:
        """Parts of an instant in a mode as numbers; None of affine modes, and where none are written."""
        fast = None if self.program.affine else self.straight.of(mode)
        return None if fast is None else fast.under(pieces, self._rated, *parts)

    def slopes(
        self, pieces: Sequence[Piece], mode: Mode
    ) -> Callable[[float, Array], Array | None] | None:
        """The slopes of the rates in s in a mode as a function of t and s, which gives None where there is
        no value; None of affine modes, and where laws are solved for."""
        fast = None if self.program.affine else self.straight.of(mode)
        if fast is None or fast.slopes is None:
            return None
        mode_slopes, (rows, columns) = fast.slopes
        plain = mode_slopes.under(pieces, self._rated, "slopes")

        def found(t: float, s: Array) -> Array | None:
            values = plain(t, s)
            if values is None:
                return None
            matrix = np.zeros((len(s), len(s)))
            matrix[rows, columns] = values
            return matrix

        return found

    def evaluate(
        self, t: float, s: Array, w: Array, dw: Array, mode: Mode, checked: bool = True
    ) -> Snapshot:
        """As `at`, from the external inputs' values and rates; ``checked``: friction levels, for sign."""
        contact = self._friction if self.program.friction else None
        seen = None if self._run is None else self._run.largest
        with refusals():
            now = evaluated(self._form, contact, Point(t, s, w, dw, seen), mode, checked)
        return Snapshot(now.x, now.z, now.u, now.du, now.y, now.rate, now.caps, w, now.numbers)

    def affine_map(self, mode: Mode, inputs: int) -> AffineMap | None:
        """An affine mode's matrix; None for other models, and where redundant ports share a load."""
        return self.maps.of(mode, inputs) if self.program.affine else None

    def let_go_map(self, mode: Mode, inputs: int) -> AffineMap | None:
        """The same with all that a mode holds let go, friction slipping forwards there."""
        return self.maps.let_go(mode, inputs) if self.program.affine else None

    def stops(self, mode: Mode) -> bool:
        """Whether what a mode holds stops combinations of slips that states have."""
        if self.program.varying:
            return bool(0 in mode)
        return self._mixing.of(mode, lambda: len(self.hold(mode, self.constant).mix) > 0)

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

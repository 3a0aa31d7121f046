"""A model's friction modes as the tables that the C engine steps by."""

from contextlib import suppress
from typing import Any

import numpy as np

from bondgraph.errors import SimulationError
from codegen.engine.filling import Filling
from codegen.engine.handing import asked_by_c
from codegen.engine.kin import Kin
from codegen.engine.motions import Motion, Motions
from codegen.engine.places import FEWEST, Places
from codegen.engine.sizes import DIGITS, Engine, view
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import becoming, impacts_of, keeping
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError
from codegen.program.affine import AffineMap


class Tables:
    """The engine's record of a model; modes are worked out as runs ask for them."""

    def __init__(self, engine: Engine, model: ClosedModel) -> None:
        self.engine, self.model = engine, model
        self.record = engine.new("ex_model")
        self.places = Places(engine, self.record)
        self._motions, self._spectral = Motions(model.size), False
        moved = _slips_moved(model)
        self._fill_by = Filling(engine, model, moved)
        self._kin = Kin(self.places, model)
        self.failed: BaseException | None = None
        with suppress(MemoryError):  # on machines that let no code be made, runs begin again
            self._answer = asked_by_c(
                engine.ffi, "int(void *, const int *)", self._asked, self._keep
            )
            self.record.supply = self._answer
        self._magnitudes(*moved[:2])
        self.record.switched = model.program.switched
        self.record.stopping, self.record.hung = model.program.stopped, len(model.hung)
        self._fill_stops()
        for at, port in enumerate(model.program.friction):
            self.record.own[at] = port.input
            self.record.switches[at] = port.in_c
        for at, one in enumerate(model.program.resets):
            self.record.resets[at] = (one.port, one.sign, one.place, one.value)
        for at, clock in enumerate(model.program.clocks):
            self.record.clocks[at] = (clock.every, clock.offset, clock.unit)

    def _fill_stops(self) -> None:
        """The gaps of stops where all states are zero, and their restitutions."""
        model = self.model
        if not model.stopping:
            return
        program = model.program
        x, z, u, y = map(
            np.zeros,
            map(len, (program.states, program.law_states, program.inputs, program.readings)),
        )
        w = np.zeros(len(program.external))
        told = model.guards(0.0, Snapshot(x, z, u, u, y, w, w, w, model.constant))
        for i in model.stopping:
            one = model.switching[i]
            assert one is not None
            self.record.room[i], self.record.back[i] = told[one.guard], told[one.guard + 1]

    @property
    def room(self) -> bool:
        """Whether there is room for one more mode, and none forgotten for it."""
        return self.places.kept < self.places.most

    def _asked(self, _: Any, mode: Any) -> int:
        """Work out the mode that a run has come to; 1 where that is not done."""
        if self.places.most < FEWEST:
            return 1
        self.supply(tuple(mode[i] for i in range(self.engine.sizes.K)))
        return 0

    def _keep(self, error: BaseException) -> None:
        self.failed = error

    def mode_at(self, key: Any) -> Mode:
        """The mode of a number with two bits for each port, the first port the lowest."""
        ports = range(self.engine.sizes.K)
        return tuple((0, 1, -1)[key.digits[i // DIGITS] >> i % DIGITS * 2 & 3] for i in ports)

    def supply(self, mode: Mode) -> None:
        """Work out a mode."""
        kin = self._kin.of(mode)
        made = self._new(mode) if kin is None else self.engine.copy(kin)
        if made.supported and self._kin.are_alike:
            self._turn(made, mode)
        self.places.put(mode, made)

    def _turn(self, made: Any, mode: Mode) -> None:
        """Write what friction's way of slipping moves: the same digits, whether from kin or not."""
        model, columns = self.model, self._kin.columns
        affine = model.maps.turned(mode, len(model.program.external), columns)
        self._fill_by.shot(made, affine, columns)
        if 0 in mode:
            self._fill_by.left(made, model.hold(mode, model.constant), affine, columns)

    def _new(self, mode: Mode) -> Any:
        made, inputs = self.engine.new("ex_mode"), len(self.model.program.external)
        try:
            affine = self.model.affine_map(mode, inputs)
        except SlopeNeededError:
            affine = None
        except SimulationError:
            affine, made.none = None, 1
        if affine is not None:
            self._fill(made, mode, affine)
        elif not made.none and self._rule(made, mode):
            # What rules the slips does not depend on what holds them.
            slipping = self.model.affine_map(tuple(sign or 1 for sign in mode), inputs)
            if slipping is not None:
                self._fill_by.shot(made, slipping)
        self._join(made, mode)
        return made

    def sharpen(self) -> None:
        """Tell rates that a run wants: without friction with 32 digits, else of all modes from now on."""
        if self.model.program.friction:
            self._spectral = True
            for mode, made in self.places.made():
                if made.supported:
                    affine = self.model.affine_map(mode, len(self.model.program.external))
                    assert affine is not None
                    self._tell_rates(made, self._motions.of(affine))
            return
        ((_, made),), rates = self.places.made(), self.model.sharp_rates
        if rates is not None:
            for field, part in ((made.rate, rates.hi), (made.rest, rates.lo)):
                self._fill_by.rows(field, part)
            made.sharp = 1

    def _tell_rates(self, made: Any, motion: Motion) -> None:
        """The rates of s by itself, which take long: where any run has asked for them."""
        made.rates = -1
        if self._spectral:
            found = motion.spectrum
            made.rates = len(found)
            view(self.engine, made.spectrum, -1, 2)[: len(found)] = found

    def _magnitudes(self, by_states: Array, by_inputs: Array) -> None:
        """Magnitudes that rounding is told from; the two: of how fast slips change."""
        model, numbers, engine = self.model, self.model.constant, self.engine
        n, m, K = len(model.program.states), len(model.program.inputs), engine.sizes.K
        rows = model.friction_readings
        F, D = numbers.F[rows], numbers.D[rows]
        for name, matrix in (
            ("F", F), ("D", D), ("FP", by_states), ("FQ", by_inputs),
            ("P", numbers.P), ("Q", numbers.Q),
        ):  # fmt: skip
            field = getattr(self.record, name)
            columns = view(engine, field, len(field), -1)
            columns[: matrix.shape[1], : matrix.shape[0]] = np.abs(matrix).T
        for i, column in enumerate(model.friction_inputs):
            own = abs(float(F[i] @ numbers.Q[:, column])) + abs(float(D[i, column]))
            self.record.inertia[i] = own if n and m else 0.0
            self.record.coupled[i] = model.coupled_directly(i)
        assert len(rows) == K

    def _rule(self, made: Any, mode: Mode) -> bool:
        """Write what only inputs rule of the slips that stick; whether there is such a thing."""
        held = [i for i, sign in enumerate(mode) if sign == 0]
        try:
            rows = self.model.hold(mode, self.model.constant).ruled if held else np.zeros((0, 0))
        except SimulationError:
            return False
        made.ruled = len(rows)
        for k, row in enumerate(rows):
            view(self.engine, made.ruling[k])[held] = row
        return len(rows) > 0

    def _join(self, made: Any, mode: Mode) -> None:
        """Mark ports alike that have part in what none of them rules alone."""
        held = [i for i, sign in enumerate(mode) if sign == 0]
        try:
            share = self.model.hold(mode, self.model.constant).share if held else np.zeros((0, 0))
        except SimulationError:
            share = np.ones((1, len(held)))
        for k, row in enumerate(share, 1):
            ports = [held[c] for c in np.flatnonzero(row)]
            before = {made.joined[i] for i in ports} - {0}
            for i in {*ports, *(i for i in held if made.joined[i] in before)}:
                made.joined[i] = k

    def _fill(self, made: Any, mode: Mode, affine: AffineMap) -> None:
        model, size = self.model, self.engine.sizes.numbers
        self._fill_by.shot(made, affine)
        self._rule(made, mode)
        made.supported = 1
        motion = self._motions.of(affine)
        made.fastest = motion.fastest
        view(self.engine, made.weight)[:] = motion.weight
        self._tell_rates(made, motion)
        if model.program.resets:
            self._fill_by.rows(made.become, becoming(model, mode, affine))
        if model.program.guarded:
            self._fill_switches(made, mode, affine)
        if 0 in mode:
            held = model.hold(mode, model.constant)
            self._fill_by.left(made, held, affine)
            away = view(self.engine, made.take_away, -1, size["N"])
            away[: made.held, : len(held.take_away)] = held.take_away.T
            view(self.engine, made.mix, size["PORTS"], -1)[: made.held, held.ports] = held.mix

    def _fill_switches(self, made: Any, mode: Mode, affine: AffineMap) -> None:
        """What keeps switches; where friction slips forwards also what they do as they come to hold."""
        model, size = self.model, self.engine.sizes.numbers
        self._fill_by.rows(made.stay, keeping(model, mode, affine))
        if any(sign != 1 and s is None for sign, s in zip(mode, model.switching, strict=True)):
            return
        found = impacts_of(model, mode)
        if found is None:
            return
        for name, part in (("jump", found.jump), ("shock", found.shock), ("blow", found.given)):
            table = view(self.engine, getattr(made, name), size["PORTS"], -1)
            table[: part.shape[0], : part.shape[1]] = part


def _slips_moved(model: ClosedModel) -> tuple[Array, Array, Array]:
    """How fast slips change, by states, inputs and their rates: F x' + D u'."""
    numbers, rows = model.constant, model.friction_readings
    F, D = numbers.F[rows], numbers.D[rows]
    return F @ numbers.P, F @ numbers.Q, F @ numbers.R + D

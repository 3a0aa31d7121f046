"""A model's friction modes as the tables that the C engine steps by."""

from contextlib import suppress
from typing import Any

import numpy as np
import scipy

from bondgraph.errors import SimulationError
from codegen.engine.sizes import DIGITS, Engine, view
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import impacts_of, keeping
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError
from codegen.program.affine import AffineMap
from codegen.program.layout import CAPS, INPUTS, RATE, RATES_OF_INPUTS, READINGS, SHOT, STATES

MOST_ROOM = 1 << 29
"""Bytes that the modes of a model may take."""


class Tables:
    """The engine's record of a model; modes are worked out as runs ask for them.

    ``known``: those that have been, in the order of the record.
    """

    def __init__(self, engine: Engine, model: ClosedModel) -> None:
        self.engine, self.model = engine, model
        self.record = engine.new("ex_model")
        self.known: list[Mode] = []
        self._made: list[Any] = []
        words, first = engine.sizes.numbers["WORDS"], 32
        self._keys = np.zeros((first, words), dtype=np.uint64)
        self._places = np.zeros(first, dtype=np.uintp)
        self._point()
        self.failed: BaseException | None = None
        with suppress(MemoryError):  # on machines that let no code be made, runs begin again
            self._answer = engine.ffi.callback("int(void *, const int *)", self._asked)
            self.record.supply = self._answer
        self._magnitudes()
        self.record.switched = model.program.switched
        for at, port in enumerate(model.program.friction):
            self.record.own[at] = port.input
            self.record.switches[at] = port.in_c

    @property
    def room(self) -> bool:
        """Whether there is room for one more mode."""
        return bool((len(self.known) + 1) * self.engine.ffi.sizeof("ex_mode") <= MOST_ROOM)

    def _asked(self, _: Any, mode: Any) -> int:
        """Work out the mode that a run has come to; 1 where that is not done."""
        try:
            if self.room:
                self.supply(tuple(mode[i] for i in range(self.engine.sizes.K)))
                return 0
        except BaseException as error:  # noqa: BLE001 - C comes between here and who is to be told
            self.failed = error
        return 1

    def mode_at(self, key: Any) -> Mode:
        """The mode of a number with two bits for each port, the first port the lowest."""
        ports = range(self.engine.sizes.K)
        return tuple((0, 1, -1)[key.digits[i // DIGITS] >> i % DIGITS * 2 & 3] for i in ports)

    def supply(self, mode: Mode) -> None:
        """Work out a mode."""
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
                self._fill_shot(made, slipping)
        self._join(made, mode)
        self._made.append(made)
        self._list(mode)

    def _list(self, mode: Mode) -> None:
        """Tell C of one more mode."""
        ffi, at = self.engine.ffi, len(self.known)
        if at == len(self._keys):
            self._keys = np.concatenate([self._keys, np.zeros_like(self._keys)])
            self._places = np.concatenate([self._places, np.zeros_like(self._places)])
            self._point()
        for i, sign in enumerate(mode):
            self._keys[at, i // DIGITS] |= np.uint64(sign % 3 << i % DIGITS * 2)
        self._places[at] = int(ffi.cast("uintptr_t", self._made[at]))
        self.known.append(mode)
        self.record.count = len(self.known)

    def _point(self) -> None:
        ffi = self.engine.ffi
        self.record.keys = ffi.cast("ex_key *", self._keys.ctypes.data)
        self.record.modes = ffi.cast("ex_mode **", self._places.ctypes.data)

    def sharpen(self) -> None:
        """Work out the rates of the one mode of a model in which nothing is watched, with 32 digits."""
        made, rates = self._made[0], self.model.sharp_rates
        if rates is not None:
            size = self.engine.sizes.numbers
            for field, part in ((made.rate, rates.hi), (made.rest, rates.lo)):
                view(self.engine, field, size["L"], size["N"])[:] = self._wide(part).T
            made.sharp = 1

    def _magnitudes(self) -> None:
        model, numbers, engine = self.model, self.model.constant, self.engine
        n, m, K = len(model.program.states), len(model.program.inputs), engine.sizes.K
        rows = model.friction_readings
        F, D = numbers.F[rows], numbers.D[rows]
        for name, matrix in (
            ("F", F), ("D", D), ("FP", F @ numbers.P), ("FQ", F @ numbers.Q),
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

    def _fill_shot(self, made: Any, affine: AffineMap) -> None:
        model, size = self.model, self.engine.sizes.numbers
        parts = _parts(model, affine)
        at, lengths = 0, (size["X"], size["U"], *[size["PORTS"]] * 4, size["N"])
        shot = view(self.engine, made.shot, size["L"], size["SHOT"])
        for rows, length in zip(parts, lengths, strict=True):
            shot[:, at : at + len(rows)] = self._wide(rows).T
            at += length

    def _fill(self, made: Any, mode: Mode, affine: AffineMap) -> None:
        model, size = self.model, self.engine.sizes.numbers
        self._fill_shot(made, affine)
        self._rule(made, mode)
        made.supported = 1
        made.fastest = affine.fastest
        found = np.array(affine.spectrum)
        made.rates = len(found)
        view(self.engine, made.spectrum, -1, 2)[: len(found)] = np.column_stack(
            [abs(found), -found.real]
        )
        own = affine.rows(RATE)[:, : model.size]
        scale = scipy.linalg.matrix_balance(own, permute=False, separate=True)[1][0]
        view(self.engine, made.weight)[:] = 1 / scale
        if model.program.switched:
            self._fill_switches(made, mode, affine)
        if 0 in mode:
            held = model.hold(mode, model.constant)
            rest = held.slip_x @ affine.rows(STATES) + held.slip_u @ affine.rows(INPUTS)
            made.held = len(rest)
            view(self.engine, made.left, size["L"], -1)[:, : len(rest)] = self._wide(rest).T
            away = view(self.engine, made.take_away, -1, size["N"])
            away[: len(rest), : len(held.take_away)] = held.take_away.T
            view(self.engine, made.mix, size["PORTS"], -1)[: len(rest), held.ports] = held.mix

    def _fill_switches(self, made: Any, mode: Mode, affine: AffineMap) -> None:
        """What keeps switches; where friction slips forwards also what they do as they come to hold."""
        model, size = self.model, self.engine.sizes.numbers
        stay = view(self.engine, made.stay, size["L"], -1)
        rows = keeping(model, mode, affine)
        stay[:, : len(rows)] = self._wide(rows).T
        if any(sign != 1 and s is None for sign, s in zip(mode, model.switching, strict=True)):
            return
        found = impacts_of(model, mode)
        if found is None:
            return
        for name, part in (("jump", found.jump), ("shock", found.shock)):
            table = view(self.engine, getattr(made, name), size["PORTS"], -1)
            table[: part.shape[0], : part.shape[1]] = part

    def _wide(self, rows: Array) -> Array:
        """Rows over (s, w, w', 1), with columns for an input where there is none."""
        n, w, W = self.model.size, len(self.model.program.external), self.engine.sizes.W
        wide = np.zeros((len(rows), n + 2 * W + 1))
        wide[:, : n + w] = rows[:, : n + w]
        wide[:, n + W : n + W + w] = rows[:, n + w : n + 2 * w]
        wide[:, -1] = rows[:, -1]
        return wide


def _parts(model: ClosedModel, affine: AffineMap) -> list[Array]:
    """The rows of each part of the engine's snapshot, in their order."""
    numbers, readings = model.constant, model.friction_readings
    x, u, du = (affine.rows(part) for part in (STATES, INPUTS, RATES_OF_INPUTS))
    moving = numbers.P @ x + numbers.Q @ u + numbers.R @ du
    pushes = numbers.F[readings] @ moving + numbers.D[readings] @ du
    efforts, slips = u[model.friction_inputs], affine.rows(READINGS)[readings]
    found = {
        "x": x, "u": u, "slip": slips, "effort": efforts, "cap": affine.rows(CAPS), "push": pushes,
        "rate": affine.rows(RATE),
    }  # fmt: skip
    return [found[part] for part in SHOT]

"""The affine maps of a model's modes: where that tells all, from the one in which friction slips forwards."""

import numpy as np

from codegen.model.affine_modes import LetGo, in_mode, let_go, told
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest, room_for
from codegen.ports.refusals import refusals
from codegen.program.affine import AffineMap, check_finite, probed
from codegen.program.layout import INPUTS, RATE, widths
from codegen.program.records import Program
from codegen.standalone.arrays import Places
from codegen.standalone.evaluation import Form, Point, evaluated
from codegen.standalone.friction import Friction
from codegen.standalone.holding import Hold
from codegen.standalone.matrices import Numbers


class AffineMaps:
    """The latest maps of an affine model; ``numbers``: its matrices, None of one whose matrices change.

    Where no law reads what friction and switches give, all are made from one of them.
    """

    def __init__(
        self, program: Program, form: Form, friction: Friction, numbers: Numbers | None
    ) -> None:
        self._program, self._form = program, form
        self._friction, self._numbers = friction, numbers
        room = room_for(sum(widths(program)) * program.size)
        self._maps = Latest[Mode, AffineMap | None](room)
        self._loose = Latest[Mode, AffineMap | None](room)
        self._bases: dict[int, LetGo] = {}

    def of(self, mode: Mode, inputs: int) -> AffineMap | None:
        """A mode's map, of so many external inputs; None where redundant ports share a load."""
        return self._maps.of(mode, lambda: self._made(mode, inputs))

    def let_go(self, mode: Mode, inputs: int) -> AffineMap | None:
        """The same with all that a mode holds let go, friction slipping forwards there."""
        return self._loose.of(mode, lambda: self.of(tuple(sign or 1 for sign in mode), inputs))

    def turning(self, inputs: int) -> Places:
        """The columns in which maps differ where the same ports stick, and friction slips other ways."""
        return np.flatnonzero(self._base(inputs).rub.any(axis=0))

    def turned(self, mode: Mode, inputs: int, columns: Places) -> AffineMap:
        """Some columns of the map of a mode that has one."""
        if self._program.late:
            whole = self.of(mode, inputs)
            assert whole is not None
            return AffineMap(whole.sizes, whole.matrix[:, columns], RATE)
        base = self._base(inputs).at(columns)
        return in_mode(base, mode, self._hold(mode), self._program.law_rates)

    def _made(self, mode: Mode, inputs: int) -> AffineMap | None:
        hold = self._hold(mode)
        if hold is not None and hold.shares:
            return None
        if self._program.late:
            assert self._numbers is not None
            probed = self._probed(inputs, mode)
            return told(probed, self._numbers, hold, self._program.law_rates)
        return in_mode(self._base(inputs), mode, hold, self._program.law_rates)

    def _hold(self, mode: Mode) -> Hold | None:
        assert self._numbers is not None
        with refusals():
            return self._friction.hold(mode, self._numbers) if 0 in mode else None

    def _base(self, inputs: int) -> LetGo:
        if inputs not in self._bases:
            assert self._numbers is not None
            ports = [port.input for port in self._program.friction]
            forwards = self._probed(inputs, tuple(1 for _ in ports))
            self._bases[inputs] = let_go(forwards, self._numbers, ports)
        return self._bases[inputs]

    def _probed(self, inputs: int, mode: Mode) -> AffineMap:
        """A mode's map from what the model gives at as many points; laws may read what friction gives."""
        contact = self._friction if self._program.friction else None
        n = self._program.size

        def point(v: Array) -> list[Array]:
            s, w, dw = np.split(v, [n, n + inputs])
            with refusals():
                now = evaluated(self._form, contact, Point(0.0, s, w, dw), mode, checked=False)
            return [now.x, now.z, now.u, now.du, now.y, now.rate, now.caps]

        affine = probed(point, n + 2 * inputs, RATE)
        check_finite(affine.rows(INPUTS), affine.matrix, self._program.inputs)
        return affine

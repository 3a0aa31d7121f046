"""The straight-line functions of a model's modes, each made when it is first asked for."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest, room_for
from codegen.ports.refusals import refusals
from codegen.program.layout import widths
from codegen.program.records import Program
from codegen.standalone.evaluation import Form
from codegen.standalone.friction import Friction
from codegen.standalone.matrices import Numbers
from codegen.straight.functions import Straight, is_writable, over, straight
from codegen.straight.recording import PARTS, recorded
from codegen.straight.sums import Recording


@dataclass(frozen=True)
class StraightMode:
    """What is evaluated in one mode, as functions; `Straight` says of what."""

    recording: Recording

    @cached_property
    def rate(self) -> Straight:
        """The rate of s."""
        return straight(self.recording, ("rate",))

    @cached_property
    def whole(self) -> Straight:
        """All `PARTS` of an instant."""
        return straight(self.recording, PARTS)

    @cached_property
    def ends(self) -> list[int]:
        """Where each part ends among these."""
        ends: list[int] = np.cumsum([len(self.recording.parts[part]) for part in PARTS]).tolist()
        return ends

    def over(self, times: Array, vectors: Array, w: Array, dw: Array) -> dict[str, Array] | None:
        """The parts at many instants, in rows, of given columns; None where one has to be looked at."""
        return over(self.recording, times, vectors, w, dw)


class StraightModes:
    """The latest modes of a model; ``numbers``: its matrices, None of one whose matrices change."""

    def __init__(
        self, program: Program, form: Form, friction: Friction, numbers: Numbers | None
    ) -> None:
        self._form, self._friction, self._numbers = form, friction, numbers
        self._rubs, self._inputs = bool(program.friction), len(program.external)
        #: Whether modes are written at all: matrices stay, and friction is not solved for with laws.
        self._some = numbers is not None and not program.joint
        self._modes = Latest[Mode, StraightMode | None](room_for(100 * sum(widths(program))))

    def of(self, mode: Mode) -> StraightMode | None:
        """A mode; None where ports share a load or cannot hold, or a law is not written over floats."""
        return self._modes.of(mode, lambda: self._made(mode)) if self._some else None

    def _made(self, mode: Mode) -> StraightMode | None:
        assert self._numbers is not None
        if 0 in mode:
            try:
                with refusals():
                    hold = self._friction.hold(mode, self._numbers)
            except SimulationError:
                # An evaluation tells which.
                return None
            if len(hold.share):
                return None
        contact = self._friction if self._rubs else None
        made = recorded(self._form, contact, mode, self._numbers, self._inputs)
        return StraightMode(made) if is_writable(made) else None

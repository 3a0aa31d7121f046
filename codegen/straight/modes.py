"""The straight-line functions of a model's modes, each made when it is first asked for."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.instant import BoundBlock
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
from codegen.straight.inputs import plainly
from codegen.straight.recording import Changing, recorded
from codegen.straight.slopes import Places, with_slopes
from codegen.straight.sums import Recording

Plain = Callable[[float, Array], list[float] | None]
"""From t and s to numbers; None where the evaluation has to tell more."""


@dataclass(eq=False)
class StraightMode:
    """What is evaluated in one mode; functions of parts that were asked for are kept."""

    recording: Recording
    _made: dict[tuple[str, ...], Straight] = field(default_factory=dict)

    def of(self, *parts: str) -> Straight:
        """These parts, one after the other."""
        if parts not in self._made:
            self._made[parts] = straight(self.recording, parts)
        return self._made[parts]

    @cached_property
    def slopes(self) -> tuple["StraightMode", Places] | None:
        """The mode's "slopes" for its parts, and where they stand; None where laws are solved for."""
        made = with_slopes(self.recording)
        return (StraightMode(made[0]), made[1]) if made and is_writable(made[0]) else None

    def under(self, pieces: Sequence[Piece], rated: bool, *parts: str) -> Plain:
        """The same with what the inputs do; ``rated``: whether their rates count."""
        given, made = plainly(pieces, rated), self.of(*parts)

        def plain(t: float, s: Array) -> list[float] | None:
            try:
                return made(float(t), s.tolist(), *given(t))
            except (ArithmeticError, TypeError, ValueError):
                return None

        return plain

    def over(self, times: Array, vectors: Array, w: Array, dw: Array) -> Mapping[str, Array] | None:
        """The parts at many instants, in rows, of given columns; None where one has to be looked at."""
        return over(self.recording, times, vectors, w, dw)


class StraightModes:
    """The latest modes of a model; ``matrices``: as they are, or as they change.

    ``looks``: what else is asked of an instant, by name.
    """

    def __init__(
        self, program: Program, form: Form, friction: Friction, matrices: Numbers | Changing,
        looks: Mapping[str, BoundBlock],
    ) -> None:  # fmt: skip
        self._form, self._friction, self._matrices = form, friction, matrices
        self._rubs, self._inputs, self._looks = bool(program.friction), len(program.external), looks
        looped = any(group.loop for group in program.groups)
        #: Whether modes are written at all: not where friction is solved for with laws, nor where laws are
        #: solved for by matrices that change.
        self._some = not program.joint and not (looped and program.varying)
        self._modes = Latest[Mode, StraightMode | None](room_for(100 * sum(widths(program))))

    def of(self, mode: Mode) -> StraightMode | None:
        """A mode; None where ports share a load or cannot hold, or hold by matrices that change, or where a
        law is not written over floats."""
        return self._modes.of(mode, lambda: self._made(mode)) if self._some else None

    def _made(self, mode: Mode) -> StraightMode | None:
        if 0 in mode:
            if isinstance(self._matrices, Changing):
                return None
            try:
                with refusals():
                    hold = self._friction.hold(mode, self._matrices)
            except SimulationError:
                # An evaluation tells which.
                return None
            if len(hold.share):
                return None
        contact = self._friction if self._rubs else None
        made = recorded(self._form, contact, mode, self._matrices, self._inputs, self._looks)
        return StraightMode(made) if is_writable(made) else None

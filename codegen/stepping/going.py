"""What a stepper steps: a run that pauses, in numpy or in C."""

from collections.abc import Sequence
from typing import Protocol

from codegen.engine.fallback import Stopped
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.model.kept import Paused
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.runs.track import Event
from codegen.stepping.plan import Row

Given = float | Signal
"""An input: a number that is held, or a signal over the time."""


def as_signals(given: Sequence[Given]) -> tuple[Signal, ...]:
    """Inputs as signals."""
    return tuple(Constant(one) if isinstance(one, float) else one for one in given)


def only_numbers(before: Sequence[Given], after: Sequence[Given]) -> dict[int, float] | None:
    """The numbers that are others now, by place; None where anything else is, too."""
    if len(before) != len(after):
        return None
    found = dict[int, float]()
    for at, (old, new) in enumerate(zip(before, after, strict=True)):
        if old is not new:
            if not (isinstance(old, float) and isinstance(new, float)):
                return None
            found[at] = new
    return found


class GaveUpError(Exception):
    """A way of going on that cannot; ``endless``: nor can any other that steps."""

    def __init__(self, stopped: Stopped, endless: bool = False) -> None:
        super().__init__(str(stopped))
        self.stopped, self.endless = stopped, endless


def refused_by_c(method: str, limit: bool) -> "Going":
    """No way: C does not step by such a method."""
    raise GaveUpError(Stopped(f"C has no method {method!r}", limit=limit))


class Going(Protocol):
    """A run that pauses at an instant. A call that fails leaves it where it was."""

    @property
    def backend(self) -> str:
        """What runs it."""

    def under(self, given: Sequence[Given], t: float) -> None:
        """Take this as all external inputs from t [s] on."""

    def begin(self, t: float, s: Array, mode: Mode) -> Sequence[Event]:
        """Be at the beginning of a run, at t [s]: the integrated vector, and the mode before.

        What happens there, as state machines go on at once.
        """

    def advance(self, stop: float, anew: bool) -> Sequence[Event]:
        """Go on to ``stop`` [s]; what happens on the way, and at both ends.

        ``anew``: whether inputs are other ones from now on, so that the present instant is decided anew.
        """

    def row(self) -> Row:
        """Everything at the present instant, and the mode of each port."""

    def paused(self) -> Paused:
        """Where it is."""

    def take_up(self, paused: Paused) -> None:
        """Be there, under the inputs as they are."""

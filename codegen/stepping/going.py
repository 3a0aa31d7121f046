"""What a stepper steps: a run that pauses, in numpy or in C."""

from collections.abc import Sequence
from typing import Protocol

from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.model.kept import Paused
from codegen.numbers.arrays import Array
from codegen.runs.completion import Beginning
from codegen.runs.track import Event
from codegen.stepping.plan import Row

Given = float | Signal
"""An input: a number that is held, or a signal over the time."""


def as_signals(given: Sequence[Given]) -> tuple[Signal, ...]:
    """Inputs as signals."""
    return tuple(Constant(one) if isinstance(one, float) else one for one in given)


class Going(Protocol):
    """A run that pauses at an instant. A call that fails leaves it where it was."""

    #: What runs it.
    backend: str

    def under(self, given: Sequence[Given], end: float) -> None:
        """Take this as all external inputs; sources among them are known up to ``end`` [s]."""

    def begin(self, t: float, states: Array, begun: Beginning) -> None:
        """Be at the beginning of a run, at t [s]; ``states``: there, law states last."""

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

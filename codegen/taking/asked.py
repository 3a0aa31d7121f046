"""`Request`: a run that is ready to begin."""

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array
from codegen.runs.completion import Beginning
from codegen.runs.track import Settings


@dataclass(frozen=True)
class Request:
    """A run ready to begin. ``states``: at its start, completed; ``events``: whether they are kept.

    ``corners``: whether those of laws are events.
    """

    times: Array
    states: Array
    begun: Beginning
    signals: Sequence[Signal]
    settings: Settings
    events: bool
    corners: bool = False

"""Where a run has come to, so that it can go on from there as if it had never paused."""

from typing import NamedTuple

from codegen.model.snapshot import Mode

KeptCrossings = tuple[tuple[int, float, int, float, float], ...]
"""Ports, when each was crossed last, how many leaps could not be seen, how fast it was the last two times."""


class KeptPeaks(NamedTuple):
    """What rounding is relative to: the fields of `codegen.modes.rounding.Peaks`."""

    both: tuple[float, ...]
    states: int
    time: float
    lingering: frozenset[int]
    leapt: tuple[tuple[int, float], ...]


class Kept(NamedTuple):
    """All that what follows rests on, but for the inputs: plain numbers, the same for each backend.

    ``t``, ``began``, ``done`` [s]: the present instant, where the run began, and up to when tasks have set
    what they set. ``s``: the integrated vector.
    ``touched``: the ports whose event the instant is, where that is not decided yet. ``begun``: whether
    the run's first instant has been decided, ``decided``: whether the present one has. ``largest``: the
    magnitudes that the vector's components have reached. ``rounds`` [s]: the latest events.
    """

    t: float
    began: float
    done: float
    s: tuple[float, ...]
    mode: Mode
    touched: frozenset[int]
    begun: bool
    decided: bool
    largest: tuple[float, ...]
    peaks: KeptPeaks
    crossings: KeptCrossings
    rounds: tuple[float, ...]


class Paused(NamedTuple):
    """A run that pauses: ``arrived`` there, with nothing decided yet; ``present``: under inputs that go on.

    Other inputs from there on decide the instant anew, from where it was arrived at.
    """

    arrived: Kept
    present: Kept

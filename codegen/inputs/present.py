"""What inputs do at a time: the pieces that hold there, and how long these last."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from codegen.inputs.pieces import Piece
from codegen.inputs.signal import Signal


class Present(NamedTuple):
    """Pieces of all inputs from ``begin`` [s] to ``following`` [s], the next breakpoint of any.

    ``fastest`` [1/s]: the largest magnitude of their rates.
    """

    pieces: tuple[Piece, ...]
    begin: float
    following: float
    fastest: float


class Inputs:
    """The inputs of a run, which looks at them again and again between two breakpoints."""

    def __init__(self, signals: Sequence[Signal]) -> None:
        self._signals = signals
        self._latest = Present((), math.inf, math.inf, 0.0)

    def at(self, t: float) -> Present:
        """What holds at t [s] and just after."""
        latest = self._latest
        if not latest.begin <= t < latest.following:
            pieces = tuple(signal.piece(t) for signal in self._signals)
            following = min((signal.following(t) for signal in self._signals), default=math.inf)
            fastest = max((piece.fastest for piece in pieces), default=0.0)
            self._latest = latest = Present(pieces, t, following, fastest)
        return latest

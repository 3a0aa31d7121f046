"""Records of a run: how it is integrated, what it has recorded, what happened in it."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Impact, Mode, Run
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

Dense = Callable[[float | Array], Array]
"""The integrated vector anywhere inside a step; for several times its columns."""


class Event(NamedTuple):
    """What happened: at a friction port "stick", "slip" (it was released) or "cross" (through zero).

    At a switch or a controlled junction "on" or "off"; at a `Stop` "touch", "apart", or "hit" where what met
    it is thrown back, or it takes a shock and stays as it is. At a law that jumps "slide" and "leave": it
    stays where the law jumps, by a mixture of both sides; a jump that is crossed is no event. Where they are
    asked for, "corner" at a node whose law comes over one. ``impulse``: of
    an impact, that of what the port gives; a port's events of one instant share it. Impacts with which a run
    begins are none: they complete a start that no mode holds.
    """

    time: float
    port: Hashable
    kind: str
    impulse: float = 0.0


Ended = tuple[float, Array, frozenset[int]]
"""How a stretch ended: time, integrated vector, and the ports whose event it was."""


CORNER = "corner"
"""What happens where a law has one, or jumps, and the run crosses it."""


KINDS = ("stick", "slip", "cross", "on", "off", "hit", "touch", "apart", "slide", "leave", CORNER)
"""Of events, as C counts them."""


LATEST = 4
"""So many events are told where a run makes no progress."""


BLOCK = 4096
"""Samples, or events, that are handed over at a time."""


class Accumulating(Protocol):
    """What is integrated with a run, such as work; see `codegen.energy.tally.Tally`."""

    def within(self, run: Run) -> None:
        """The run that it goes with, for what rounding is."""

    def smooth(
        self, begin: float, end: float, dense: Dense, pieces: Sequence[Piece], mode: Mode
    ) -> None:
        """A step of an integrator, with its interpolant."""

    def exact(self, pieces: Sequence[Piece], mode: Mode, points: Array, vectors: Array) -> None:
        """A stretch of an affine mode: its begin, samples and end, with the vector at each."""

    def step(
        self, t: float, before: Sequence[Piece], after: Sequence[Piece], s: Array, mode: Mode
    ) -> None:
        """Inputs that may step at t."""

    def impact(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, struck: Impact
    ) -> None:
        """Switches that came to hold at t, with impulses."""

    def rest(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, after: Array
    ) -> None:
        """Ports that may have come to rest at t."""

    def reset(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, after: Array
    ) -> None:
        """States that were reset at t."""

    def record(self) -> None:
        """The next sample."""

    def unrecord(self, count: int) -> None:
        """Forget samples beyond so many."""


class Taker(Protocol):
    """Who takes what a run records, while it goes on: samples in blocks of `BLOCK`, events as they come.

    Blocks end at the same samples whoever takes them, so that the numbers in them are the same, too.
    """

    def begin(self) -> None:
        """A run begins, perhaps once more: what was taken before is none of it."""

    def take(self, vectors: Array, modes: Sequence[Mode], largest: Array) -> None:
        """The next samples: vectors in rows, modes, magnitudes that components have reached so far."""

    def happened(self, events: Sequence[Event]) -> None:
        """The next events."""


@dataclass
class Track:
    """What a run has recorded: the integrated vector and the mode at each sample, and the events.

    ``largest``: the magnitudes that the vector's components have reached, between samples, too.
    ``tally``: what is integrated on the way, if anything is. ``taker``: takes samples and events where
    ``vectors`` has room for no more, all but the latest sample, which may be unrecorded.
    """

    vectors: Array
    modes: list[Mode]
    largest: Array
    events: list[Event] = field(default_factory=list)
    recorded: int = 0
    tally: Accumulating | None = None
    #: Whether all events are kept, or only the latest few.
    keeping: bool = True
    #: Whether corners of laws are events.
    cornered: bool = False
    taker: Taker | None = None
    #: So many samples, and so many of the events that are here, have been taken.
    taken: int = 0
    told: int = 0

    def note(self, events: Sequence[Event]) -> None:
        """What has happened."""
        self.events += events
        if not self.keeping:
            del self.events[:-LATEST]
        elif self.taker is not None and len(self.events) - self.told >= BLOCK:
            self._tell(self.taker)

    def cross(self, t: float, nodes: Sequence[Hashable]) -> None:
        """Laws of these nodes have come over corners."""
        if self.cornered:
            self.note([Event(t, node, CORNER) for node in nodes])

    def see(self, vectors: Array) -> None:
        """Take the magnitudes of some vectors, the rows, into account."""
        if len(vectors) == 1:
            self.largest = np.maximum(self.largest, np.abs(vectors[0]))
        elif len(vectors):
            self.largest = np.maximum(self.largest, np.abs(vectors).max(axis=0))

    def record(self, vector: Array, mode: Mode) -> None:
        """The next sample."""
        self.vectors[self._room()] = vector
        self.modes.append(mode)
        self.recorded += 1

    def take(self, vectors: Array, mode: Mode) -> None:
        """The next samples, in rows, all in one mode."""
        while len(vectors):
            first = self._room()
            now, vectors = np.split(vectors, [len(self.vectors) - first])
            self.vectors[first : first + len(now)] = now
            self.modes += [mode] * len(now)
            self.recorded += len(now)

    def hand_over(self) -> None:
        """Let all that is left be taken, as a run ends."""
        if self.taker is not None:
            self._give(self.taker, self.recorded - self.taken)
            if self.keeping:
                self._tell(self.taker)

    def _room(self) -> int:
        """Where the next sample goes; all but the latest are handed over where there is room for none."""
        first = self.recorded - self.taken
        if self.taker is None or first < len(self.vectors):
            return first
        self._give(self.taker, first - 1)
        self.vectors[0] = self.vectors[first - 1]
        return 1

    def _give(self, taker: Taker, count: int) -> None:
        """Hand the first samples that are here over."""
        taker.take(self.vectors[:count], self.modes[:count], self.largest)
        self.taken += count
        del self.modes[:count]

    def _tell(self, taker: Taker) -> None:
        """Hand the events over; the latest stay to be told of."""
        taker.happened(self.events[self.told :])
        del self.events[:-LATEST]
        self.told = len(self.events)

    def unrecord(self) -> None:
        """Forget the last sample."""
        self.recorded -= 1
        self.modes.pop()
        if self.tally is not None:
            self.tally.unrecord(self.recorded)


@dataclass(frozen=True)
class Settings:
    """How to integrate: method, relative and absolute tolerance."""

    method: str = "auto"
    rtol: float = TUNING.rtol
    atol: float = TUNING.atol

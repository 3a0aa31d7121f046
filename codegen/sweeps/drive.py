"""Cuts a sweep into chunks, hands them out, and isolates runs that end their process."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from codegen.sweeps.chunks import Chunk, Outcome
from codegen.sweeps.crew import Crew, Lost
from codegen.sweeps.design import Table
from codegen.tuning import TUNING


class Rhythm(NamedTuple):
    """How chunks grow.

    ``shortest``, ``longest``: the time one should take [s], in short sweeps and towards the end, and in
    long ones. ``shares``: how many what is left is cut into for every slot. ``first``: runs of the first.
    ``growth``: a chunk may have this many times the runs done so far, as the first may not be like the
    others.
    """

    shortest: float
    longest: float
    shares: int
    first: int
    growth: int


STEADY = Rhythm(shortest=0.5, longest=10.0, shares=4, first=1, growth=4)

QUICK = Rhythm(shortest=TUNING.quick, longest=1.0, shares=2, first=1, growth=16)
"""For runs by a loop in C, where a chunk costs little beside its runs and cannot be interrupted."""

BESIDE = Rhythm(shortest=0.5, longest=10.0, shares=2, first=64, growth=16)
"""For runs side by side, of which few cost about as much as many."""

ENDED = "the process that did it ended: killed, out of memory, or by an exit in a measure"


@dataclass
class Pace:
    """How many runs a chunk has: as many as asked for, else what the time that runs take suggests."""

    fixed: int | None
    rhythm: Rhythm = STEADY
    runs: int = 0
    seconds: float = 0.0

    def see(self, outcome: Outcome) -> None:
        """Learn from a chunk."""
        self.runs += len(outcome.indices)
        self.seconds += outcome.seconds

    def size(self, left: int, slots: int) -> int:
        """The length of the next chunk.

        >>> Pace(None).size(1000, 2), Pace(None, runs=1000, seconds=1.0).size(10000, 2)
        (1, 1250)
        >>> Pace(None, QUICK).size(10000, 2), Pace(None, QUICK, runs=2, seconds=20.0).size(10000, 2)
        (1, 1)
        """
        if self.fixed is not None:
            return self.fixed
        if not self.runs:
            return self.rhythm.first
        each, rhythm = max(self.seconds / self.runs, TUNING.least_each), self.rhythm
        target = min(max(left * each / (rhythm.shares * slots), rhythm.shortest), rhythm.longest)
        return max(1, min(round(target / each), rhythm.growth * self.runs))


@dataclass
class Work:
    """The runs still to do: ``todo`` in order, and ``suspects``, runs whose process ended."""

    design: Table
    todo: NDArray[np.intp]
    pace: Pace
    at: int = 0
    again: deque[Chunk] = field(default_factory=deque)
    suspects: deque[Chunk] = field(default_factory=deque)

    def next(self, slots: int, alone: bool) -> Chunk | None:
        """The next chunk; ``alone``: whether suspects may be done now."""
        if self.again:
            return self.again.popleft()
        if self.suspects and alone:
            return self.suspects.popleft()
        left = len(self.todo) - self.at
        if not left:
            return None
        end = self.at + min(self.pace.size(left, slots), left)
        indices = self.todo[self.at : end]
        self.at = end
        return Chunk(indices, self.design.rows(indices))

    def suspect(self, chunk: Chunk) -> None:
        """Have the runs of a chunk done one by one."""
        for index, row in zip(*chunk, strict=True):
            self.suspects.append(Chunk((int(index),), (row,)))


def drive(crew: Crew, work: Work, keep: Callable[[Outcome], None]) -> None:
    """Do all runs; ``keep`` is called with each outcome.

    A chunk whose process ends is done again run by run. A run whose process ends then, too, has failed.
    Where runs share processes, suspects wait until nothing else is under way.
    """
    under_way = 0
    alone: set[int] = set()
    while True:
        slots = crew.slots()
        while under_way < slots:
            quiet = not under_way and work.at == len(work.todo) and not work.again
            chunk = work.next(slots, alone=quiet or not crew.shared)
            if chunk is None:
                break
            crew.start(chunk)
            under_way += 1
        if not under_way:
            return
        for chunk, found in crew.finished():
            under_way -= 1
            _take(chunk, found, work, alone, keep)


def _take(
    chunk: Chunk,
    found: Outcome | Lost,
    work: Work,
    alone: set[int],
    keep: Callable[[Outcome], None],
) -> None:
    """Keep an outcome, or see to it that what got lost is done again."""
    if not isinstance(found, Lost):
        work.pace.see(found)
        keep(found)
    elif not found.blamed:
        work.again.append(chunk)
    elif alone.issuperset(chunk.indices):
        keep(Outcome(chunk.indices, (ENDED,) * len(chunk.indices), 0.0))
    else:
        alone.update(chunk.indices)
        work.suspect(chunk)

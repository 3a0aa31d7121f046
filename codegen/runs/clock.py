"""When switches that time alone drives change over, known before a run gets there."""

import math
from collections.abc import Sequence

import numpy as np

from codegen.inputs.crossings import Rises
from codegen.inputs.pieces import Piece, are_same, collected, moved
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.tuning import TUNING

NONE = frozenset[int]()


class Clock:
    """The instants of a run at which these switches change over, between breakpoints of the inputs."""

    def __init__(self, model: ClosedModel) -> None:
        self._model = model
        self._pieces: tuple[Piece, ...] = ()
        self._rises: dict[int, Rises] = {}

    def following(
        self, t: float, pieces: Sequence[Piece], mode: Mode, stop: float
    ) -> tuple[float, frozenset[int]]:
        """The next such instant up to ``stop`` [s], which ends the pieces, and whose it is; or infinity."""
        model = self._model
        if not model.timed:
            return math.inf, NONE
        if not are_same(pieces, self._pieces):
            self._pieces, self._rises = tuple(pieces), {}
        times = {}
        for i in model.timed:
            switch = model.switching[i]
            assert switch is not None
            guard = switch.condition(mode[i])
            if guard not in self._rises:
                self._rises[guard] = self._made(guard, t)
            times[i] = self._rises[guard].after(t, stop)
        first = min(times.values())
        near = first + TUNING.together * max(abs(first), first - t)
        return first, frozenset(i for i, time in times.items() if time <= near)

    def _made(self, guard: int, t: float) -> Rises:
        row = self._model.timed_guards[guard]
        used = np.flatnonzero(row[:-1]).tolist()
        begin = self._pieces[used[0]].start if len(used) == 1 else t
        terms = [((0j), (complex(row[-1]),))] if row[-1] else []
        size = abs(float(row[-1]))
        for at in used:
            size += abs(float(row[at] * self._pieces[at](t)))
            for rate, polynomial in moved(self._pieces[at], begin).terms:
                terms.append((complex(rate), tuple(row[at] * c for c in polynomial)))
        return Rises(Piece(begin, collected(terms)), t, TUNING.rounding * size)

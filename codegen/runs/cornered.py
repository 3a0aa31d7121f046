"""Stretches of one mode of a model whose laws have corners: cut where one is crossed."""

from collections import deque
from collections.abc import Callable, Hashable, Sequence
from typing import Protocol

import numpy as np

from codegen.corners.sides import CornerWatch, Sight, begun, check_ends, check_start, turned
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.pace import hardly_apart, moment, time_constant
from codegen.numbers.arrays import Array
from codegen.runs.track import Ended, Settings, Track
from codegen.tuning import TUNING


class Smooth(Protocol):
    """A smooth stretch, of a `Leg`: the corners at which it ended, its latest step [s], the largest rate."""

    crossed: frozenset[int]
    step: float | None
    rate: float

    def fastest(self, t: float, s: Array) -> float:
        """The largest rate [1/s] at an instant."""

    def run(self, t: float, s: Array, stop: float, times: Array, track: Track) -> Ended:
        """Integrate to ``stop``, or the first event or corner."""


Making = Callable[[ClosedModel, CornerWatch | None, float | None], Smooth]
"""A stretch of a model, from what watches its corners and the first step to try [s]."""


class CorneredLeg:
    """As a `Leg`, on one side of each corner, up to the next that is crossed, and so on from there.

    What both sides give there is the same, or jumps; so nothing is to be decided. Where a run crosses
    corners so often that it goes nowhere, it goes over them for a while, which costs a continuous law no
    more than the steps' own error.
    """

    def __init__(
        self, model: ClosedModel, pieces: Sequence[Piece], mode: Mode, settings: Settings,
        origin: float, made: Making,
    ) -> None:  # fmt: skip
        self._model, self._made = model, made
        self._sight = Sight(model, pieces, mode, settings.rtol, settings.atol)
        self._plain, self._origin = made(model, None, None), origin
        self._rounds = deque[tuple[float, Array]](maxlen=TUNING.stalled)
        self._within = settings.rtol, settings.atol

    def fastest(self, t: float, s: Array) -> float:
        """See `Leg.fastest`."""
        return self._plain.fastest(t, s)

    def run(self, t: float, s: Array, stop: float, times: Array, track: Track) -> Ended:
        """See `Leg.run`."""
        check_start(self._sight, t, s)
        fastest, step, over = self._plain.fastest(t, s), None, 0.0
        sides = begun(self._sight, t, s, moment(self._time(fastest, t)))
        while True:
            check_ends(self._sight, sides, t, s)
            blind = t + moment(self._time(fastest, t))
            watch = CornerWatch(self._sight.on(sides), sides, t, s, blind)
            leg = self._made(self._model.on_sides(sides), watch, step)
            t, s, ended = leg.run(t, s, stop, times, track)
            if not leg.crossed:
                return t, s, ended
            track.cross(t, [self._nodes[i] for i in sorted(leg.crossed)])
            sides, step, fastest = turned(self._sight, sides, leg.crossed, t, s), leg.step, leg.rate
            if self._stalls(t, s, fastest):
                over = max(4 * over, self._time(fastest, t))
                t, s, ended = self._plain.run(t, s, min(stop, t + over), times, track)
                if ended or t >= stop:
                    return t, s, ended
                sides = begun(self._sight, t, s, moment(self._time(fastest, t)))

    @property
    def _nodes(self) -> Sequence[Hashable]:
        corners = self._model.program.corners
        return () if corners is None else corners.nodes

    def _time(self, fastest: float, t: float) -> float:
        return time_constant(fastest, t - self._origin)

    def _stalls(self, t: float, s: Array, fastest: float) -> bool:
        """Whether so many of the latest crossings lie within next to no time, or next to no motion.

        The second is a tank that is empty: its level goes to and fro by less than steps are off.
        """
        rounds = self._rounds
        rounds.append((t, s))
        still = len(rounds) >= TUNING.quiet and self._still([other for _, other in rounds])
        crowded = len(rounds) == TUNING.stalled
        if not still and (not crowded or t - rounds[0][0] >= hardly_apart(self._time(fastest, t))):
            return False
        rounds.clear()
        return True

    def _still(self, states: Sequence[Array]) -> bool:
        """Whether the latest of them differ by less than a step may be off."""
        latest = np.array(states[-TUNING.quiet :])
        rtol, atol = self._within
        return bool((np.ptp(latest, axis=0) <= atol + rtol * np.abs(latest[-1])).all())

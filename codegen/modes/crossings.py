"""Jumps that are crossed at ever shorter intervals: how high they leap between, and where that has no end.

A jump that acts only on a higher derivative of what it hangs on (``x'' = -2 sign(x) - sign(x')``) is crossed,
and the crossings may gather towards an instant from which on ``x`` and its rate stay zero both. One of second
order rests there. Of others no mode says that, and the run is refused. ``run_loop.c`` decides the same way.
"""

import math
from collections.abc import Collection

from bondgraph.errors import SimulationError
from codegen.model.kept import KeptCrossings
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks, scales, slip_rates
from codegen.modes.trials import Sight, hung_rounding
from codegen.tuning import TUNING


class Crossings:
    """Of each jump when it was crossed last, and how many of the latest leaps could not be seen."""

    def __init__(self, model: ClosedModel) -> None:
        self._ports = model.program.friction
        self._jumps = [i for i, port in enumerate(self._ports) if port.jumps]
        self._last, self._unseen = dict[int, float](), dict.fromkeys(self._jumps, 0)
        self._speeds = dict.fromkeys(model.hung, (math.inf, math.inf))

    def of(self, before: Mode, after: Mode) -> frozenset[int]:
        """The jumps that slide neither before nor after an instant: they may be crossed ever so often."""
        return frozenset(i for i in self._jumps if before[i] and after[i])

    def take(self, here: Sight, mode: Mode, touched: Collection[int], peaks: Peaks | None) -> None:
        """Take the crossings of an instant into account, at which the mode has become this one.

        Raises `SimulationError` where a jump has been crossed `TUNING.stalled` times in a row without
        leaping higher than what counts as zero.
        """
        crossed = [i for i in self._jumps if i in touched]
        if not crossed:
            return
        model, now = here.model, here.at(mode)
        near, rates = scales(model, now, here.t, peaks).slip, slip_rates(model, now)
        for i, least in hung_rounding(here, now).items():
            near[i], rates[i] = least, now.y[model.friction_readings[i]]
        for i in crossed:
            between = here.t - self._last.get(i, -float("inf"))
            self._last[i] = here.t
            # At a rate v, and back with it after a time T, it leaps by v T/4.
            speed = abs(float(rates[i]))
            leap = speed * between / 4
            if peaks is not None and i in model.hung:
                self._swing(i, math.inf if mode[i] == 0 else speed, leap, peaks)
            seen = mode[i] == 0 or leap > TUNING.leap * float(near[i])
            self._unseen[i] = 0 if seen else self._unseen[i] + 1
            if self._unseen[i] >= TUNING.stalled:
                raise _accumulates(model, i, here.t)

    def kept(self) -> KeptCrossings:
        """What is known of each jump that was crossed, to go on from there."""
        return tuple(
            (i, last, self._unseen[i], *self._speeds.get(i, (math.inf, math.inf)))
            for i, last in sorted(self._last.items())
        )

    def take_up(self, kept: KeptCrossings) -> None:
        """Know what was kept, and no more."""
        self._last = {i: last for i, last, _, _, _ in kept}
        self._unseen = dict.fromkeys(self._jumps, 0) | {i: count for i, _, count, _, _ in kept}
        told = {i: (before, latest) for i, _, _, before, latest in kept if i in self._speeds}
        self._speeds = dict.fromkeys(self._speeds, (math.inf, math.inf)) | told

    def _swing(self, port: int, speed: float, leap: float, peaks: Peaks) -> None:
        """Tell how high swings were, and whether they hardly shrink: by crossings to the same side."""
        if math.isfinite(leap):
            peaks.leapt[port] = max(peaks.leapt.get(port, 0.0), leap)
        before, self._speeds[port] = self._speeds[port][0], (self._speeds[port][1], speed)
        stays = TUNING.lingers * before < speed < math.inf
        peaks.lingering = peaks.lingering - {port} | ({port} if stays else set())


def _accumulates(model: ClosedModel, port: int, t: float) -> SimulationError:
    name = model.program.friction[port].name
    return SimulationError(
        f"at t = {t:.9g} a jump in the law at {name!r} is crossed ever sooner, and comes to rest there: it "
        "moves no first rate of what it hangs on, so that it cannot slide, nor is that a sum of states with "
        "constant factors, of which it could hold the first rate by the second; let it be one, let it depend "
        "on the rate, too, or end the run before"
    )

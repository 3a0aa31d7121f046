"""Stops in fixed steps: at the start of the step in which a gap would close its stop is met.

The gap is closed then, at the speed that what meets it will have there: it is stopped, or thrown
back unless it would return within a step. So nothing goes through a stop, and what bounces comes
to rest and does not chatter.
"""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from codegen.fixed.switched import SwitchedSteps
from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.friction import slip_rates
from codegen.standalone.instant import Instant
from codegen.standalone.levels import level_terms
from codegen.standalone.stepping import Chosen
from codegen.standalone.striking import Strike
from codegen.standalone.switchings import Switching
from codegen.stops.bouncing import Meeting, thrown
from codegen.tuning import TUNING

Stop = tuple[int, Switching]
"""The place of a stop among the ports, and what it is."""


class StoppedSteps(SwitchedSteps):
    """A model in fixed steps some of whose switches are stops."""

    def mode_of(self, on: Collection[str]) -> Mode:
        """The mode in which these switches are on, and all stops are apart."""
        told = super().mode_of(on)
        apart = {i: one.sign(True) for i, one in self.stops()}
        return tuple(apart.get(i, sign) for i, sign in enumerate(told))

    def stops(self) -> list[Stop]:
        """The ports that are stops."""
        return [(i, one) for i, one in enumerate(self.switching) if one and one.stops]

    def begin(self, at: Point, on: Collection[str], named: Collection[str]) -> Array:
        """As of switches. Raises `EvaluationError` for a start beyond a bound."""
        now = self.any_of(at, (1,) * len(self.rubs))
        gaps, near = self.told(now), self.gap_rounding(now)
        for i, one in self.stops():
            if gaps[one.guard] < -near[one.guard]:
                raise EvaluationError(
                    f"stop {self.switches.names[i]} begins {-gaps[one.guard]:g} beyond its bound"
                )
        return super().begin(at, on, named)

    def chosen(self, at: Point, previous: Chosen, dead_band: float, h: float) -> tuple[Mode, Array]:
        """The first consistent mode after what stops do, and s then: what joins comes first."""
        first = self.first if previous is None else previous
        met = self.met(at, first, h)
        apart = {i for i, _ in self.stops()} - {i for i, _ in met}
        at, depth = self.closed_up(at, first, met)
        self.given, self.thrown_back = np.zeros(len(first)), set()
        for _ in range(TUNING.bounces):
            wanted = self.closing(at, first, met, depth, h)
            asked = [i for i in self.places if i not in apart and i not in wanted]
            mode, s = self.among(at, asked, first, previous, dead_band, h)
            joined = not np.array_equal(s, at.s)
            at, first = at._replace(s=s), tuple(np.where(self.rubs, first, mode).tolist())
            still = [(i, one) for i, one in met if i in wanted]
            wanted = self.closing(at, mode, still, depth, h)
            if wanted:
                at, depth = at._replace(s=self.thrown(at, mode, wanted)), {}
                self.thrown_back |= wanted.keys()
            elif not joined:
                return mode, at.s
        raise EvaluationError(f"at t = {at.t:g} what meets stops still closes")

    def met(self, at: Point, mode: Mode, h: float) -> list[Stop]:
        """The stops that were held, and those whose gap is closed, or would be within the step."""
        now = self.any_of(at, mode)
        gaps, near = self.told(now), self.gap_rounding(now)
        return [
            (i, one) for i, one in self.stops()
            if not one.is_on(mode[i]) or gaps[one.guard] <= near[one.guard]
            or gaps[one.guard] + h * one.opening * now.rate[one.place] <= 0
        ]  # fmt: skip

    def gap_rounding(self, now: Instant) -> Array:
        """Gaps below these are closed."""
        terms = level_terms(now, (), self.switches.guards)
        return np.asarray(TUNING.step_rounding * terms, dtype=float)

    def closing(
        self, at: Point, mode: Mode, met: Sequence[Stop], depth: Mapping[int, float], h: float
    ) -> dict[int, float]:
        """How fast these open after they throw back what closes; without those that do not.

        ``depth``: how far beyond its bound each was before it was put there.
        """
        if not met:
            return {}
        now = self.any_of(at, mode)
        told, near = self.told(now), TUNING.step_rounding * self.terms(now)
        slips, rates = now.y[self.slips], slip_rates(now, self.slips, self.moving)
        found = {}
        for i, one in met:
            slip, back = one.side * slips[i], told[one.guard + 1]
            pull = one.side * rates[i]
            if one.on or not one.is_on(mode[i]) or slip >= -near[i]:
                continue
            square = slip**2 + 2 * pull * depth.get(i, 0.0)
            speed = float(back * np.sqrt(max(square, 0.0)))
            if 2 * speed > h * max(-pull, 0.0):
                found[i] = speed
        return found

    def thrown(self, at: Point, mode: Mode, wanted: dict[int, float]) -> Array:
        """The vector s after the impulses of stops that throw back."""
        free = (1,) * len(mode)
        now = self.any_of(at, free)

        def after(strike: Strike) -> Array:
            return at.s + strike.gained(len(at.s), self.form.law_rates)

        def slips(strike: Strike) -> Array:
            return np.asarray(self.any_of(at._replace(s=after(strike)), free).y[self.slips])

        def near(strike: Strike) -> Array:
            gained = np.abs(now.numbers.Q) @ np.abs(strike.given)
            # What is at rest has the rounding of what it was.
            moved = np.abs(now.numbers.F[self.slips]) @ (gained + self.seen[: len(gained)])
            return np.asarray(TUNING.step_rounding * (self.terms(now) + moved))

        strike = thrown(Meeting(
            now, mode, self.switching, wanted, np.asarray(self.efforts),
            lambda tried: self.friction.hold(tried, now.numbers),
            lambda tried, aims: self.exchange(tried, now, aims), slips, near,
        ))  # fmt: skip
        return at.s if strike is None else after(strike)

    def closed_up(
        self, at: Point, mode: Mode, met: Sequence[Stop]
    ) -> tuple[Point, dict[int, float]]:
        """The displacements of these at their bounds, and how far beyond these they were."""
        if not met:
            return at, {}
        gaps, s, depth = self.told(self.any_of(at, mode)), at.s.copy(), dict[int, float]()
        for i, one in met:
            depth[i] = -float(gaps[one.guard])
            s[one.place] += one.opening * depth[i]
        return at._replace(s=s), depth

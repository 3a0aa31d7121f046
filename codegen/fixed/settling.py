"""Which ports hold in a fixed step: one linear complementarity problem where it begins, and where
slips would have gone through zero one more at its end.

The start is solved for as over a moment, in which values count before rates. At the end, what
would have changed its direction is stopped, or turned round, by what ports give over the step in
the mean (Moreau 1988; Anitescu and Potra 1997). A step in which nothing changes stays what its
method made of it.
"""

import warnings
from collections.abc import Collection, Sequence

import numpy as np

from codegen.fixed.boxes import Boxed
from codegen.fixed.responses import Flags, respond
from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Laws, Point
from codegen.standalone.friction import Friction, slip_rates, ways
from codegen.standalone.instant import Instant
from codegen.standalone.stepping import Chosen, FixedSteps, Given, Names
from codegen.standalone.striking import effort_terms
from codegen.standalone.switchings import Switching, flipped
from codegen.tuning import TUNING


class PortSteps(FixedSteps):
    """A model in fixed steps whose friction ports stick and slip."""

    def __init__(self, names: Names, friction: Friction) -> None:
        super().__init__(friction.form, names, friction)
        self.friction, ports = friction, friction.ports
        self.efforts, self.slips, self.beside = ports.inputs, ports.readings, np.array(ports.beside)
        self.moving = ports.moving
        self.switching: Sequence[Switching | None] = [None] * len(self.slips)
        self.rubs = np.ones(len(self.slips), dtype=bool)
        self.coupled: Laws | None = getattr(friction, "coupled", None)
        self.mean = self.mean_caps = self.corrected = np.zeros(len(self.slips))
        #: Slips where a step begins.
        self.begun: Array | None = None

    def decided(self, at: Point, previous: Chosen, dead_band: float, h: float = 0.0) -> Mode:
        """Which ports are held (0) and which let go; of friction which way it slips (+1, -1)."""
        return self.chosen(at, previous, dead_band, h)[0]

    def settled(
        self, at: Point, previous: Chosen, dead_band: float, h: float
    ) -> tuple[Mode, Array]:
        """The mode, and s after impulses, without the slips of the ports that hold."""
        self.seen = np.maximum(self.seen, np.abs(at.s))
        mode, s = self.chosen(at, previous, dead_band, h)
        return mode, self.at_rest(at._replace(s=s), mode)

    def chosen(self, at: Point, previous: Chosen, dead_band: float, h: float) -> tuple[Mode, Array]:
        """The mode from the one so far on, and s after its impulses."""
        count = len(self.slips)
        first = (1,) * count if previous is None else previous
        return self.among(at, range(count), first, previous, dead_band, h)

    def among(
        self,
        at: Point,
        asked: Collection[int],
        first: Mode,
        previous: Chosen,
        dead_band: float,
        h: float,
    ) -> tuple[Mode, Array]:
        """The same where these switches may change over, and no others."""
        mode = self.slipping(at, first) if previous is None else first
        turns, stopped = np.zeros(len(mode), dtype=int), np.zeros(len(mode), dtype=bool)
        for _ in range(TUNING.rounds):
            mode, now = self.looked(at, mode)
            sent = self.sent(at, now, mode, h)
            turns[list(sent)] += 1
            # Nor does one hold that lets go by what it has stopped.
            if (turns > 2).any() or stopped[list(sent)].any():
                raise EvaluationError(f"at t = {at.t:g} no mode of {self.called()} is consistent")
            box = self.start_box(now, flipped(mode, sent), mode, previous, asked, dead_band, h)
            if not sent and not box.broken():
                break
            stopped |= (box.way == 0) & (box.slip != 0)
            first = flipped(mode, sent)
            mode = self.solved(at, now, box, first, self.moment(h), brief=True, looked=mode)
            at = at._replace(s=self.struck_by(at, mode, previous, h))
        return mode, at.s

    def slipping(self, at: Point, mode: Mode) -> Mode:
        """The mode where no step was before: friction turns as it slips, and holds what rests."""
        loose = np.where(self.rubs, 1, mode)
        if not self.rubs.any():
            return mode
        try:
            now = self.any_of(at, (1,) * len(mode))
        except EvaluationError:
            return tuple(loose.tolist())
        slips = now.y[self.slips]
        resting = np.abs(slips) <= TUNING.step_rounding * self.terms(now)
        turning = np.where(resting, 0, np.sign(slips))
        return tuple(np.where(self.rubs, turning, loose).astype(int).tolist())

    def called(self) -> str:
        """The names of what changes over."""
        return ", ".join(str(name) for name in self.friction.ports.names)

    def looked(self, at: Point, mode: Mode) -> tuple[Mode, Instant]:
        """Everything in a mode or, where that has no values, in the first that has."""
        try:
            return mode, self.at(at, mode)
        except EvaluationError:
            for tried in ways(mode):
                try:
                    return tried, self.at(at, tried)
                except EvaluationError:
                    continue
            raise

    def any_of(self, at: Point, mode: Mode) -> Instant:
        """Every variable in the first mode that has values: laws may have no solution one way."""
        refused: EvaluationError | None = None
        for tried in ways(mode):
            try:
                return self.at(at, tried)
            except EvaluationError as error:
                refused = refused or error
        raise refused or EvaluationError("there is no mode")

    def sent(self, at: Point, now: Instant, mode: Mode, h: float) -> set[int]:
        """The switches whose conditions change them over: there are none."""
        return set()

    def struck_by(self, at: Point, mode: Mode, previous: Chosen, h: float) -> Array:
        """The vector s after the impulses of switches that hold: there are none."""
        return at.s

    @staticmethod
    def moment(h: float) -> float:
        """A moment, in which values count before rates; of an instant alone one of 1 ms."""
        return TUNING.brief * (h or TUNING.unit_longest)

    def solved(
        self,
        at: Point,
        now: Instant,
        box: Boxed,
        mode: Mode,
        time: float,
        brief: bool,
        looked: Chosen = None,
    ) -> Mode:
        """The mode in which nothing contradicts, from the box of this one, over a time.

        ``looked``: the mode of the instant, where a step begins.
        """
        # What is more or less than was given is so after a slip has gone through zero.
        lag = 0.0 if brief else time * self.part_after(now, box) / 2
        response = respond(now, self.efforts, self.coupled, time, lag)
        yields, box.reversed, passive = response.yields(now, self.slips, self.rubs)
        if not brief and not passive:
            response = respond(now, self.efforts, self.coupled, time, time)
            yields, box.reversed, _ = response.yields(now, self.slips, self.rubs)
        if not box.solve(yields):
            warnings.warn(
                f"at t = {at.t:g} which ports hold was not decided in a step's bounded number of "
                "pivots; the best way was taken",
                stacklevel=5,
            )
        if not brief:
            given = box.given - self.mean
            self.corrected = response.pushed(given, at.s, self.form.law_rates)
        # At its limit and still at rest friction stays there ..
        found = self.by_ways(box, box.rests(), mode)
        # .. unless that is what was looked at, and contradicted: then it is beyond its limit.
        return self.by_ways(box, box.way == 0, mode) if brief and found == looked else found

    def by_ways(self, box: Boxed, rests: Flags, mode: Mode) -> Mode:
        """The mode by ways; ``rests``: the friction ports that stick."""
        told = np.where(box.least != box.most, box.way != 0, mode)
        return tuple(np.where(self.rubs, np.where(rests, 0, box.way), told).tolist())

    def switched_box(self, mode: Mode, fixed: Collection[int]) -> Boxed:
        """Bounds of what switches give in their modes; ``fixed``: those that stay as they are."""
        count = len(mode)
        box = Boxed(*(np.zeros(count) for _ in range(8)))
        box.way = np.array(mode, dtype=int)
        for i, one in enumerate(self.switching):
            if one is None:
                continue
            side = -1 if one.side < 0 else 1
            held, stays = mode[i] == 0, i in fixed or not one.side
            free = TUNING.huge if held or not stays else 0.0
            box.way[i] = 0 if held else side
            box.most[i] = free if stays or side < 0 else 0.0
            box.least[i] = -free if stays or side > 0 else 0.0
        return box

    def start_box(
        self,
        now: Instant,
        mode: Mode,
        looked: Mode,
        previous: Chosen,
        asked: Collection[int],
        dead_band: float,
        h: float,
    ) -> Boxed:
        """The problem where a step begins, of an instant that was ``looked`` at in this mode."""
        count, signs, rubs = len(mode), np.array(mode, dtype=int), self.rubs
        box = self.switched_box(mode, {*range(count)} - {*asked})
        slips, terms, slow = now.y[self.slips], self.terms(now), self.rate_terms(now)
        near, moment = TUNING.step_rounding * terms, self.moment(h)
        least = np.maximum(np.where(rubs, dead_band, 0.0), near)
        drift = TUNING.step_drift * h * slow
        held = signs == 0
        before = np.zeros(count, bool) if previous is None else np.equal(previous, 0)
        still = held & (np.abs(slips) <= least + np.where(before, drift, 0.0))
        rated = ~held & (np.abs(slips) <= least) & ~self.beside
        rates = slip_rates(now, self.slips, self.moving)
        box.slip = np.where(still, 0.0, np.where(rated, moment * rates, slips))
        box.near = np.where(still | rated, moment * TUNING.step_rounding * slow, near)
        box.given = now.u[self.efforts]
        levels, caps, _, rest = self.friction.ports.values(now).reshape(-1, 4).T
        caps = np.maximum(now.caps, 0.0)
        level = np.where(held | rated, np.maximum(levels * rest, 0.0), np.abs(box.given))
        self.bound(box, level, caps, held | rated)
        slack = TUNING.step_rounding * self.effort_terms(now, looked)
        box.slack = np.where(rubs, box.slack, slack)
        self.hang(box, now, h)
        return box

    def hang(self, box: Boxed, now: Instant, h: float) -> None:
        """The rows of jumps of second order where a step begins: there are none."""

    def bound(self, box: Boxed, level: Array, caps: Array, rests: Array) -> None:
        """Bounds of friction: what it gives as it slips, and what it may hold if it is at rest."""
        most = np.where(rests, np.maximum(caps, level), level)
        box.most = np.where(self.rubs, most, box.most)
        box.least = np.where(self.rubs, -most, box.least)
        box.extra = np.where(self.rubs, np.maximum(caps - most, 0.0), 0.0)
        box.slips = np.where(self.rubs, level, box.slips)
        box.slack = np.where(self.rubs, TUNING.breakaway * caps, 0.0)

    def end_box(self, now: Instant, mode: Mode) -> Boxed:
        """The problem where a step ends, from what ports gave in it in the mean."""
        stops = {i for i, one in enumerate(self.switching) if one is not None and one.stops}
        box, signs = self.switched_box(mode, stops), np.array(mode, dtype=int)
        levels, at_end, _, rest = self.friction.ports.values(now).reshape(-1, 4).T
        caps = np.maximum(self.mean_caps, 0.0)
        whole = np.where(at_end > 0, at_end, 1.0)
        resting = np.where(at_end > 0, caps * np.minimum(levels * rest / whole, 1.0), caps)
        box.given = self.mean
        self.bound(box, np.where(signs, np.abs(self.mean), resting), caps, signs == 0)
        box.slip = np.where(signs, now.y[self.slips], 0.0)
        box.near = TUNING.step_rounding * self.terms(now)
        self.hang_on(box)
        return box

    def hang_on(self, box: Boxed) -> None:
        """The rows of jumps of second order where a step ends: there are none."""

    def contradicted(self, box: Boxed) -> Array:
        """The ports that slip against their ways where a step ends."""
        return np.asarray((box.least != box.most) & (box.way * box.slip < -box.near))

    def part_after(self, now: Instant, box: Boxed) -> float:
        """The part of a step that is left after the first slip has gone through zero."""
        slips = now.y[self.slips]
        begun = slips if self.begun is None else self.begun
        past = begun * slips < 0
        parts = np.where(past, slips / np.where(past, slips - begun, 1.0), 1.0)
        return float(parts[self.contradicted(box)].max())

    def noted(self, now: Instant, part: float) -> None:
        """Count what ports give at an instant into the mean of a step, the first its begin."""
        if self.begun is None:
            self.begun = now.y[self.slips]
        self.mean = self.mean + part * now.u[self.efforts]
        self.mean_caps = self.mean_caps + part * now.caps

    def advance(
        self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode
    ) -> tuple[Mode, Array]:
        """A step in one mode, and what changes at its end."""
        self.mean = self.mean_caps = np.zeros(len(self.slips))
        self.begun = None
        sharing = len(self.form.law_rates) > 0 or self.coupled is not None
        self.sharing = self.friction.sharing = sharing
        try:
            s = self.step(t, h, s, given, mode)
            return self.corrected_end(Point(t + h, s, *given[2]), h, mode)
        finally:
            self.sharing = self.friction.sharing = True

    def corrected_end(self, at: Point, h: float, mode: Mode) -> tuple[Mode, Array]:
        """The mode at the end of a step, and s without the slips that went through zero."""
        try:
            now = self.at(at, mode)
        except EvaluationError:
            return mode, at.s  # the next step tells
        if self.implicit:
            self.noted(now, 0.5)
        box = self.end_box(now, mode)
        if not self.contradicted(box).any():
            return mode, at.s
        mode = self.solved(at, now, box, mode, h, brief=False)
        try:
            return mode, self.at_rest(at._replace(s=self.corrected), mode)
        except EvaluationError:
            return mode, self.corrected

    def at_rest(self, at: Point, mode: Mode) -> Array:
        """The vector s without the slips of the ports that hold: moved along A^-1 F^T."""
        if 0 not in mode:
            return at.s
        now = self.at(at, mode)
        hold, moved = self.friction.hold(mode, now.numbers), at.s.copy()
        moved[: self.form.states] += hold.take_away @ hold.slips(now.x, now.u)
        return moved

    def turned(self, now: Instant, mode: Mode) -> bool:
        """Whether a port slips against its mode, in the moment of a change."""
        return bool(((now.y[self.slips] * mode < 0) & self.rubs).any())

    def terms(self, now: Instant) -> Array:
        """The magnitudes of the terms that make up the slips: what rounding is relative to."""
        F, D = np.abs(now.numbers.F[self.slips]), np.abs(now.numbers.D[self.slips])
        return np.asarray(F @ np.abs(now.x) + D @ np.abs(now.u), dtype=float)

    def rate_terms(self, now: Instant) -> Array:
        """The same of how fast the slips change."""
        m = now.numbers
        moving = np.abs(m.P) @ np.abs(now.x) + np.abs(m.Q) @ np.abs(now.u)
        return np.asarray(np.abs(m.F[self.slips]) @ moving, dtype=float)

    def effort_terms(self, now: Instant, mode: Mode) -> Array:
        """The magnitudes of the terms that make up what holds the ports."""
        sizes = np.full(len(mode), float(np.abs(now.u).max(initial=0.0)))
        if 0 in mode:
            held = self.friction.hold(mode, now.numbers)
            if held.inverse.size:
                sizes[held.ports] = effort_terms(held, now.x, now.u, now.du)
        return sizes

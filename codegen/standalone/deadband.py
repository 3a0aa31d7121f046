"""Which ports stick in a fixed step, in a bounded number of turns: Karnopp's dead band."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.friction import Friction, slip_rates, ways
from codegen.standalone.instant import Instant
from codegen.standalone.stepping import Chosen, FixedSteps, Names
from codegen.tuning import TUNING

ENUMERATED = 8
"""Of so many ports near rest all ways of sticking and slipping are tried."""


class DeadBand(FixedSteps):
    """A model in fixed steps whose friction ports stick inside a dead band."""

    def __init__(self, names: Names, friction: Friction) -> None:
        super().__init__(friction.form, names, friction)
        self.friction, ports = friction, friction.ports
        self.efforts, self.slips, self.beside = ports.inputs, ports.readings, np.array(ports.beside)
        self.moving = ports.moving
        self.rubs = np.ones(len(self.slips), dtype=bool)
        #: What slips may change by in a step, twice.
        self.turning = np.zeros(len(self.slips))
        #: Slips in parts of what counts as being at rest.
        self.part = np.zeros(len(self.slips))

    def decided(self, at: Point, previous: Chosen, dead_band: float, h: float = 0.0) -> Mode:
        """Which ports stick (0) and which way the others slip (+1, -1)."""
        return self.rubbing(at, (0,) * len(self.slips), previous, dead_band, h)

    def rubbing(
        self, at: Point, switched: Mode, previous: Chosen, dead_band: float, h: float
    ) -> Mode:
        """What friction does, with switches as in a mode.

        A port may stick if its slip is inside the band, has changed its sign since the mode before,
        a step of h ago, or depends on its effort at once. It does if what holds it is within its
        breakaway effort; else it slips the way that effort points. One port changes at a time, in a
        bounded number of turns; where that comes to what is no mode, all modes are tried.
        """
        now = self.any_of(at, previous or tuple(np.where(self.rubs, 0, switched).tolist()))
        slips = now.y[self.slips]
        mode = np.where(self.rubs, np.where(slips > 0, 1, -1), switched).tolist()
        near = (np.abs(slips) <= self.least(now, dead_band)) | self.beside
        self.turning = np.zeros(len(slips))
        if previous is not None:
            # An input that steps may turn a slip round too; what a step of h can't reach slips on.
            self.turning = 2 * h * np.abs(slip_rates(now, self.slips, self.moving))
            near |= (slips * previous < 0) & (np.abs(slips) <= self.turning)
        near &= self.rubs
        mode, near = self.brought(now, mode, near, dead_band, h)
        self.part = np.abs(slips) / (self.least(now, dead_band) + self.turning + TUNING.tiny)
        for i in np.flatnonzero(near):
            mode[i] = 0
        for _ in range(4 * int(near.sum())):
            try:
                now = self.consistent(at, mode, dead_band)
            except EvaluationError as error:
                return self.searched(at, mode, near, dead_band, error)
            change = self.let_go(now, mode) or self.caught(now, mode, near)
            if change is None:
                break
            mode[change[0]] = change[1]
        return tuple(mode)

    def brought(
        self, now: Instant, mode: Sequence[int], near: Array, dead_band: float, h: float
    ) -> tuple[list[int], Array]:
        """The modes of ports that slip, and which may stick, as far as more than slips tells."""
        return list(mode), near

    def any_of(self, at: Point, mode: Mode) -> Instant:
        """Every variable in the first mode that has values: laws may have no solution one way."""
        refused: EvaluationError | None = None
        for tried in ways(mode):
            try:
                return self.at(at, tried)
            except EvaluationError as error:
                refused = refused or error
        raise refused or EvaluationError("there is no mode")

    def consistent(self, at: Point, mode: Sequence[int], dead_band: float) -> Instant:
        """Every variable in a mode, unless what its ports receive together does not let them stick.

        That is what other inputs rule of it, and what friction would have to stop at once; what a
        step can bring to rest counts as being there; of a single port its own slip has told.
        """
        now = self.at(at, tuple(mode))
        if 0 not in mode:
            return now
        hold = self.friction.hold(tuple(mode), now.numbers)
        slips, least = now.y[self.slips[hold.ports]], self.least(now, dead_band)[hold.ports]
        together = (hold.mix != 0).sum(axis=1) > 1
        mix = hold.mix[together & ~(hold.mix[:, ~self.rubs[hold.ports]] != 0).any(axis=1)]
        ruled = np.abs(hold.ruled @ slips) > np.abs(hold.ruled) @ least
        torn = np.abs(mix @ slips) > np.abs(mix) @ (least + self.turning[hold.ports])
        if ruled.any() or torn.any():
            raise EvaluationError(f"at t = {at.t:g} no way of sticking and slipping is consistent")
        return now

    def least(self, now: Instant, dead_band: float) -> Array:
        """Slips below these count as zero: of friction the dead band, or their rounding."""
        rounding = TUNING.step_rounding * self.terms(now)
        return np.asarray(np.maximum(np.where(self.rubs, dead_band, 0.0), rounding), dtype=float)

    def searched(
        self, at: Point, rest: Sequence[int], near: Array, dead_band: float, reason: Exception
    ) -> Mode:
        """The first mode of the ports near rest that contradicts nothing, most sticking first.

        Of many those that slip most are tried in all ways, and the others stick.
        """
        most = np.argsort(-np.where(near, self.part, -1.0), kind="stable")[:ENUMERATED]
        tried, rest = np.zeros(len(near), dtype=bool), np.where(near, 0, rest).tolist()
        tried[most] = True
        near = near & tried
        choices = product((0, 1, -1), repeat=int(near.sum()))
        for choice in sorted(choices, key=lambda signs: -signs.count(0)):
            mode = list(rest)
            for i, sign in zip(np.flatnonzero(near), choice, strict=True):
                mode[i] = sign
            try:
                now = self.consistent(at, mode, dead_band)
            except EvaluationError:
                continue
            if self.let_go(now, mode) is None and self.caught(now, mode, near) is None:
                return tuple(mode)
        raise reason

    def settled(
        self, at: Point, previous: Chosen, dead_band: float, h: float
    ) -> tuple[Mode, Array]:
        """The mode, and s without the slips of the ports that stick: moved along A^-1 F^T."""
        self.seen = np.maximum(self.seen, np.abs(at.s))
        mode = self.decided(at, previous, dead_band, h)
        return mode, self.at_rest(at, mode)

    def at_rest(self, at: Point, mode: Mode) -> Array:
        """The vector s without the slips of the ports that hold in a mode."""
        if 0 not in mode:
            return at.s
        now = self.at(at, mode)
        hold, moved = self.friction.hold(mode, now.numbers), at.s.copy()
        moved[: self.form.states] += hold.take_away @ hold.slips(now.x, now.u)
        return moved

    def turned(self, now: Instant, mode: Mode) -> bool:
        """Whether a port slips against its mode, in the moment of a change."""
        return bool(((now.y[self.slips] * mode < 0) & self.rubs).any())

    def let_go(self, now: Instant, mode: Sequence[int]) -> tuple[int, int] | None:
        """The sticking port held farthest beyond its breakaway effort, and which way it goes."""
        efforts = now.u[self.efforts]
        held = np.equal(mode, 0) & self.rubs
        over = np.where(held, np.abs(efforts) - now.caps * (1 + TUNING.breakaway), 0.0)
        if not (over > 0).any():
            return None
        i = int(np.argmax(over / (now.caps + TUNING.breakaway * np.abs(efforts).max())))
        return i, 1 if efforts[i] > 0 else -1

    def terms(self, now: Instant) -> Array:
        """The magnitudes of the terms that make up the slips: what rounding is relative to."""
        F, D = np.abs(now.numbers.F[self.slips]), np.abs(now.numbers.D[self.slips])
        return np.asarray(F @ np.abs(now.x) + D @ np.abs(now.u), dtype=float)

    def rate_terms(self, now: Instant) -> Array:
        """The same of how fast the slips change."""
        m = now.numbers
        moving = np.abs(m.P) @ np.abs(now.x) + np.abs(m.Q) @ np.abs(now.u)
        return np.asarray(np.abs(m.F[self.slips]) @ moving, dtype=float)

    def caught(self, now: Instant, mode: Sequence[int], near: Array) -> tuple[int, int] | None:
        """A port let go that would slip against its direction, and so sticks after all."""
        rates = slip_rates(now, self.slips, self.moving)
        moves = np.where(self.beside, now.y[self.slips], rates) * np.array(mode)
        wrong = near & (
            moves
            < -TUNING.step_rounding * np.where(self.beside, self.terms(now), self.rate_terms(now))
        )
        return (int(np.argmax(wrong)), 0) if wrong.any() else None

"""Whether a port goes with a mode, and whether what only sources rule lets a set of ports hold."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import GUARDS, SLIPS, is_kept, kept_by, watched_by
from codegen.modes.rounding import Peaks, Scales, guard_rounding, holding, scales, slip_rates
from codegen.modes.trials import Sight, hung_rounding
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

NOTHING: Array = np.zeros(0)

NONE: Array = np.zeros((0, 0))


@dataclass(frozen=True)
class Look:
    """A mode at an instant t, with what counts as zero there: as it is seen from ``here``."""

    here: Sight
    mode: Mode
    t: float
    now: Snapshot
    size: Scales
    peaks: Peaks | None

    @property
    def model(self) -> ClosedModel:
        """What is looked at."""
        return self.here.model

    @cached_property
    def guards(self) -> Array:
        """The conditions of switches."""
        return self.model.guards(self.t, self.now)

    @cached_property
    def near(self) -> Array:
        """Below these the conditions count as zero."""
        return guard_rounding(self.here, self.mode, self.peaks)

    def slip(self, port: int) -> float:
        """The port's slip."""
        return float(self.now.y[self.model.friction_readings[port]])

    def margin(self, port: int) -> float:
        """How far what the port gives is below its breakaway effort."""
        return float(self.now.caps[port] - abs(self.now.u[self.model.friction_inputs[port]]))

    def stays(self, port: int) -> float:
        """How far a switch is from changing over."""
        part, at, sign = kept_by(self.model, self.mode, port)
        if part == GUARDS:
            return sign * float(self.guards[at])
        if part == SLIPS:
            return sign * self.slip(at)
        return sign * float(self.now.u[self.model.friction_inputs[at]])

    def least(self, port: int) -> float:
        """Below this that counts as zero."""
        return self._zero(*kept_by(self.model, self.mode, port))

    def watched_least(self, port: int) -> float:
        """The same of what is watched of it."""
        if port in self.model.hung:
            return hung_rounding(self.here, self.now)[port]
        return self._zero(*watched_by(self.model, self.mode, port))

    def _zero(self, part: int, at: int, _: int) -> float:
        if part == GUARDS:
            return float(self.near[at])
        return float((self.size.slip if part == SLIPS else self.size.effort)[at])

    def verdict(self, port: int) -> int:
        """1: the port goes with the mode; -1: it contradicts it; 0: a tie."""
        sign = self.mode[port]
        if self.model.switching[port] is not None:
            return _sign(self.stays(port), self.least(port))
        if sign == 0:
            return _sign(self.margin(port), self.size.effort[port])
        if not self.model.coupled_directly(port):
            return _sign(sign * self.rates[port], self.size.acceleration[port])
        return _sign(sign * self.slip(port), self.size.slip[port])

    def later_verdict(self, port: int, then: "Look", ahead: float) -> int:
        """A tie decided a little later [s]: still holding to rounding, or really moving off."""
        sign = self.mode[port]
        if self.model.switching[port] is not None:
            fallen = self.stays(port) - then.stays(port)
            return -1 if fallen > TUNING.seen * self.least(port) else 1
        if sign == 0:
            return 1 if then.margin(port) >= -self.size.effort[port] else -1
        if self.model.coupled_directly(port) and (heads := self._heading(port, then, ahead)):
            return sign * heads
        rounding = TUNING.moving * self.size.acceleration[port]
        moving = sign * then.rates[port] > rounding
        return 1 if moving or sign * then.slip(port) > self.size.slip[port] else -1

    def _heading(self, port: int, then: "Look", ahead: float) -> int:
        """Which way the slip of a coupled port goes: 1, -1, or 0 where neither shows.

        Its rate tells unless it is not the whole rate: where another port holds, what that gives may
        change a slip in time, too.
        """
        moved, near = then.slip(port) - self.slip(port), float(self.size.slip[port])
        least = TUNING.seen * near
        told = 0.5 * (self.rates[port] + then.rates[port]) * ahead
        if abs(moved) > least:
            return _sign(moved, 0.0)
        if abs(told - moved) > least:
            return _sign(moved, TUNING.moving * near)
        return _sign(float(self.rates[port]), float(self.size.acceleration[port]))

    @cached_property
    def rates(self) -> Array:
        """How fast slips change."""
        return slip_rates(self.model, self.now)

    @cached_property
    def ruling(self) -> Array:
        """Combinations of the ports' slips, by rows, that must be zero as only other inputs rule them."""
        found = NONE
        if 0 in self.mode:
            held = self.model.hold(self.mode, self.now.numbers)
            found = held.ruled
        rows = np.zeros((len(found), len(self.mode)))
        if len(found):
            rows[:, held.ports] = found
        return rows

    @cached_property
    def ruled(self) -> tuple[Array, Array, Array, Array]:
        """What these are, how fast they change, and what counts as zero of both."""
        if not len(rows := self.ruling):
            return NOTHING, NOTHING, NOTHING, NOTHING
        size = np.abs(rows)
        slips = rows @ self.now.y[self.model.friction_readings]
        return slips, rows @ self.rates, size @ self.size.slip, size @ self.size.acceleration


def look_at(here: Sight, mode: Mode, peaks: Peaks | None = None) -> Look:
    """A mode at an instant, with what counts as zero there. Raises `SimulationError` if it is no mode."""
    now, model = here.at(mode), here.model
    size = with_leaps(scales(model, now, here.t, peaks), here, now, peaks)
    if model.switches:
        size = holding(size, model, mode, now, peaks)
    return Look(here, mode, here.t, now, size, peaks)


def with_leaps(size: Scales, here: Sight, now: Snapshot, peaks: Peaks | None) -> Scales:
    """What counts as zero, with speeds of jumps of second order that leap no higher than could be seen.

    What their whole height throws back leaps by v^2/2 over that. Of swings that hardly shrink larger ones
    count: there are as many as one is smaller.
    """
    model = here.model
    if not model.hung:
        return size
    slips, by = size.slip.copy(), model.moves(now.numbers).mobility
    for i, near in hung_rounding(here, now).items():
        thrown = float(now.caps[i]) / float(by[i]) if by[i] > 0 else 0.0
        if peaks is not None:
            near = max(near, TUNING.together * peaks.leapt.get(i, 0.0))
        unseen = math.sqrt(2 * TUNING.leap * near * thrown)
        if peaks is not None and i in peaks.lingering:
            unseen *= TUNING.lingering
        slips[i] = max(slips[i], unseen / TUNING.wide)
    return replace(size, slip=slips)


def limits_of(look: Look) -> Array:
    """Below these what is watched of a port in its mode counts as zero."""
    size, mode = look.size, look.mode
    limits = np.where(np.array(mode, dtype=int) == 0, size.effort, size.slip)
    for i in range(len(mode)):
        if is_kept(look.model, mode, i):
            limits[i] = look.watched_least(i)
    return limits


def _sign(value: float, least: float) -> int:
    return 0 if abs(value) <= least else (1 if value > 0 else -1)


def ruled_out(look: Look) -> str | None:
    """Why other inputs do not let the ports hold at this instant: what they rule moves, or is not zero."""
    slips, rates, near, slow = look.ruled
    for k in range(len(slips)):
        if abs(slips[k]) > near[k]:
            return f"{_ruled_at(look, k)} would have to be zero, not {slips[k]:.6g}"
        if abs(rates[k]) > slow[k]:
            return f"{_ruled_at(look, k)} would have to stay zero, not change by {rates[k]:.6g}"
    return None


def torn(look: Look) -> str | None:
    """Why a set of ports cannot hold: a combination of what they receive would have to stop at once.

    Friction gives no impulse, and what switches stop at once they have stopped before.
    """
    if 0 not in look.mode:
        return None
    held = look.model.hold(look.mode, look.now.numbers)
    if not len(held.mix):
        return None
    slips = held.slips(look.now.x, look.now.u)
    least = TUNING.wide * np.abs(held.mix) @ look.size.slip[held.ports]
    for k in np.flatnonzero(np.abs(slips) > least).tolist():
        ports = held.ports[np.flatnonzero(held.mix[k])]
        names = _names(look, ports)
        return f"what {names} receive together would have to be zero, not {slips[k]:.6g}"
    return None


def _ruled_at(look: Look, row: int) -> str:
    """What other inputs rule, by its ports."""
    names = _names(look, np.flatnonzero(look.ruling[row]))
    return f"what {names} receives, which only sources rule,"


def _names(look: Look, ports: Iterable[int]) -> str:
    """Ports for people; both ways of friction that gives a flow have one name."""
    names = dict.fromkeys(repr(look.model.program.friction[i].name) for i in ports)
    return " and ".join(names)


def ruled_out_later(look: Look, later: Look) -> str | None:
    """The same from a little later, where the instant itself is a tie."""
    slips, _, near, slow = look.ruled
    then, rates, *_ = later.ruled
    moved = (np.abs(then - slips) > TUNING.moving * near) | (np.abs(rates) > TUNING.moving * slow)
    return "a slip that only sources rule is about to leave zero" if moved.any() else None


def room(look: Look, slips: Array) -> Array:
    """Port by port, for slips by rows: 1 at zero, 0 where what other inputs rule of them has left zero."""
    rows, (*_, near, _) = look.ruling, look.ruled
    result = np.ones(slips.shape)
    for row, least in zip(rows, near, strict=True):
        left = 1 - np.minimum(np.abs(slips @ row) / (TUNING.left * least), 2.0)
        for i in np.flatnonzero(row):
            result[:, i] = np.minimum(result[:, i], left)
    return result

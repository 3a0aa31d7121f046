"""Stops: which are met at an instant, and the impulses that throw back what closes on those that bounce.

What merely touches takes no part. What closes more slowly than the model's own scales tell, or would not leap
higher than displacements are known, stays where it is.
"""

import math
from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Impact, Mode
from codegen.modes.rounding import Peaks, guard_rounding, scales, slip_rates
from codegen.modes.trials import Sight, taken
from codegen.numbers.arrays import Array
from codegen.ports.refusals import refusals
from codegen.standalone.striking import Strike
from codegen.stops.bouncing import Meeting, thrown
from codegen.tuning import TUNING


def met(here: Sight, mode: Mode, touched: frozenset[int], peaks: Peaks | None) -> frozenset[int]:
    """The stops whose gap is closed: whose event it is, that were held, or to rounding."""
    model = here.model
    if not model.stopping:
        return frozenset()
    known, now = here.evaluated(mode, slipping=False)
    gaps, near = model.guards(here.t, now), gap_rounding(here, known, peaks)
    found = set()
    for i in model.stopping:
        one = model.switching[i]
        assert one is not None
        if i in touched or not one.is_on(mode[i]) or gaps[one.guard] <= near[one.guard]:
            found.add(i)
    return frozenset(found)


def check_gaps(here: Sight, mode: Mode) -> None:
    """Refuse a start beyond a bound: a `SimulationError` naming the stop."""
    model = here.model
    if not model.stopping:
        return
    known, now = here.evaluated(mode, slipping=False)
    gaps, near = model.guards(here.t, now), gap_rounding(here, known, None)
    for i in model.stopping:
        one, port = model.switching[i], model.program.friction[i]
        assert one is not None
        if gaps[one.guard] < -near[one.guard]:
            raise SimulationError(
                f"at t = {here.t:.9g} stop {port.name!r} begins {-gaps[one.guard]:.6g} beyond its bound; "
                f"give {model.place_name(one.place)} in initial, or start, within it"
            )


def gap_rounding(here: Sight, mode: Mode, peaks: Peaks | None) -> Array:
    """Below these gaps count as closed, from what displacements have been, too."""
    near = guard_rounding(here, mode, peaks)
    largest = here.model.largest(here.s)
    for one in here.model.switching:
        if one is not None and one.stops:
            near[one.guard] += TUNING.together * largest[one.place]
    return near


class _Touch(NamedTuple):
    """A stop that is touched and lets go: its slip and what speeds that up, as gaps open; gap, restitution.

    ``still``, ``near``: below these slip and gap count as zero.
    """

    slip: float
    push: float
    gap: float
    back: float
    still: float
    near: float

    @property
    def pressed(self) -> float:
        """How strongly it is pushed to close."""
        return max(-self.push, 0.0)

    def seen(self, speed: float) -> bool:
        """Whether what leaves with a speed leaps higher than displacements are known."""
        return speed**2 > 2 * TUNING.leap * self.pressed * self.near

    @property
    def leaving(self) -> float:
        """How fast what closes is thrown back; 0 if it closes no faster than rounding, or hardly leaves."""
        if self.back <= 0 or self.slip >= -TUNING.bounce * self.still:
            return 0.0
        depth = -self.gap if self.gap < -self.near else 0.0
        # What is found late, beyond the bound, had another speed there.
        speed = self.back * math.sqrt(max(self.slip**2 + 2 * self.push * depth, 0.0))
        return speed if self.seen(speed) else 0.0


def _touching(
    here: Sight, mode: Mode, stops: Collection[int], peaks: Peaks | None
) -> Mapping[int, _Touch]:
    """Those of these stops that let go in a mode, as they are touched."""
    model = here.model
    if not stops:
        return {}
    # What is held is pressed with what holds it.
    known, now = here.evaluated(mode, slipping=False)
    told, size = model.guards(here.t, now), scales(model, now, here.t, peaks)
    near, rates = gap_rounding(here, known, peaks), slip_rates(model, now)
    found = {}
    for i in sorted(stops):
        one = model.switching[i]
        assert one is not None
        if one.on or not one.is_on(mode[i]):
            continue
        slip = float(now.y[model.friction_readings[i]])
        found[i] = _Touch(
            one.side * slip, one.side * float(rates[i]), float(told[one.guard]),
            float(told[one.guard + 1]), float(size.slip[i]), float(near[one.guard]),
        )  # fmt: skip
    return found


def closing(
    here: Sight, mode: Mode, stops: Collection[int], peaks: Peaks | None
) -> Mapping[int, float]:
    """Of these stops those that bounce as they are met, and how fast slips, opening, are to be after that.

    Those that would hardly leave again, as all that has bounced long enough, do not bounce.
    """
    touching = _touching(here, mode, stops, peaks)
    return {i: one.leaving for i, one in touching.items() if one.leaving > 0}


def opening(here: Sight, mode: Mode, stops: Collection[int], peaks: Peaks | None) -> frozenset[int]:
    """Of these stops those that bounce and are about to open: what joins does not join them."""
    touching = _touching(here, mode, stops, peaks)
    return frozenset(i for i, one in touching.items() if one.back > 0 and one.slip > one.still)


def creeping(
    here: Sight, mode: Mode, stops: Collection[int], peaks: Peaks | None
) -> Mapping[int, float]:
    """Of these stops, if one closes that does not bounce but so slowly that no impact would see it, the slow.

    A graze: the impact that joins what it meets leaves what is an event's own rounding, and a push
    that has turned by then would find neither way consistent.
    """
    touching = _touching(here, mode, stops, peaks)
    slow = {
        i: one for i, one in touching.items()
        if one.leaving == 0 and one.slip >= -2 * TUNING.wide * one.still
    }  # fmt: skip
    return dict.fromkeys(slow, 0.0) if any(t.slip < -t.still for t in slow.values()) else {}


def hardly_leaving(
    here: Sight, mode: Mode, stops: Collection[int], peaks: Peaks | None
) -> Mapping[int, float]:
    """Of these stops those that a shock has opened, and that would close again before a gap could be seen.

    What is joined to them came to rest and they go on; unless they were stopped, too, the two might take
    turns for ever below what is seen of gaps.
    """
    touching = _touching(here, mode, stops, peaks)
    return {
        i: 0.0 for i, one in touching.items() if one.slip > one.still and not one.seen(one.slip)
    }


def stopped(here: Sight, mode: Mode, wanted: Mapping[int, float]) -> Impact | None:
    """The impact that stops these, what is held in the mode staying held; None where no states move them."""
    meeting = _meeting(here, mode, wanted)
    with refusals():
        strike = meeting.struck(meeting.stops)
    return None if strike is None else _impact(here, mode, strike, ())


def thrown_back(here: Sight, mode: Mode, wanted: Mapping[int, float]) -> Impact | None:
    """The impact of the stops that are ``wanted`` to bounce, what switches hold in the mode staying held.

    None where no states move what closes.
    """
    with refusals():
        strike = thrown(_meeting(here, mode, wanted))
    if strike is None:
        return None
    given = strike.given[here.model.friction_inputs]
    return _impact(here, mode, strike, tuple(i for i in wanted if given[i] != 0 and wanted[i] > 0))


def _meeting(here: Sight, mode: Mode, wanted: Mapping[int, float]) -> Meeting:
    model = here.model
    free, now = here.evaluated((1,) * len(mode))

    def slips(strike: Strike) -> Array:
        after = here.s + strike.gained(len(here.s), model.law_rates)
        return np.asarray(model.at(here.t, after, here.pieces, free).y[model.friction_readings])

    def near(strike: Strike) -> Array:
        # What is at rest has the rounding of what it was.
        seen = model.largest(here.s)[: len(now.x)]
        x = np.maximum(np.abs(now.x), seen) + np.abs(now.numbers.Q) @ np.abs(strike.given)
        terms = model.moves(now.numbers).terms[: len(mode)]
        return np.asarray(TUNING.rounding * (terms @ np.concatenate((x, np.abs(now.u)))))

    return Meeting(
        now.instant(here.t), mode, model.switching, wanted, np.array(model.friction_inputs),
        lambda held: model.hold(held, now.numbers),
        lambda held, aims: model.exchange(held, now.instant(here.t), aims), slips, near,
    )  # fmt: skip


def _impact(here: Sight, mode: Mode, strike: Strike, thrown: tuple[int, ...]) -> Impact:
    """What a strike leads to, and what its ports take."""
    model = here.model
    slipping, now = here.evaluated((1,) * len(mode))
    after = here.s + strike.gained(len(here.s), model.law_rates)
    later = model.at(here.t, after, here.pieces, slipping)
    return Impact(after, strike, taken(here, now, later, strike), thrown)


def closed_up(here: Sight, mode: Mode, stops: Collection[int]) -> Array:
    """The integrated vector with the gaps of these stops closed, as far as they are rounding."""
    model = here.model
    if not stops:
        return here.s
    gaps, s = model.guards(here.t, here.evaluated(mode, slipping=False)[1]), here.s.copy()
    for i in sorted(stops):
        one = model.switching[i]
        assert one is not None
        s[one.place] -= one.opening * gaps[one.guard]
    return s

"""Impulses of stops that throw back what meets them: a linear complementarity problem.

All that close and bounce are struck together, what is held staying held: impulses p and slips y
before and after, counted as gaps open, have ``p >= 0``, ``y+ + e y- >= 0``, and one of them zero.
So energy never grows (Newton's law of impact; Brogliato, Nonsmooth Mechanics, section 5.3).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Mode, Places
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Instant
from codegen.standalone.striking import Strike, struck
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Meeting:
    """What is struck at an instant, without impulses so far: ``held``: 0 for each port that is.

    ``wanted``: of stops that close how fast they are to open after it; ``ways``: which way their
    slips open them. ``inputs``, ``readings``: the places of what ports give and receive.
    """

    now: Instant
    held: Mode
    wanted: Mapping[int, float]
    ways: Mapping[int, int]
    inputs: Places
    readings: Places


def thrown(meeting: Meeting, hold: Callable[[Mode], Hold]) -> Strike | None:
    """The impulses, found by Murty's rule; None where no states move what closes.

    ``hold``: the equations of what a mode holds. Raises `EvaluationError` where none are found.
    """
    active = set(meeting.wanted)
    for _ in range(TUNING.bounces):
        strike = _struck(meeting, hold, active)
        if strike is None:
            return None
        wrong = _contrary(meeting, strike, active)
        if not wrong:
            return strike
        active ^= {min(wrong & active or wrong)}
    raise EvaluationError(f"at t = {meeting.now.t:g} no impulses of stops are consistent")


def _struck(meeting: Meeting, hold: Callable[[Mode], Hold], active: set[int]) -> Strike | None:
    now = meeting.now
    mode = tuple(0 if i in active else sign for i, sign in enumerate(meeting.held))
    if 0 not in mode:
        return None
    held = hold(mode)
    if not len(held.mix):
        return None
    ports: Sequence[int] = np.asarray(held.ports).tolist()
    after = [meeting.ways[i] * meeting.wanted[i] if i in active else 0.0 for i in ports]
    return struck(held, now.numbers, held.slips(now.x, now.u) - held.mix @ np.array(after))


def _contrary(meeting: Meeting, strike: Strike, active: set[int]) -> set[int]:
    """The stops that would pull, that open faster than they ought to, or not fast enough."""
    before: Array = meeting.now.y[meeting.readings]
    given, moved = strike.given[meeting.inputs], strike.received[meeting.readings]
    least = TUNING.rounding * np.abs(given).max(initial=0.0)
    wrong = set()
    for i, speed in meeting.wanted.items():
        way = meeting.ways[i]
        over = way * (before[i] + moved[i]) - speed
        near = TUNING.rounding * (abs(before[i]) + abs(moved[i]) + speed)
        if i in active:
            wrong |= {i} if over > near or way * given[i] > least else set()
        elif over < -near:
            wrong.add(i)
    return wrong

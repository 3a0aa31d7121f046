"""Impulses of stops that throw back what meets them: a linear complementarity problem.

All that close and bounce are struck together: impulses p and slips y before and after, counted as
gaps open, have ``p >= 0``, ``y+ + e y- >= 0``, and one of them zero. What a push alone joins takes
part as what does not bounce; what else is held stays held. So energy never grows (Newton's law of
impact; Brogliato, Nonsmooth Mechanics, section 5.3).
"""

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Mode, Places
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Instant
from codegen.standalone.striking import Strike
from codegen.standalone.switchings import Switching
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Meeting:
    """What is struck at an instant in a mode, looked at with all ports let go.

    ``wanted``: of stops that close, how fast they are to open after it. ``inputs``: the places of
    what ports give. ``hold``: the equations of what a mode holds; ``strike``: the impulses by which
    it brings slips to what they are to be; ``slips``: those after a strike; ``near``: below these
    they are rounding.
    """

    now: Instant
    mode: Mode
    switching: Sequence[Switching | None]
    wanted: Mapping[int, float]
    inputs: Places
    hold: Callable[[Mode], Hold]
    strike: Callable[[Mode, Array], Strike]
    slips: Callable[[Strike], Array]
    near: Callable[[Strike], Array]

    @cached_property
    def ways(self) -> Mapping[int, int]:
        """The ports that may take part: what is wanted, and what a push alone holds; which way."""
        ports = enumerate(zip(self.mode, self.switching, strict=True))
        return {
            i: one.side for i, (sign, one) in ports
            if one is not None and one.side and (sign == 0 or i in self.wanted)
        }  # fmt: skip

    @property
    def stops(self) -> frozenset[int]:
        """All of them."""
        return frozenset(self.ways)

    @property
    def held(self) -> Mode:
        """What is held whoever takes part: what holds both ways, but no friction."""
        ports = zip(self.mode, self.switching, strict=True)
        return tuple(sign if one is not None and not one.side else 1 for sign, one in ports)

    def struck(self, active: Set[int]) -> Strike | None:
        """The impulses if these take part; None where no states move them."""
        mode = tuple(0 if i in active else sign for i, sign in enumerate(self.held))
        if 0 not in mode:
            return None
        if not len(self.hold(mode).mix):
            return None
        after = [self.ways[i] * self.wanted.get(i, 0.0) if i in active else 0.0
                 for i in range(len(mode))]  # fmt: skip
        return self.strike(mode, np.array(after))

    def contrary(self, strike: Strike, active: Set[int]) -> set[int]:
        """Ports that would pull, that open faster than they ought to, or not fast enough."""
        slips, near, given = self.slips(strike), self.near(strike), strike.given[self.inputs]
        least = TUNING.rounding * np.abs(given).max(initial=0.0)
        wrong = set()
        for i, way in self.ways.items():
            over = way * slips[i] - self.wanted.get(i, 0.0)
            if i in active:
                wrong |= {i} if over > near[i] or way * given[i] > least else set()
            elif over < -near[i]:
                wrong.add(i)
        return wrong

    @cached_property
    def asked(self) -> Mapping[int, float]:
        """By how much each has to open faster, or close less."""
        slips = self.slips(self.none)
        return {i: self.wanted.get(i, 0.0) - way * slips[i] for i, way in self.ways.items()}

    @property
    def none(self) -> Strike:
        """No impulses at all."""
        n, inputs = len(self.now.x), len(self.now.u)
        return Strike(np.zeros(inputs), np.zeros(len(self.now.y)), np.zeros(n))

    def short(self, strike: Strike, active: Set[int]) -> set[int]:
        """Of these the ports that hang on others by their slips, and were left far from wanted."""
        slips, near = self.slips(strike), self.near(strike)
        left = {i: self.wanted.get(i, 0.0) - self.ways[i] * slips[i] for i in active}
        return {i for i, by in left.items() if by > max(near[i], TUNING.short_of * self.asked[i])}

    def hindering(self, active: Set[int], short: Set[int]) -> int:
        """The port without which those left short get what is wanted."""
        others = sorted(set(active) - short) or sorted(short)
        for i in others:
            strike = self.struck(set(active) - {i})
            if strike is not None and not self.short(strike, short):
                return i
        return others[0]


def thrown(meeting: Meeting) -> Strike | None:
    """The impulses, found by Murty's rule; None where no states move what closes.

    Raises `EvaluationError` where none are found.
    """
    active = set(meeting.stops)
    for _ in range(TUNING.bounces):
        strike = meeting.struck(active)
        if strike is None:
            return None
        wrong = meeting.contrary(strike, active)
        if short := meeting.short(strike, active):
            # Two stops at one motion, each with a speed of its own, do not both take part.
            wrong = {meeting.hindering(active, short)}
        if not wrong:
            return strike
        active ^= {min(wrong)}
    raise EvaluationError(f"at t = {meeting.now.t:g} no impulses of stops are consistent")

"""Fixed steps in which switches and stops reset states, at the starts of steps.

What a reset becomes is told by the values just before it, after the impulses; then the mode is
chosen anew.
"""

from collections.abc import Sequence

import numpy as np

from codegen.fixed.switched import SwitchedSteps
from codegen.fixed.ticking import become
from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.stepping import Chosen
from codegen.standalone.switchings import Reset, first_taken
from codegen.tuning import TUNING


class ResettingSteps(SwitchedSteps):
    """A model in fixed steps some of whose switches reset states."""

    resets: Sequence[Reset] = ()

    def settled(
        self, at: Point, previous: Chosen, dead_band: float, h: float
    ) -> tuple[Mode, Array]:
        """As of switches. Raises `EvaluationError` where resets have no end, or contradict."""
        self.seen = np.maximum(self.seen, np.abs(at.s))
        before = previous
        for _ in range(TUNING.renewals):
            mode, s = self.chosen(at, before, dead_band, h)
            at = at._replace(s=s)
            mode = first_taken(self.switching, before or self.first, mode)
            fired = self.fired(before or self.first, mode, begins=before is None)
            if not fired:
                return mode, self.at_rest(at, mode)
            at, before = at._replace(s=self.reset(at, mode, fired)), mode
        raise EvaluationError(f"at t = {at.t:g} resets set off one another without end")

    def fired(self, before: Mode, mode: Mode, begins: bool = False) -> list[Reset]:
        """The resets of ports that changed over, and of stops that were hit.

        ``begins``: whether a run does, in which state machines alone take transitions.
        """
        hit = self.hits(before, mode)
        found = []
        for one in self.resets:
            switching = self.switching[one.port]
            if begins and not (switching and switching.machine):
                continue
            off = switching is not None and not switching.is_on(one.sign)
            if mode[one.port] == one.sign != before[one.port] or (one.port in hit and off):
                found.append(one)
        return found

    def hits(self, before: Mode, mode: Mode) -> set[int]:
        """The stops that threw back, or took a shock and are as they were."""
        least = TUNING.rounding * float(np.abs(self.given).max(initial=0.0))
        return self.thrown_back | {
            i for i, one in enumerate(self.switching)
            if one and one.stops and mode[i] == before[i] and abs(self.given[i]) > least
        }  # fmt: skip

    def reset(self, at: Point, mode: Mode, fired: Sequence[Reset]) -> Array:
        """The vector s with what these resets set."""
        now = self.at(at, mode)
        s = become(self.names.states, now, at.s, self.told(now), fired)
        self.check_held(at._replace(s=s), mode, [self.names.states[one.place] for one in fired])
        return s

    def check_held(self, at: Point, mode: Mode, states: Sequence[str]) -> None:
        """Refuse what moves a port that is held both ways."""
        ports = zip(mode, self.switching, strict=True)
        held = tuple(sign if one is not None and not one.side else 1 for sign, one in ports)
        if 0 in held and self.struck(at, held, None, 0.0) is not None:
            told = f"the reset of {', '.join(states)} contradicts what is held"
            raise EvaluationError(f"at t = {at.t:g} {told}")

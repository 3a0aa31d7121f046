"""Jumps of second order in fixed steps: on the side where a step would end, or brought to the jump.

A jump that is crossed inside a step cannot be on its old side for all of it, or swings would grow.
So its side is that of what it hangs on as the step would end without it: that of an implicit step
(Acary and Brogliato, Systems and Control Letters 59, 2010). Where a share between both sides ends
the step at the jump, it takes that, and rests there from the next step on.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.fixed.boxes import Boxed
from codegen.fixed.switched import SwitchedSteps, Switches
from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.friction import Friction, slip_rates
from codegen.standalone.instant import Instant
from codegen.standalone.levels import level_terms
from codegen.standalone.stepping import Names
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Hanging(Switches):
    """``hung``: jumps of second order by port, with the guards that are what they hang on."""

    hung: Sequence[tuple[int, int]] = ()


class HangingSteps(SwitchedSteps):
    """A model in fixed steps with jumps of second order."""

    def __init__(self, names: Names, friction: Friction, switches: Hanging) -> None:
        super().__init__(names, friction, switches)
        self.hung = switches.hung
        #: How fast what they hang on has to change to end the step at zero.
        self.aims = np.zeros(len(self.slips))

    def hang(self, box: Boxed, now: Instant, h: float) -> None:
        """The rows of such jumps: how far they would end a step from their jumps, in a moment.

        Without a step they are where they are, and rest where neither that nor its rate is seen.
        """
        told, rates = self.told(now), slip_rates(now, self.slips, self.moving)
        near, slow = self.terms(now), self.rate_terms(now)
        far = level_terms(now, (), self.switches.guards)
        self.aims = np.zeros(len(self.slips))
        span = h or TUNING.unit_longest
        part = self.moment(h) / span
        for i, guard in self.hung:
            gap, slip = float(told[guard]), float(now.y[self.slips[i]])
            rounding = TUNING.step_rounding * (far[guard] / span + near[i] + span * slow[i])
            ahead = gap / span + slip + span * float(rates[i])
            box.slip[i], box.near[i] = part * ahead, part * rounding
            if box.way[i] == 0 and abs(ahead) <= rounding + TUNING.step_drift * span * slow[i]:
                box.slip[i] = 0.0
            self.aims[i] = -gap / h if h > 0 else 0.0

    def hang_on(self, box: Boxed) -> None:
        """Such jumps stay on their sides to the end of a step, whichever way their rates turn."""
        for i, _ in self.hung:
            if box.way[i]:
                box.least[i] = box.most[i] = box.given[i]
                box.slip[i] = box.way[i] * TUNING.huge

    def at_rest(self, at: Point, mode: Mode) -> Array:
        """The vector s in which what such jumps hang on comes to zero, or stays there."""
        moved = super().at_rest(at, mode)
        if 0 not in mode or not self.aims.any():
            return moved
        hold = self.friction.hold(mode, self.at(at, mode).numbers)
        moved[: self.form.states] -= hold.take_away @ (hold.mix @ self.aims[hold.ports])
        # Where the step ends they are to be at rest.
        self.aims = np.zeros(len(self.slips))
        return moved

    def turned(self, now: Instant, mode: Mode) -> bool:
        """Whether a port slips against its mode; a jump of second order is not told by that."""
        against = (now.y[self.slips] * mode < 0) & self.rubs
        against[[i for i, _ in self.hung]] = False
        return bool(against.any())

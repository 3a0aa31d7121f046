"""Jumps of second order in fixed steps: on the side where a step would end, or brought to the jump.

A jump that is crossed inside a step cannot be on its old side for all of it, or swings would grow.
So its side is that of what it hangs on as the step would end without it: that of an implicit step
(Acary and Brogliato, Systems and Control Letters 59, 2010). Where a share between both sides ends
the step at the jump, it takes that, and rests there from the next step on.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.friction import Friction, slip_rates
from codegen.standalone.instant import Instant
from codegen.standalone.stepping import Names
from codegen.standalone.switched import SwitchedSteps, Switches


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

    def brought(
        self, now: Instant, mode: Sequence[int], near: Array, dead_band: float, h: float
    ) -> tuple[list[int], Array]:
        """Which ports may hold, and on which sides the others are, such jumps as they end."""
        sides, near, told = list(mode), near.copy(), self.told(now)
        rates = slip_rates(now, self.slips, self.moving)
        self.aims = np.zeros(len(self.slips))
        for i, guard in self.hung:
            gap, slip = float(told[guard]), float(now.y[self.slips[i]])
            pull = self.pull(now, i)
            free = float(rates[i]) - pull * float(now.u[self.efforts[i]])
            ahead = gap + h * (slip + h * free)
            # Without a step it is where it is, and rests where neither it nor its rate is seen.
            near[i] = (
                abs(ahead) <= max(-pull, 0.0) * h**2 if h > 0 else abs(gap) + abs(slip) <= dead_band
            )
            sides[i] = 1 if (ahead if pull < 0 else gap) > 0 else -1
            self.aims[i] = -gap / h if h > 0 else 0.0
        return sides, near

    def pull(self, now: Instant, port: int) -> float:
        """How a port's effort moves its slip's rate."""
        m = now.numbers
        return float(m.F[self.slips[port]] @ m.Q[:, self.efforts[port]])

    def at_rest(self, at: Point, mode: Mode) -> Array:
        """The vector s in which what such jumps hang on comes to zero, or stays there."""
        moved = super().at_rest(at, mode)
        if 0 not in mode or not self.aims.any():
            return moved
        hold = self.friction.hold(mode, self.at(at, mode).numbers)
        moved[: self.form.states] -= hold.take_away @ (hold.mix @ self.aims[hold.ports])
        return moved

    def turned(self, now: Instant, mode: Mode) -> bool:
        """Whether a port slips against its mode; a jump of second order is not told by that."""
        against = (now.y[self.slips] * mode < 0) & self.rubs
        against[[i for i, _ in self.hung]] = False
        return bool(against.any())

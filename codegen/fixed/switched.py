"""Which ports a fixed step holds where some are ideal switches, and what that does to states."""

import warnings
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.fixed.settling import PortSteps
from codegen.standalone.arrays import Array, Mode
from codegen.standalone.bending import exchanged
from codegen.standalone.evaluation import Point
from codegen.standalone.friction import Friction
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.levels import level_terms
from codegen.standalone.stepping import Chosen, Names
from codegen.standalone.striking import Strike, completing
from codegen.standalone.switchings import Switching, flipped
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Switches:
    """When ports change over, None for friction; what they are called; the conditions of all.

    ``guards``: to turn on and to turn off in turn; ``count``: how many.
    """

    switching: Sequence[Switching | None]
    names: Sequence[str]
    guards: Formula
    count: int


class SwitchedSteps(PortSteps):
    """A model in fixed steps with ideal switches, which change over at starts of steps."""

    def __init__(self, names: Names, friction: Friction, switches: Switches) -> None:
        super().__init__(names, friction)
        self.switches, self.switching = switches, switches.switching
        self.places = [i for i, one in enumerate(self.switching) if one is not None]
        self.rubs = np.array([one is None for one in self.switching])
        self.first = self.mode_of(())
        #: Of the latest choice: what ports gave of impulses, but for what these stops threw back.
        self.given, self.thrown_back = np.zeros(len(self.rubs)), set[int]()

    def mode_of(self, on: Collection[str]) -> Mode:
        """The mode in which these switches are on; friction takes no part."""
        every = zip(self.switches.names, self.switching, strict=True)
        return tuple(
            1 if one is None or one.slides else one.sign(name in on) for name, one in every
        )

    @staticmethod
    def is_shown(one: Switching | None) -> bool:
        """Whether it is a switch that whoever runs the model may know of."""
        return one is not None and not one.slides and not one.machine

    def shown(self, mode: Mode) -> list[float]:
        """For each switch 1 while it is on, 0 while it is off."""
        named = [(i, one) for i, one in enumerate(self.switching) if one and self.is_shown(one)]
        return [float(one.is_on(mode[i])) for i, one in named]

    def begin(self, at: Point, on: Collection[str], named: Collection[str]) -> Array:
        """The vector s with which a run begins, states that are not ``named`` completed.

        ``on``: the switches that are on at first, as far as conditions let them.
        """
        known = [
            name
            for name, one in zip(self.switches.names, self.switching, strict=True)
            if self.is_shown(one)
        ]
        if unknown := [name for name in on if name not in known]:
            raise ValueError(f"no switch is called {unknown[0]!r}; there is {', '.join(known)}")
        now = self.any_of(at, (1,) * len(self.rubs))
        told = self.told(now)
        mode = self.first = self.mode_of(on)
        self.first = flipped(mode, [i for i in self.places if self.is_told(i, mode, told)])
        free = [j for j, name in enumerate(self.names.states[: len(now.x)]) if name not in named]
        if 0 not in self.first or not free:
            return at.s
        held, s = self.friction.hold(self.first, now.numbers), at.s.copy()
        moved = completing(held, now, free)
        s[free] += moved
        self.tell_completed(free, now.x, moved)
        return s

    def is_told(self, port: int, mode: Mode, told: Array) -> bool:
        """Whether a condition changes a switch over before a run; no transition is taken then."""
        one = self.switching[port]
        return one is not None and not one.machine and self.leaves(port, mode, told)

    def tell_completed(self, free: Sequence[int], x: Array, moved: Array) -> None:
        """Warn of states that follow switches at the start."""
        told = [
            f"{self.names.states[j]} = {x[j] + by:g}"
            for j, by in zip(free, moved.tolist(), strict=True)
            if by
        ]
        if told:
            warnings.warn(
                f"states that were not named follow what switches hold: {', '.join(told)}",
                stacklevel=4,
            )

    def told(self, now: Instant) -> Array:
        """The conditions at an instant."""
        return self.switches.guards(now) if self.switches.count else np.zeros(0)

    def leaves(self, port: int, mode: Mode, told: Array, near: Array | None = None) -> bool:
        """Whether a condition changes a switch over in a mode; ``near``: what counts as zero."""
        one = self.switching[port]
        if one is None or one.side:
            return False
        at = one.condition(mode[port])
        return bool(told[at] > (0.0 if near is None else near[at]))

    def chosen(self, at: Point, previous: Chosen, dead_band: float, h: float) -> tuple[Mode, Array]:
        """The mode from the one so far on, and s after its impulses."""
        first = self.first if previous is None else previous
        self.given = np.zeros(len(first))
        return self.among(at, self.places, first, previous, dead_band, h)

    def called(self) -> str:
        """The names of the switches."""
        return ", ".join(self.switches.names[i] for i in self.places)

    def struck_by(self, at: Point, mode: Mode, previous: Chosen, h: float) -> Array:
        """The vector s after the impulses of the switches that are held."""
        held, s = tuple(np.where(self.rubs, 1, mode).tolist()), at.s
        # Where rows turn as states jump, each strike leaves what is bent of its way.
        for _ in range(TUNING.impacts if 0 in held else 0):
            found = self.struck(at._replace(s=s), held, previous, h)
            if found is None:
                break
            self.given = self.given + found.given[self.efforts]
            s = s + found.gained(len(s), self.form.law_rates)
            if not self.form.varying:
                break
        return s

    def struck(self, at: Point, held: Mode, previous: Chosen, h: float) -> Strike | None:
        """What stops the slips of what is held, by its rows as they are; None for nothing."""
        now = self.any_of(at, (1,) * len(held))
        hold = self.friction.hold(held, now.numbers)
        near = TUNING.step_rounding * self.terms(now)
        if previous is not None:
            # What was held drifts by the step's own error, which is no impulse.
            drift = TUNING.step_drift * h * self.rate_terms(now)
            near += np.where(np.equal(previous, 0), drift, 0.0)
        slips = hold.slips(now.x, now.u)
        still = (np.abs(slips) <= np.abs(hold.mix) @ near[hold.ports]).all()
        return None if still else self.exchange(held, now)

    def exchange(self, held: Mode, now: Instant, aims: Array | None = None) -> Strike:
        """The impulses of what is held, at an instant with all let go; ``aims``: of slips."""
        return exchanged(self.form, lambda at: self.friction.hold(held, at), now, aims)

    def sent(self, at: Point, now: Instant, mode: Mode, h: float) -> set[int]:
        """The switches whose conditions change them over: above zero, or at zero and rising."""
        if not self.switches.count:
            return set()
        told = self.told(now)
        near = TUNING.step_rounding * level_terms(now, (), self.switches.guards)
        found = {i for i in self.places if self.leaves(i, mode, told, near)}
        tied = [i for i in self.places if i not in found and self.leaves(i, mode, told, -near)]
        if tied and h > 0:
            later = self.at(at._replace(t=at.t + h, s=at.s + h * now.rate), mode)
            told = self.told(later)
            found |= {i for i in tied if self.leaves(i, mode, told, near)}
        return found

"""What ports give in a step, each within bounds and each on its side.

One linear complementarity problem, ``y = slip - V (given - given_0)``: a port is held, y = 0,
while what it gives is inside its bounds; at the upper one y >= 0, at the lower one y <= 0.
"""

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from codegen.standalone.arrays import Array
from codegen.tuning import TUNING

PATIENCE = 3
"""Turns of all that contradict which need not better anything."""

Ways = np.ndarray[tuple[Any, ...], np.dtype[Any]]
"""For each port 0 held, 1 or -1 at its upper or lower bound."""


@dataclass
class Boxed:
    """Ports by their ways; ``extra``: so far beyond its bounds what holds a port may be.

    ``slips``: what is left of both bounds once a port leaves them with a slip.
    ``near``: slips below are rounding; ``slack``: the same of what ports give beyond their bounds;
    ``reversed``: ports that push their slips on, which nothing can hold; ``shared``: what is left
    of slips that several ports hold together.
    """

    way: Ways
    least: Array
    most: Array
    extra: Array
    slack: Array
    given: Array
    slip: Array
    near: Array
    slips: Array = field(init=False)
    reversed: Ways = field(init=False)
    shared: Array = field(init=False)

    def __post_init__(self) -> None:
        self.slips = np.full(len(self.way), TUNING.huge)
        self.reversed, self.shared = np.zeros(len(self.way), bool), np.zeros(len(self.way))

    def onward(self) -> Ways:
        """Where ports go from their ways: nowhere if nothing contradicts these."""
        held, over = self.way == 0, self.extra + self.slack
        way = np.where(held & (self.given > self.most + over), 1, self.way)
        way = np.where(held & (self.given < self.least - over), -1, way)
        against = self.way * self.slip < -self.near - self.shared
        leaves = ~held & (self.least != self.most) & against
        found: Ways = np.where(leaves, np.where(self.reversed, -self.way, 0), way)
        return found

    def broken(self) -> bool:
        """Whether ports contradict their ways."""
        return bool(((self.onward() != self.way) | ((self.way == 0) & (self.slip != 0))).any())

    def rests(self) -> Ways:
        """The ports whose slips are none."""
        resting: Ways = (self.way == 0) | (np.abs(self.slip) <= self.near + self.shared)
        return resting

    def solve(self, yields: Array) -> bool:
        """Ways that contradict nothing; whether they were found in a bounded number of turns.

        Block principal pivoting with Murty's single changes where that does not help (Judice and
        Pires, A block principal pivoting algorithm for large-scale strictly monotone linear
        complementarity problems, Computers & Operations Research 21, 1994). Else the best of them.
        """
        first, best, fewest, patience = replace(self), self.way, len(self.way) + 1, PATIENCE
        for _ in range(4 * len(self.way) + 8):
            self._look(first, yields)
            way = self.onward()
            changed = np.flatnonzero(way != self.way)
            if not len(changed):
                if not self._lets_slip():
                    return True
                continue
            if len(changed) < fewest:
                best, fewest, patience = self.way, len(changed), PATIENCE
            else:
                patience -= 1
            only = np.arange(len(way)) == changed[-1]
            self.way = way if patience > 0 else np.where(only, way, self.way)
        self.way = best
        self._look(first, yields)
        return False

    def _lets_slip(self) -> bool:
        """Ports that let go with a slip give less from then on; whether one does."""
        goes = (self.way != 0) & (np.abs(self.slip) > self.near + self.shared)
        goes &= self.slips < self.most
        self.extra = np.where(goes, self.extra + self.most - self.slips, self.extra)
        self.least = np.where(goes, -self.slips, self.least)
        self.most = np.where(goes, self.slips, self.most)
        return bool(goes.any())

    def _look(self, first: "Boxed", yields: Array) -> None:
        """What ports give and receive in their ways, from what they give and receive at first."""
        bound = np.where(self.way > 0, self.most, self.least)
        given = np.where(self.way, bound, first.given)
        held = np.flatnonzero(self.way == 0)
        if len(held):
            right = first.slip[held] - yields[held] @ (given - first.given)
            with suppress(np.linalg.LinAlgError):
                given[held] += np.linalg.solve(yields[np.ix_(held, held)], right)
        moved = given - first.given
        self.given, self.shared = given, TUNING.loose * (np.abs(yields) @ np.abs(moved))
        self.slip = np.where(self.way, first.slip - yields @ moved, 0.0)

"""On which side of each corner a run is, and where it comes to another: on the laws of that side."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import sympy as sp

from bondgraph.errors import SimulationError
from bondgraph.inverses.guarding import never_given
from codegen.corners.tabled import region_of
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.numbers.falling import Falling
from codegen.standalone.instant import Instant
from codegen.straight.modes import Plain
from codegen.tuning import TUNING

Dense = Callable[[float | Array], Array]
"""The integrated vector anywhere inside a step."""

Sides = tuple[int, ...]
"""Of each corner: 1 above, -1 below."""


@dataclass(frozen=True)
class Sight:
    """What corners of a model hang on, in a mode, under these pieces of inputs.

    ``rtol``, ``atol``: of the run, within which a state may be off; what a corner hangs on counts as zero
    where it is no more than that moves it.
    """

    model: ClosedModel
    pieces: Sequence[Piece]
    mode: Mode
    rtol: float
    atol: float

    def on(self, sides: Sides) -> "Sight":
        """The same by laws on these sides."""
        return replace(self, model=self.model.on_sides(sides))

    @property
    def ending(self) -> bool:
        """Whether tables have ends that runs must not go beyond."""
        corners = self.model.program.corners
        return corners is not None and bool(corners.ends)

    def instant(self, t: float, s: Array) -> Instant:
        """An instant with all that corners hang on."""
        model = self.model
        if not model.program.corners_told:
            return model.at(t, s, self.pieces, self.mode).instant(t)
        n, program = len(model.program.states), model.program
        w, dw = model.given(t, self.pieces)
        u, y = np.zeros(len(program.inputs)), np.zeros(len(program.readings))
        u[list(program.given)] = w[: len(program.given)]
        return Instant(t, s[:n], s[n : n + len(program.law_states)], u, u, y, w, dw, y[:0])

    def values(self, t: float, s: Array) -> Array:
        """What corners hang on, and for each whether it counts, in two rows."""
        values = None if self._plain is None else self._plain(t, s)
        return (
            self._rows(self.instant(t, s))
            if values is None
            else np.array(values, dtype=float).reshape(2, -1)
        )

    @cached_property
    def _plain(self) -> Plain | None:
        return self.model.plainly(self.pieces, self.mode, "corners")

    def limits(self, t: float, s: Array) -> Array:
        """Below these what corners hang on counts as zero."""
        now = self.instant(t, s)
        corners = self.model.corners
        assert corners is not None
        pool, ends = corners.pool(now), len(corners.constants) + len(now.dw)
        found: Array = np.full(len(self.model.program.sides), TUNING.tiny)
        base = self._rows(now)[0]
        for j in corners.read(pool):
            if 0 < j < len(pool) - ends:
                moved = pool.copy()
                moved[j] += np.copysign(self.atol + self.rtol * abs(pool[j]), pool[j])
                change = corners.of_pool(moved, now)[: len(base)] - base
                found += np.nan_to_num(np.abs(change), posinf=0.0)
        return found

    def _rows(self, now: Instant) -> Array:
        corners = self.model.corners
        assert corners is not None
        return corners(now).reshape(2, -1)


def begun(sight: Sight, t: float, s: Array, ahead: float) -> Sides:
    """The sides at an instant; of what is zero there, those it goes to in so short a time [s]."""
    values, limits = sight.values(t, s)[0], sight.limits(t, s)
    signs = np.where(values >= 0, 1, -1)
    if (np.abs(values) <= limits).any():
        rate = sight.model.at(t, s, sight.pieces, sight.mode).rate
        moved = sight.values(t + ahead, s + ahead * rate)[0] - values
        near = (np.abs(values) <= limits) & (moved != 0)
        signs = np.where(near, np.where(moved > 0, 1, -1), signs)
        resting = frozenset(np.flatnonzero((np.abs(values) <= limits) & (moved == 0)).tolist())
        return _inside(sight, tuple(signs.tolist()), resting)
    return tuple(signs.tolist())


def _inside(sight: Sight, sides: Sides, resting: frozenset[int]) -> Sides:
    """What rests on the end of a table that refuses what is outside is inside."""
    corners = sight.model.program.corners
    found = list(sides)
    for one in () if corners is None else corners.ends:
        region = region_of([sp.Integer(found[at]) for at in one.sides])
        if not 0 < region < one.last:
            for at in resting & set(one.sides):
                found[at] = -found[at]
    return tuple(found)


def check_start(sight: Sight, t: float, s: Array) -> None:
    """Refuse a start that is beyond the end of a table that refuses what is outside; on it is not beyond."""
    if sight.ending:
        values, limits = sight.values(t, s)[0], sight.limits(t, s)
        on = frozenset(np.flatnonzero(np.abs(values) <= limits).tolist())
        check_ends(sight, tuple(np.where(values >= 0, 1, -1).tolist()), t, s, on)


def check_ends(
    sight: Sight, sides: Sides, t: float, s: Array, on: frozenset[int] = frozenset()
) -> None:
    """Refuse sides beyond the end of a table that refuses what is outside, where it is looked into.

    ``on``: corners on which it is.
    """
    corners = sight.model.program.corners
    for one in () if corners is None else corners.ends:
        region = region_of([sp.Integer(sides[at]) for at in one.sides])
        if 0 < region < one.last or on & set(one.sides):
            continue
        if (sight.on(sides).values(t, s)[1][list(one.sides)] > 0).any():
            never = never_given(one.name, *one.ends)
            raise SimulationError(
                f"at t = {t:.9g} {one.argument} " + (never or
                f"leaves table {one.name!r}, which is from {one.ends[0]!r} to {one.ends[1]!r} and refuses "
                "what is outside; give it more points, or another outside")
            )  # fmt: skip


def turned(sight: Sight, sides: Sides, over: frozenset[int], t: float, s: Array) -> Sides:
    """The sides just after some corners were crossed, and those of others that count from then on."""
    new = [-side if i in over else side for i, side in enumerate(sides)]
    for _ in new:
        here = sight.on(tuple(new))
        (values, count), limits = here.values(t, s), here.limits(t, s)
        wrong = [
            i for i, side in enumerate(new)
            if i not in over and count[i] > 0 and side * values[i] < -limits[i]
        ]  # fmt: skip
        if not wrong:
            break
        for i in wrong:
            new[i] = -new[i]
    return tuple(new)


class CornerWatch:
    """Watches what corners hang on through a stretch on one side of each, which begins at t with s.

    ``blind`` [s]: what lies at zero has moved away from it by then.
    """

    def __init__(self, sight: Sight, sides: Sides, t: float, s: Array, blind: float) -> None:
        self._sight, self._sides = sight, np.array(sides)
        self._falling = Falling(sight.limits(t, s), blind, self._triggers(t, s))

    def first(
        self, t_old: float, t_new: float, dense: Dense
    ) -> tuple[float, frozenset[int]] | None:
        """The first time in a step at which corners are crossed, and these."""
        middle = 0.5 * (t_old + t_new)
        ends = self._triggers(middle, dense(middle)), self._triggers(t_new, dense(t_new))
        if self._falling.passes(*ends):
            return None
        return self._falling.first(
            t_old, t_new,
            lambda times: [
                self._triggers(t, s) for t, s in zip(times, dense(np.array(times)).T, strict=True)
            ],
            lambda i, t: float(self._triggers(t, dense(t))[i]),
        )  # fmt: skip

    def _triggers(self, t: float, s: Array) -> Array:
        values, count = self._sight.values(t, s)
        # What a branch has no value for is beyond another corner, which comes before.
        away = np.where((count > 0) & ~np.isnan(values), self._sides * values, np.inf)
        return np.asarray(away, dtype=float)

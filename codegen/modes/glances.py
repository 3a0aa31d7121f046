"""A first look at affine modes of switches: where all is far from a tie, a few products decide."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.modes.tables import Glance, glance
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array, all_of
from codegen.numbers.latest import Latest, room_for
from codegen.tuning import TUNING

NONE: Array = np.zeros(0)

SLACK = 1.001
"""Bounds are rounded themselves."""

UNITS = 16
"""So many pairs of a time constant and a rounding of the time have units that are kept."""

GENEROUS = 2.0
"""So many times the magnitudes at hand have bounds that are kept, and hold for all smaller ones."""


class Bounds(NamedTuple):
    """What counts as zero of what keeps the ports; slips up to ``still`` are none, above ``struck`` some."""

    least: tuple[float, ...]
    still: Array
    struck: Array


class Seen(NamedTuple):
    """What a first look tells: the switches that contradict a mode, and whether it is one at all."""

    broken: frozenset[int]
    real: bool = True


NEVER = Seen(frozenset(), real=False)


class Judged:
    """A mode's tables, and bounds that are kept as long as they are no smaller than what they ought to be."""

    def __init__(self, glance: Glance) -> None:
        self.glance = glance
        #: Where among the rows those of [x, u, z, u', 1] begin.
        self.first = len(glance.rows) - glance.least.shape[1]
        self._most, self._both, self._units = NONE, NONE, NONE
        self._kept = Bounds((), NONE, NONE)

    def generous(self, values: Array, units: Array, both: Array) -> Bounds:
        """Bounds beyond those at these values of the rows: whatever they tell, these would, too.

        ``both``: the magnitudes that states and inputs have reached, which grow only.
        """
        sizes = np.abs(values[self.first :])
        lasts = units is self._units and all_of(sizes <= self._most)
        if lasts and (both is self._both or all_of(both <= self._most[: len(both)])):
            self._both = both
            return self._kept
        self._units, self._both = units, both
        self._kept, self._most = self.larger(sizes, units, both)
        return self._kept

    def larger(self, sizes: Array, units: Array, both: Array) -> tuple[Bounds, Array]:
        """Bounds for larger magnitudes of [x, u, z, u', 1] than these, and how large ones."""
        least = np.zeros(len(sizes))
        least[: len(both)], least[-1] = both, 1.0
        most = GENEROUS * np.maximum(sizes, least)
        still = _bounds(self.glance, least, units).still
        return _bounds(self.glance, most, units)._replace(still=still), most

    def exact(self, values: Array, units: Array, both: Array) -> Bounds:
        """Those at these values."""
        sizes = np.abs(values[self.first :])
        np.maximum(sizes[: len(both)], both, out=sizes[: len(both)])
        return _bounds(self.glance, sizes, units)


class Glances:
    """First looks at the modes of a run; those that were not asked for longest go."""

    def __init__(self, model: ClosedModel) -> None:
        #: How many states and inputs there are.
        self.size = len(model.program.states) + len(model.program.inputs)
        self._model = model
        self._timed = frozenset(model.timed)
        self._at, self._in = (np.nan, np.nan), NONE
        self._units = Latest[tuple[float, float], Array](UNITS)
        self._found = Latest[Mode, Judged | None](room_for(4 * self.size**2))

    def seen(self, here: Sight, mode: Mode, asked: list[int], peaks: Peaks) -> Seen | None:
        """Which switches of those asked contradict a mode; None where that takes a closer look."""
        judged = self.judged(mode)
        if judged is None or not self._timed.isdisjoint(asked):
            return None
        units, both = self.units_at(peaks.time, here.t), peaks.both
        values = judged.glance.rows.dot(here.vector)
        told = _told(judged.glance, values, lambda v: judged.generous(v, units, both), asked)
        if told is None:
            told = _told(judged.glance, values, lambda v: judged.exact(v, units, both), asked)
        return told

    def judged(self, mode: Mode) -> Judged | None:
        """The tables of a mode; None of one that always takes a closer look."""
        return self._found.of(mode, lambda: _judged(self._model, mode))

    def units_at(self, time: float, t: float) -> Array:
        """What the blocks of bounds are in; the same array at the same roundings."""
        key = time, math.ulp(t)
        if self._at != key:
            self._at, self._in = key, self._units.of(key, lambda: _units(*key))
        return self._in


def _told(
    found: Glance, values: Array, bounds_at: Callable[[Array], Bounds], asked: list[int]
) -> Seen | None:
    """What the values of a mode's rows tell, beside their bounds; None where that is not sure."""
    bounds, ports = bounds_at(values), found.shock.shape[1]
    if found.ruled:
        return NEVER if _reached(values, bounds.least) else None
    struck: bool | None = False
    if len(found.shock):
        slips = values[ports : ports + len(found.shock)]
        struck = _struck(slips, bounds)
    if struck is None:
        return None
    if not struck:
        broken = _contrary(values.tolist(), bounds.least, asked)
        return None if broken is None else Seen(broken)
    shocks = _surely(slips, found)
    if shocks is None:
        return None
    values = values + slips.dot(found.jump)
    bounds = bounds_at(values)
    ways = [shock or value for shock, value in zip(shocks, values.tolist(), strict=False)]
    least = [0.0 if shock else size for shock, size in zip(shocks, bounds.least, strict=True)]
    broken = _contrary(ways, least, asked)
    # What an impact does is worked out where it is consistent.
    return Seen(broken) if broken else None


def _judged(model: ClosedModel, mode: Mode) -> Judged | None:
    found = glance(model, mode)
    return None if found is None else Judged(found)


def _units(time: float, spacing: float) -> Array:
    """What the blocks of bounds are in, at a time constant [s] and a spacing of the time [s]."""
    rounding = TUNING.rounding
    return np.array([rounding, rounding * time, rounding * time**2, TUNING.late * spacing])


def _bounds(found: Glance, sizes: Array, units: Array) -> Bounds:
    """The bounds at these magnitudes of [x, u, z, u', 1]."""
    least = SLACK * (units @ (found.least @ sizes).reshape(4, -1))
    near, slips = found.still @ sizes, len(found.shock)
    still = TUNING.wide * TUNING.rounding * near[:slips]
    return Bounds(
        tuple(least.tolist()), still, TUNING.wide * SLACK * (units @ near.reshape(4, slips))
    )


def _reached(values: Array, least: tuple[float, ...]) -> bool:
    """Whether one of the first values is not zero."""
    return any(abs(value) > size for value, size in zip(values.tolist(), least, strict=False))


def _struck(slips: Array, bounds: Bounds) -> bool | None:
    """Whether there is an impact; None where that is not sure."""
    sizes = np.abs(slips)
    if all_of(sizes <= bounds.still):
        return False
    return None if all_of(sizes <= bounds.struck) else True


def _surely(slips: Array, found: Glance) -> list[float] | None:
    """How far the impulses go with each port's way; None where that may be rounding."""
    shocks, terms = slips.dot(found.shock), np.abs(slips).dot(found.shocks)
    sure = (np.abs(shocks) > TUNING.cancelled * terms) | (terms <= 0)
    told: list[float] = shocks.tolist()
    return told if all_of(sure) else None


def _contrary(
    values: list[float], least: Sequence[float], asked: list[int]
) -> frozenset[int] | None:
    """The ports that contradict a mode; None where one is too close to zero."""
    broken = []
    for i in asked:
        if abs(values[i]) <= least[i]:
            return None
        if values[i] < 0:
            broken.append(i)
    return frozenset(broken)

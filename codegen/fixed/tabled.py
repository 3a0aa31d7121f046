"""Tables of generated Python: other values in them, and runs that end where one is left."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from bondgraph.tables.looking import Patches
from bondgraph.tables.pieces import pieces
from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.stepping import FixedSteps, Given
from codegen.tuning import TUNING

ENDLESS = 1e299
"""An end beyond this is none."""


class Shape(NamedTuple):
    """How values of a table become polynomials, and the points along each axis."""

    method: str
    outside: str
    axes: tuple[tuple[float, ...], ...]


class Valued(NamedTuple):
    """The same with values, row by row."""

    method: str
    outside: str
    axes: tuple[tuple[float, ...], ...]
    values: tuple[float, ...]


def with_values(
    changed: Mapping[str, Any], tables: Mapping[str, Patches], shapes: Mapping[str, Shape]
) -> dict[str, Patches]:
    """Tables, of which some have other values: one for each point, over two axes a row for each x.

    Raises `ValueError` by name for a table that there is not, another count, and no finite number.
    """
    if unknown := [name for name in changed if name not in tables]:
        raise ValueError(f"no table is called {unknown[0]!r}; there is {', '.join(tables)}")
    if kept := [name for name in changed if name not in shapes]:
        raise ValueError(f"table {kept[0]!r} is turned round in this model: it keeps its values")
    found = {**tables}
    for name, values in changed.items():
        shape, given = shapes[name], np.array(values, dtype=float)
        counts = tuple(len(axis) for axis in shape.axes)
        if given.shape != counts:
            raise ValueError(f"table {name!r} has {counts} values, not {given.shape}")
        if not np.isfinite(given).all():
            place = tuple(int(at) + 1 for at in np.argwhere(~np.isfinite(given))[0])
            raise ValueError(f"table {name!r}: the value at {place}, from 1, is not finite")
        found[name] = pieces(Valued(*shape, tuple(given.ravel().tolist())))
    return found


def looking(block: Callable[..., Any], tables: Mapping[str, Patches]) -> Callable[..., Any]:
    """A generated function that looks into these tables."""
    return partial(block, tables=tables)


class Refusing(NamedTuple):
    """A table that refuses what is outside, an argument that it is looked up at, its ends there.

    ``never``: what is said instead where it guards a law that is turned round.
    """

    table: str
    argument: str
    low: float
    high: float
    never: str = ""

    def told(self, t: float) -> str:
        """That it was left."""
        never = self.never or (
            f"leaves table {self.table!r}, which is from {self.low!r} to {self.high!r} and refuses "
            "what is outside"
        )
        return f"at t = {t:.9g} {self.argument} {never}"

    def is_near(self, place: float) -> bool:
        """Whether a place is outside or on an end, but for rounding; not of what is no number."""
        span = self.high - self.low
        room = TUNING.rounding * (span if span < ENDLESS else 1.0)
        return place <= self.low + room or place >= self.high - room


class InsideTables(FixedSteps):
    """Fixed steps that end where a table is left that refuses what is outside.

    ``refusing``: those, in the order in which laws are evaluated; ``places``: their arguments.
    """

    refusing: Sequence[Refusing] = ()
    places: Formula
    #: What was first seen outside in a step; stages that follow may have no numbers.
    outside = ""

    def at(self, at: Point, mode: Mode) -> Instant:
        """Every variable at one time."""
        try:
            now = super().at(at, mode)
        except EvaluationError as error:
            raise EvaluationError(self._lost(at) or str(error)) from None
        self.outside = self.outside or self._told(now)
        return now

    def step(self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode) -> Array:
        """A step in one mode, if that has values."""
        self.outside = ""
        try:
            return super().step(t, h, s, given, mode)
        except EvaluationError as error:
            raise EvaluationError(self.outside or str(error)) from None

    def noted(self, now: Instant, part: float) -> None:
        """What ports give at an instant of a step, if that is inside."""
        self._check(now)
        super().noted(now, part)

    def named(self, now: Instant) -> dict[str, float]:
        """Readings and inputs of an instant by name, if that is inside."""
        self._check(now)
        return super().named(now)

    def _check(self, now: Instant) -> None:
        if told := self._told(now):
            raise EvaluationError(told)

    def _told(self, now: Instant) -> str:
        places: Array = self.places(now)
        for one, place in zip(self.refusing, places.tolist(), strict=True):
            if place < one.low or place > one.high:
                return one.told(now.t)
        return ""

    def _lost(self, at: Point) -> str:
        """What states and external inputs alone tell to be left, where nothing else has values."""
        form, n = self.form, self.form.states
        u, y = (np.full(len(names), np.nan) for names in (form.inputs, form.readings))
        u[form.given] = at.w[: len(form.given)]
        z = at.s[n : n + len(form.law_rates)]
        now = Instant(at.t, at.s[:n], z, u, u, y, at.w, at.dw, np.zeros(0))
        try:
            places: Array = self.places(now)
        except EvaluationError:
            return ""
        for one, place in zip(self.refusing, places.tolist(), strict=True):
            if one.is_near(place):
                return one.told(at.t)
        return ""

"""Where what is positive through a stretch first falls to zero inside a step: by points and roots."""

from collections.abc import Callable, Sequence

import numpy as np

from codegen.numbers.arrays import Array
from codegen.numbers.dips import dip, may_dip
from codegen.standalone.roots import root
from codegen.tuning import TUNING

Series = Callable[[Sequence[float]], Sequence[Array]]
"""All triggers at several times."""

Above = Callable[[int, float], float]
"""One trigger at a time."""


class Falling:
    """Triggers through one stretch, each of which ends it where it falls through zero.

    ``limits``: below these they count as zero. One that starts at zero is armed once it has risen above
    that; until then only a fall well below zero counts, and only after ``blind`` [s], so that a stretch
    out of rest makes progress. ``before``: all where the stretch begins.
    """

    def __init__(self, limits: Array, blind: float, before: Array) -> None:
        self._limits, self._blind, self._before = limits.tolist(), blind, before
        self._armed = [False] * len(limits)

    def first(
        self, t_old: float, t_new: float, series: Series, above: Above
    ) -> tuple[float, frozenset[int]] | None:
        """The first time in a step at which one falls, and those that do; steps come one after the other."""
        if not self._armed:
            return None
        grid = np.linspace(t_old, t_new, TUNING.checks + 2).tolist()
        values = [self._before, *series(grid[1:])]
        self._before = values[-1]
        roots: dict[int, float] = {}
        for i in range(len(self._armed)):
            root = self._first_fall(i, grid, [float(value[i]) for value in values], above)
            if root is not None:
                roots[i] = root
        if not roots:
            return None
        time = min(roots.values())
        near = time + TUNING.together * max(abs(time), t_new - t_old)
        return time, frozenset(i for i, root in roots.items() if root <= near)

    def passes(self, middle: Array, end: Array) -> bool:
        """Whether nothing falls in a step, as its ends and its middle alone tell: it is behind then.

        All are further above zero than three times the larger change from one of these to the next.
        """
        most = np.maximum(np.abs(middle - self._before), np.abs(end - middle))
        clear = np.minimum(np.minimum(self._before, middle), end) > TUNING.clear * most
        if not bool((clear | np.isinf(end)).all()):
            return False
        self._before = end
        for i, limit in enumerate(self._limits):
            self._armed[i] = self._armed[i] or bool(end[i] > limit)
        return True

    def _first_fall(
        self, i: int, grid: Sequence[float], values: Sequence[float], above: Above
    ) -> float | None:
        """The first time in a step at which trigger i falls through zero, seen or hidden in a dip."""
        near = may_dip(values)
        for k in range(len(grid) - 1):
            # What is rising from zero, after its own event, has not come from above.
            risen = self._armed[i] or values[k] > self._limits[i]
            root = self._fall(i, grid[k], grid[k + 1], values[k], values[k + 1], above)
            if root is not None:
                return root
            if near and risen:
                root = self._dip(i, grid, values, k, above)
                if root is not None:
                    return root
        return None

    def _fall(
        self, i: int, t_a: float, t_b: float, a: float, b: float, above: Above
    ) -> float | None:
        """Where trigger i falls through zero between two points, if it does."""
        limit = self._limits[i]
        if not self._armed[i] and max(a, b) > limit:
            self._armed[i] = True
            if a <= limit:
                return None
        if self._armed[i]:
            return self._crossing(i, t_a, t_b, 0.0, above) if b <= 0 else None
        if b >= -2 * limit or t_b <= self._blind:
            return None
        found = self._crossing(i, t_a, t_b, -2 * limit, above)
        half = 0.5 * (t_a + found)
        if above(i, half) > limit:
            # What has been up and down again between two points.
            found = self._crossing(i, half, found, 0.0, above)
        return float(max(found, self._blind))

    def _crossing(self, i: int, t_a: float, t_b: float, level: float, above: Above) -> float:
        def beyond(t: float) -> float:
            return above(i, t) - level

        if beyond(t_a) <= 0:
            return t_a
        if beyond(t_b) >= 0:
            return t_b
        return root(beyond, t_a, t_b)

    def _dip(
        self, i: int, grid: Sequence[float], values: Sequence[float], k: int, above: Above
    ) -> float | None:
        """The first root between points k and k + 1, where a trigger dips below zero and comes back."""
        lowest = dip(lambda t: above(i, t), grid, values, k)
        return None if lowest is None else self._crossing(i, grid[k], lowest, 0.0, above)

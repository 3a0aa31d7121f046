"""Events inside one integration step: where a slip, a margin or a condition falls through zero."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import is_kept, watched_by
from codegen.modes.pace import moment
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.modes.verdicts import limits_of, look_at, room
from codegen.numbers.arrays import Array
from codegen.program.layout import CAPS, INPUTS, READINGS
from codegen.runs.dips import dip, may_dip
from codegen.runs.track import Dense
from codegen.standalone.roots import root
from codegen.tuning import TUNING


class Watch:
    """Watches the ports through one leg.

    Each has a trigger that is positive while the mode holds: of friction the magnitude of its slip, or,
    where it sticks, the margin to its breakaway effort; of a switch what keeps it from changing over. A
    trigger that starts at zero is armed once it has risen above rounding; until then only a fall well below
    zero counts, and only after a moment too short to matter, so that a leg out of rest makes progress.
    """

    def __init__(
        self,
        model: ClosedModel,
        pieces: Sequence[Piece],
        mode: Mode,
        t: float,
        s: Array,
        peaks: Peaks | None = None,
    ) -> None:
        self._model, self._pieces, self._mode = model, pieces, mode
        self._blind = t + moment(peaks.time if peaks else 0.0)
        affine = model.affine_map(mode, len(pieces)) if mode else None
        if model.program.guards.results:
            affine = None
        self._affine = None if affine is None else (
            affine.rows(INPUTS)[model.friction_inputs],
            affine.rows(READINGS)[model.friction_readings],
            affine.rows(CAPS),
        )  # fmt: skip
        self._look = look_at(Sight(model, t, s, pieces), mode, peaks)
        self._kept = [i for i in range(len(mode)) if is_kept(model, mode, i)]
        self._limits = limits_of(self._look)
        self._armed = [False] * len(self._limits)
        self._before = self._triggers(t, self._look.now)

    def first_event(
        self, t_old: float, t_new: float, dense: Dense
    ) -> tuple[float, frozenset[int]] | None:
        """The first time in a step at which the mode ends, and the ports or guards that end it."""
        if not self._armed:
            return None
        grid = np.linspace(t_old, t_new, TUNING.checks + 2).tolist()
        values = [self._before, *self._series(grid[1:], dense)]
        self._before = values[-1]
        roots: dict[int, float] = {}
        for i in range(len(self._armed)):
            root = self._first_fall(i, grid, [float(value[i]) for value in values], dense)
            if root is not None:
                roots[i] = root
        if not roots:
            return None
        time = min(roots.values())
        near = time + TUNING.together * max(abs(time), t_new - t_old)
        return time, frozenset(i for i, root in roots.items() if root <= near)

    def _first_fall(
        self, i: int, grid: Sequence[float], values: Sequence[float], dense: Dense
    ) -> float | None:
        """The first time in a step at which trigger i falls through zero, seen or hidden in a dip."""
        near = may_dip(values)
        for k in range(len(grid) - 1):
            # What is rising from zero, after its own event, has not come from above.
            risen = self._armed[i] or values[k] > self._limits[i]
            root = self._fall(i, grid[k], grid[k + 1], values[k], values[k + 1], dense)
            if root is not None:
                return root
            if near and risen:
                root = self._dip(i, grid, values, k, dense)
                if root is not None:
                    return root
        return None

    def _series(self, times: Sequence[float], dense: Dense) -> list[Array]:
        """The triggers at several times; in one product where everything is affine."""
        if self._affine is None:
            return [self._triggers(t, self._snapshot(t, dense(t))) for t in times]
        given = np.array([np.concatenate(self._model.given(t, self._pieces)) for t in times])
        vectors = np.hstack([dense(np.array(times)).T, given, np.ones((len(times), 1))])
        efforts, slips, caps = (vectors @ rows.T for rows in self._affine)
        if caps.min() < 0:
            # One by one, so that a friction level below zero is refused with its time.
            return [self._triggers(t, self._snapshot(t, dense(t))) for t in times]
        return list(self._of_ports(efforts, slips, caps, np.zeros((len(times), 0))))

    def _snapshot(self, t: float, s: Array) -> Snapshot:
        return self._model.at(t, s, self._pieces, self._mode)

    def _triggers(self, t: float, now: Snapshot) -> Array:
        efforts, slips = now.u[self._model.friction_inputs], now.y[self._model.friction_readings]
        guards = self._model.guards(t, now)
        found: Array = self._of_ports(efforts[None], slips[None], now.caps[None], guards[None])[0]
        return found

    def _of_ports(self, efforts: Array, slips: Array, caps: Array, guards: Array) -> Array:
        """The triggers of ports, by rows; one that sticks lets go where sources move it, too."""
        signs, margins = np.array(self._mode, dtype=float), caps - np.abs(efforts)
        if len(self._look.ruling):
            rest = caps + 4 * self._look.size.effort
            margins = np.minimum(margins, rest * room(self._look, slips))
        found = np.where(signs == 0, margins, signs * slips)
        for i in self._kept:
            if i in self._model.timed:
                # Its instants are known before.
                found[:, i] = np.inf
                continue
            part, at, sign = watched_by(self._model, self._mode, i)
            found[:, i] = sign * (slips, efforts, guards)[part][:, at]
        return found

    def _fall(
        self, i: int, t_a: float, t_b: float, a: float, b: float, dense: Dense
    ) -> float | None:
        """Where trigger i falls through zero between two points, if it does."""
        limit = self._limits[i]
        if not self._armed[i] and max(a, b) > limit:
            self._armed[i] = True
            if a <= limit:
                return None
        if self._armed[i]:
            return self._crossing(i, t_a, t_b, 0.0, dense) if b <= 0 else None
        if b >= -2 * limit or t_b <= self._blind:
            return None
        found = self._crossing(i, t_a, t_b, -2 * limit, dense)
        half = 0.5 * (t_a + found)
        if self._above(i, half, dense) > limit:
            # What has been up and down again between two points.
            found = self._crossing(i, half, found, 0.0, dense)
        return float(max(found, self._blind))

    def _above(self, i: int, t: float, dense: Dense) -> float:
        return float(self._triggers(t, self._snapshot(t, dense(t)))[i])

    def _crossing(self, i: int, t_a: float, t_b: float, level: float, dense: Dense) -> float:
        def above(t: float) -> float:
            return self._above(i, t, dense) - level

        if above(t_a) <= 0:
            return t_a
        if above(t_b) >= 0:
            return t_b
        return root(above, t_a, t_b)

    def _dip(
        self, i: int, grid: Sequence[float], values: Sequence[float], k: int, dense: Dense
    ) -> float | None:
        """The first root between points k and k + 1, where a trigger dips below zero and comes back."""
        lowest = dip(lambda t: self._above(i, t, dense), grid, values, k)
        return None if lowest is None else self._crossing(i, grid[k], lowest, 0.0, dense)

"""Events inside one integration step: where a slip, a margin or a condition falls through zero."""

from collections.abc import Sequence
from functools import cached_property

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
from codegen.numbers.falling import Falling
from codegen.program.layout import CAPS, INPUTS, READINGS
from codegen.runs.track import Dense
from codegen.straight.modes import Plain


class Watch:
    """Watches the ports through one leg.

    Each has a trigger that is positive while the mode holds: of friction the magnitude of its slip, or,
    where it sticks, the margin to its breakaway effort; of a switch what keeps it from changing over.
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
        blind = t + moment(peaks.time if peaks else 0.0)
        before = self._triggers(t, self._look.now)
        self._falling = Falling(limits_of(self._look), blind, before)

    @cached_property
    def _plain(self) -> Plain | None:
        return self._model.plainly(self._pieces, self._mode, "efforts", "slips", "caps", "guards")

    def first_event(
        self, t_old: float, t_new: float, dense: Dense
    ) -> tuple[float, frozenset[int]] | None:
        """The first time in a step at which the mode ends, and the ports or guards that end it."""
        return self._falling.first(
            t_old, t_new, lambda times: self._series(times, dense),
            lambda i, t: float(self._at(t, dense(t))[i]),
        )  # fmt: skip

    def _series(self, times: Sequence[float], dense: Dense) -> list[Array]:
        """The triggers at several times; in one product where everything is affine."""
        if self._affine is None:
            return self._one_by_one(times, dense)
        given = np.array([np.concatenate(self._model.given(t, self._pieces)) for t in times])
        vectors = np.hstack([dense(np.array(times)).T, given, np.ones((len(times), 1))])
        efforts, slips, caps = (vectors @ rows.T for rows in self._affine)
        if caps.min() < 0:
            # One by one, so that a friction level below zero is refused with its time.
            return self._one_by_one(times, dense)
        return list(self._of_ports(efforts, slips, caps, np.zeros((len(times), 0))))

    def _one_by_one(self, times: Sequence[float], dense: Dense) -> list[Array]:
        vectors = dense(np.array(times)).T
        if self._plain is not None:
            found = [self._plain(t, s) for t, s in zip(times, vectors, strict=True)]
            sound = [values for values in found if values is not None]
            if len(sound) == len(found):
                return list(self._of_values(np.array(sound, dtype=float)))
        return [self._at(t, s) for t, s in zip(times, vectors, strict=True)]

    def _at(self, t: float, s: Array) -> Array:
        values = None if self._plain is None else self._plain(t, s)
        if values is not None:
            found: Array = self._of_values(np.array([values], dtype=float))[0]
            return found
        return self._triggers(t, self._model.at(t, s, self._pieces, self._mode))

    def _of_values(self, rows: Array) -> Array:
        n = len(self._mode)
        return self._of_ports(
            rows[:, :n], rows[:, n : 2 * n], rows[:, 2 * n : 3 * n], rows[:, 3 * n :]
        )

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

"""Switches that time alone drives: how they are at an instant, before anything else is looked at there."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

NONE = frozenset[int]()

TINY = float(np.finfo(float).tiny)


def told(
    model: ClosedModel, t: float, pieces: Sequence[Piece], mode: Mode, ahead: float,
    touched: frozenset[int],
) -> tuple[Mode, frozenset[int]]:  # fmt: skip
    """The mode with these switches as time says just after t, and which they are.

    A switch whose both conditions send it back is none of them. ``ahead`` [s]: how far to look where a
    condition is at zero; one that is touched has come to where it rises.
    """
    if not model.timed:
        return mode, NONE
    result, known = list(mode), []
    conditions = _Conditions(model, t, pieces, ahead)
    for i in model.timed:
        switch = model.switching[i]
        assert switch is not None
        now, other = switch.condition(mode[i]), switch.condition(1 - mode[i])
        if i not in touched and not conditions.hold(now):
            known.append(i)
        elif i in model.opposed or not conditions.hold(other):
            result[i] = 1 - mode[i]
            known.append(i)
    return tuple(result), frozenset(known)


class _Conditions:
    """The conditions of switches at an instant, as far as they are asked for."""

    def __init__(self, model: ClosedModel, t: float, pieces: Sequence[Piece], ahead: float) -> None:
        self._rows, self._t, self._pieces, self._ahead = model.timed_guards, t, pieces, ahead
        self._model = model

    def hold(self, guard: int) -> bool:
        """Whether a condition is above zero, or at zero and about to rise."""
        row, w = self._rows[guard], self._model.given(self._t, self._pieces)[0]
        factors, constant = row[:-1], float(row[-1])
        value = float(factors @ w) + constant
        terms = float(np.abs(factors) @ np.abs(w)) + abs(constant)
        if abs(value) > TUNING.cancelled * terms:
            return value > 0
        rate = sum(float(c) * piece.derivative(self._t) for c, piece in self._moving(factors))
        late = TUNING.late * float(np.spacing(abs(self._t))) * abs(rate)
        near = TUNING.rounding * terms + late + TINY
        if abs(value) > near:
            return value > 0
        later = sum(float(c) * piece(self._t + self._ahead) for c, piece in self._moving(factors))
        return later + constant - value > TUNING.seen * near

    def _moving(self, factors: Array) -> list[tuple[float, Piece]]:
        return [(float(factors[at]), self._pieces[at]) for at in np.flatnonzero(factors).tolist()]

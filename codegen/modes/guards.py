"""Guards, the conditions that end a run in one phase: what counts as zero, and which have fallen."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def guard_rounding(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    peaks: Peaks | None = None,
) -> Array:
    """Below these the guards count as zero, from the magnitude of the terms that make them up.

    A component's term is the effect of a small relative change of it, divided by the change. At rest a
    state is rounding itself: of what moves it within a time constant.
    """
    now = model.at(t, s, pieces, mode)
    values = model.guards(t, now)
    terms = np.abs(values)
    n = len(model.program.states)
    sizes = s.copy()
    if peaks is not None:
        moving = np.abs(now.numbers.P) @ np.abs(now.x) + np.abs(now.numbers.Q) @ np.abs(now.u)
        least = np.maximum(peaks.x, peaks.time * moving)
        sizes[:n] = np.where(sizes[:n] < 0, -1, 1) * np.maximum(np.abs(sizes[:n]), least)
    for j in np.flatnonzero(sizes):
        moved = s.copy()
        moved[j] += TUNING.term * sizes[j]
        change = model.guards(t, model.at(t, moved, pieces, mode)) - values
        terms += np.nan_to_num(np.abs(change) / TUNING.term, nan=0.0, posinf=0.0)
    w = np.array([piece(t) for piece in pieces])
    for j in np.flatnonzero(w):
        given = w.copy()
        given[j] *= 1 + TUNING.term
        change = model.guards(t, model.evaluate(t, s, given, np.zeros(len(w)), mode)) - values
        terms += np.nan_to_num(np.abs(change) / TUNING.term, nan=0.0, posinf=0.0)
    late = 16 * np.spacing(abs(t)) * _slopes(model, t, s, pieces, mode)
    return np.asarray(TUNING.rounding * terms + late + np.finfo(float).tiny, dtype=float)


def _slopes(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Array:
    """How fast the guards change, by a difference over a moment."""
    now = model.at(t, s, pieces, mode)
    moment = TUNING.guard_moment * max(abs(t), TUNING.guard_floor)
    later = model.guards(t + moment, model.at(t + moment, s + moment * now.rate, pieces, mode))
    return np.asarray(np.nan_to_num(np.abs(later - model.guards(t, now)) / moment), dtype=float)


def fallen_guards(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, peaks: Peaks
) -> frozenset[int]:
    """The guards that are below zero, by more than rounding."""
    if not model.program.guards.results:
        return frozenset()
    values, limits = guard_values(model, t, s, pieces, mode, peaks)
    return frozenset(np.flatnonzero(values < -limits).tolist())


def guard_values(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, peaks: Peaks
) -> tuple[Array, Array]:
    """The guards, and below what they count as zero."""
    values = model.guards(t, model.at(t, s, pieces, mode))
    return values, guard_rounding(model, t, s, pieces, mode, peaks)

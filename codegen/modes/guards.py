"""Conditions of switches: what counts as zero."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.numbers.arrays import Array
from codegen.standalone.levels import terms_of
from codegen.tuning import TUNING


def guard_rounding(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, peaks: Peaks | None
) -> Array:
    """Below these the guards count as zero, from the magnitude of the terms that make them up.

    At rest a state is rounding itself: of what moves it within a time constant.
    """
    peaks = peaks or Peaks.none(model)
    now, w, n = model.at(t, s, pieces, mode), np.array([piece(t) for piece in pieces]), len(peaks.x)
    moving = np.abs(now.numbers.P) @ np.abs(now.x) + np.abs(now.numbers.Q) @ np.abs(now.u)
    sizes = np.abs(s)
    sizes[:n] = np.maximum(sizes[:n], np.maximum(peaks.x, peaks.time * moving))

    def by_state(at: Array) -> Array:
        return model.guards(t, model.at(t, at, pieces, mode))

    def by_input(at: Array) -> Array:
        return model.guards(t, model.evaluate(t, s, at, np.zeros(len(w)), mode))

    terms = terms_of(by_state, s, sizes, np.flatnonzero(sizes)) - np.abs(model.guards(t, now))
    terms += terms_of(by_input, w, np.abs(w), np.flatnonzero(w))
    late = 16 * np.spacing(abs(t)) * _slopes(model, t, s, pieces, mode)
    return np.asarray(TUNING.rounding * terms + late + np.finfo(float).tiny, dtype=float)


def _slopes(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Array:
    """How fast the guards change, by a difference over a moment."""
    now = model.at(t, s, pieces, mode)
    moment = TUNING.guard_moment * max(abs(t), TUNING.guard_floor)
    later = model.guards(t + moment, model.at(t + moment, s + moment * now.rate, pieces, mode))
    return np.asarray(np.nan_to_num(np.abs(later - model.guards(t, now)) / moment), dtype=float)

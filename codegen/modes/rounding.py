"""What counts as zero of slips, efforts, accelerations and conditions: the rounding of their terms."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.trials import evaluated
from codegen.numbers.arrays import Array
from codegen.program.layout import INPUTS
from codegen.standalone.friction import slip_rates as rates_of_slips
from codegen.standalone.levels import terms_of
from codegen.standalone.striking import effort_terms
from codegen.tuning import TUNING


def input_terms(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode
) -> Array:
    """For every input the sum of the magnitudes of its terms in states and external inputs.

    A tire that gives ``c omega - c omega_0`` gives 0 at its own speed, but only to the rounding of
    ``c omega``.
    """
    affine = model.affine_map(mode, len(pieces))
    if affine is not None:
        w = np.array([piece(t) for piece in pieces])
        matrix = affine.rows(INPUTS)
        ones = np.concatenate((np.abs(s), np.abs(w), np.zeros(len(w)), (1.0,)))
        return np.asarray(np.abs(matrix) @ ones, dtype=float)
    return terms_of(lambda at: model.at(t, at, pieces, mode).u, s, np.abs(s), np.flatnonzero(s))


@dataclass
class Peaks:
    """What rounding is relative to: the largest magnitudes of states and inputs that a run has seen.

    ``time`` [s] is the shortest time constant: forces that cancel leave slips of their rounding times it.
    """

    x: Array
    u: Array
    time: float = 0.0

    @classmethod
    def none(cls, model: ClosedModel) -> "Peaks":
        """Nothing seen yet."""
        return cls(np.zeros(len(model.program.states)), np.zeros(len(model.program.inputs)))

    def see(
        self, model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode
    ) -> None:
        """Take an instant into account, friction slipping in the given directions or forwards."""
        slipping, now = evaluated(model, t, s, pieces, mode)
        self.x = np.maximum(self.x, np.abs(now.x))
        self.u = np.maximum(self.u, input_terms(model, t, s, pieces, slipping))


@dataclass(frozen=True)
class Scales:
    """Below these a slip, an effort margin or a slip acceleration counts as zero, port by port."""

    slip: Array
    effort: Array
    acceleration: Array


def scales(model: ClosedModel, now: Snapshot, t: float = 0.0, peaks: Peaks | None = None) -> Scales:
    """The rounding to be expected, from the magnitude of the terms that cancel, and of the time's."""
    readings, numbers = model.friction_readings, now.numbers
    peaks = peaks or Peaks.none(model)
    x, u = np.maximum(np.abs(now.x), peaks.x), np.maximum(np.abs(now.u), peaks.u)
    late = TUNING.late * np.spacing(abs(t)) * np.abs(slip_rates(model, now))
    slip = np.abs(numbers.F[readings]) @ x + np.abs(numbers.D[readings]) @ u
    # At rest states are rounding themselves: of what moves them within a time constant.
    x = np.maximum(x, peaks.time * (np.abs(numbers.P) @ x + np.abs(numbers.Q) @ u))
    by_states, by_inputs, inertia = model.pushing(numbers)
    moved = by_states @ x + by_inputs @ u
    efforts = np.abs(now.u[model.friction_inputs]) + now.caps
    driven = np.divide(moved, inertia, out=np.zeros_like(moved), where=inertia > 0)
    tiny = np.finfo(float).tiny
    return Scales(
        TUNING.rounding * (slip + moved * peaks.time) + late + tiny,
        TUNING.rounding * (efforts + driven) + tiny,
        TUNING.rounding * TUNING.pushes * moved + tiny,
    )


def holding(
    size: Scales, model: ClosedModel, mode: Mode, now: Snapshot, peaks: Peaks | None
) -> Scales:
    """The same with efforts of ports that hold by the terms of the equations that they follow from.

    A switch has no limit beside which its effort's rounding could be seen.
    """
    if 0 not in mode:
        return size
    held, peaks = model.hold(mode, now.numbers), peaks or Peaks.none(model)
    x, u = np.maximum(np.abs(now.x), peaks.x), np.maximum(np.abs(now.u), peaks.u)
    own = TUNING.rounding * effort_terms(held, x, u, now.du)
    efforts = size.effort.copy()
    efforts[held.ports] = np.maximum(efforts[held.ports], own)
    return replace(size, effort=efforts)


def slip_rates(model: ClosedModel, now: Snapshot) -> Array:
    """How fast each friction port's slip changes, inputs that cannot be differentiated held."""
    rows = np.array(model.friction_readings, dtype=int)
    return rates_of_slips(now.instant(0.0), rows, model.moving)


def guard_rounding(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, peaks: Peaks | None
) -> Array:
    """Below these the guards count as zero, from the magnitude of the terms that make them up.

    At rest a state is rounding itself: of what moves it within a time constant.
    """
    peaks = peaks or Peaks.none(model)
    now, n = model.at(t, s, pieces, mode), len(peaks.x)
    w, dw = model.given(t, pieces)
    moving = np.abs(now.numbers.P) @ np.abs(now.x) + np.abs(now.numbers.Q) @ np.abs(now.u)
    sizes = np.abs(s)
    sizes[:n] = np.maximum(sizes[:n], np.maximum(peaks.x, peaks.time * moving))

    rows = model.guard_rows(mode, len(w))
    if rows is not None:
        ones = np.concatenate((sizes, np.abs(w), np.abs(dw), (1.0,)))
        moved = np.concatenate((now.rate, _rates_of(pieces, t), np.zeros(len(w)), (0.0,)))
        late = 16 * np.spacing(abs(t)) * np.abs(rows @ moved)
        found = TUNING.rounding * (np.abs(rows) @ ones) + late + np.finfo(float).tiny
        return np.asarray(found, dtype=float)

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


def _rates_of(pieces: Sequence[Piece], t: float) -> Array:
    return np.array([piece.derivative(t) for piece in pieces])

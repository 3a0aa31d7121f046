"""What counts as zero of slips, efforts, accelerations and conditions: the rounding of their terms."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.kept import KeptPeaks
from codegen.model.moves import Moves
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array, all_of, dot
from codegen.program.affine import ONE, AffineMap
from codegen.program.layout import INPUTS, STATES
from codegen.standalone.friction import moved_on
from codegen.standalone.levels import terms_of
from codegen.standalone.striking import effort_terms
from codegen.tuning import TUNING

TINY = float(np.finfo(float).tiny)
"""No number that counts as zero is zero itself."""


def input_terms(here: Sight, mode: Mode) -> Array:
    """For every input the sum of the magnitudes of its terms in states and external inputs.

    A tire that gives ``c omega - c omega_0`` gives 0 at its own speed, but only to the rounding of
    ``c omega``.
    """
    model, t, s, pieces = here.model, here.t, here.s, here.pieces
    affine = model.affine_map(mode, len(pieces))
    if affine is not None:
        return _affine_terms(here, affine)
    return terms_of(lambda at: model.at(t, at, pieces, mode).u, s, np.abs(s), np.flatnonzero(s))


def _affine_terms(here: Sight, affine: AffineMap) -> Array:
    """The same where a mode is affine; rates of inputs are none of them."""
    sizes = np.abs(here.vector)
    sizes[len(sizes) - 1 - len(here.pieces) : -1] = 0.0
    found: Array = affine.magnitudes(INPUTS).dot(sizes)
    return found


@dataclass
class Peaks:
    """What rounding is relative to: the largest magnitudes of states and inputs that a run has seen.

    ``time`` [s] is the shortest time constant: forces that cancel leave slips of their rounding times it.
    """

    #: Of states and inputs, one after the other; another array where one has grown.
    both: Array
    states: int
    time: float = 0.0
    #: Jumps of second order whose swings hardly shrink.
    lingering: frozenset[int] = frozenset()
    #: How high they have leapt between two crossings.
    leapt: dict[int, float] = field(default_factory=dict)

    @classmethod
    def none(cls, model: ClosedModel) -> "Peaks":
        """Nothing seen yet."""
        states = len(model.program.states)
        return cls(np.zeros(states + len(model.program.inputs)), states)

    def kept(self) -> KeptPeaks:
        """The same as a record."""
        leapt = tuple(sorted(self.leapt.items()))
        return KeptPeaks(tuple(self.both.tolist()), self.states, self.time, self.lingering, leapt)

    @classmethod
    def again(cls, kept: KeptPeaks) -> "Peaks":
        """What was kept."""
        both = np.array(kept.both)
        return cls(both, kept.states, kept.time, kept.lingering, dict(kept.leapt))

    @property
    def x(self) -> Array:
        """Of states."""
        return self.both[: self.states]

    @property
    def u(self) -> Array:
        """Of inputs."""
        return self.both[self.states :]

    def see(self, here: Sight, mode: Mode) -> None:
        """Take an instant into account, friction slipping in the given directions or forwards."""
        model = here.model
        affine = model.let_go_map(mode, len(here.pieces))
        if affine is not None and not affine.limited:
            x, terms = affine.rows(STATES).dot(here.vector), _affine_terms(here, affine)
        else:
            slipping, now = here.evaluated(mode)
            x, terms = now.x, input_terms(here, slipping)
        found = np.concatenate((np.abs(x), terms))
        # The same array stands for the same magnitudes.
        if not all_of(found <= self.both):
            self.both = np.maximum(self.both, found)

    def sizes(self, now: Snapshot) -> Array:
        """The largest magnitudes of states and inputs, one after the other, with an instant's own."""
        found: Array = np.maximum(np.abs(np.concatenate((now.x, now.u))), self.both)
        return found


@dataclass(frozen=True)
class Scales:
    """Below these a slip, an effort margin or a slip acceleration counts as zero, port by port."""

    slip: Array
    effort: Array
    acceleration: Array


def scales(model: ClosedModel, now: Snapshot, t: float = 0.0, peaks: Peaks | None = None) -> Scales:
    """The rounding to be expected, from the magnitude of the terms that cancel, and of the time's."""
    peaks, n = peaks or Peaks.none(model), len(now.x)
    late = TUNING.late * np.spacing(abs(t)) * np.abs(slip_rates(model, now))
    efforts = np.abs(now.u[model.friction_inputs]) + now.caps
    return scales_by(model.moves(now.numbers), peaks.sizes(now), n, efforts, late, peaks.time)


def scales_by(
    by: Moves, sizes: Array, states: int, efforts: Array, late: Array, time: float | Array
) -> Scales:
    """The same by what moves slips; of many runs, whose arrays have a row each, ``time`` a column.

    ``sizes``: of states and inputs, which are used up. ``efforts``: what ports give and may give. ``late``:
    what the time's rounding makes of slips. ``time`` [s]: the shortest time constant.
    """
    terms = dot(by.terms, sizes)
    count = terms.shape[-1] - states
    # At rest states are rounding themselves: of what moves them within a time constant.
    own = sizes[..., :states]
    np.maximum(own, time * terms[..., count:], out=own)
    moved = dot(by.pushes, sizes)
    return Scales(
        TUNING.rounding * (terms[..., :count] + moved * time) + late + TINY,
        TUNING.rounding * (efforts + moved * by.mobility) + TINY,
        TUNING.rounding * TUNING.pushes * moved + TINY,
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
    by = model.moves(now.numbers)
    rates = by.slips @ np.concatenate((now.x, now.u))
    if by.by_rates is not None:
        rates += by.by_rates @ now.du
    if model.bent:
        rates += moved_on(now.instant(0.0), model.moving)
    return np.asarray(rates, dtype=float)


def guard_rounding(here: Sight, mode: Mode, peaks: Peaks | None) -> Array:
    """Below these the guards count as zero, from the magnitude of the terms that make them up.

    At rest a state is rounding itself: of what moves it within a time constant.
    """
    model, t, s, pieces = here.model, here.t, here.s, here.pieces
    peaks = peaks or Peaks.none(model)
    now, n = here.at(mode), len(peaks.x)
    w, dw = model.given(t, pieces)
    by = model.moves(now.numbers).terms[len(mode) :]
    moving = by @ np.abs(np.concatenate((now.x, now.u)))
    sizes = np.abs(s)
    sizes[:n] = np.maximum(sizes[:n], np.maximum(peaks.x, peaks.time * moving))

    rows = model.guard_rows(mode, len(w))
    if rows is not None:
        ones = np.concatenate((sizes, np.abs(w), np.abs(dw), ONE))
        moved = np.concatenate((now.rate, _rates_of(pieces, t), np.zeros(len(w) + 1)))
        late = 16 * np.spacing(abs(t)) * np.abs(rows @ moved)
        return np.asarray(TUNING.rounding * (np.abs(rows) @ ones) + late + TINY, dtype=float)

    def by_state(at: Array) -> Array:
        return model.guards(t, model.at(t, at, pieces, mode))

    def by_input(at: Array) -> Array:
        return model.guards(t, model.evaluate(t, s, at, np.zeros(len(w)), mode))

    terms = terms_of(by_state, s, sizes, np.flatnonzero(sizes)) - np.abs(model.guards(t, now))
    terms += terms_of(by_input, w, np.abs(w), np.flatnonzero(w))
    late = 16 * np.spacing(abs(t)) * _slopes(here, mode)
    return np.asarray(TUNING.rounding * terms + late + TINY, dtype=float)


def _slopes(here: Sight, mode: Mode) -> Array:
    """How fast the guards change, by a difference over a moment."""
    model, t, pieces, now = here.model, here.t, here.pieces, here.at(mode)
    moment = TUNING.guard_moment * max(abs(t), TUNING.guard_floor)
    moved = here.s + moment * now.rate
    later = model.guards(t + moment, model.at(t + moment, moved, pieces, mode))
    return np.asarray(np.nan_to_num(np.abs(later - model.guards(t, now)) / moment), dtype=float)


def _rates_of(pieces: Sequence[Piece], t: float) -> Array:
    return np.array([piece.derivative(t) for piece in pieces])

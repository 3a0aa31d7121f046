"""Which friction ports stick and which way the others slip: one consistent mode at one instant."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.inputs.pieces import Piece
from codegen.model.closed import ClosedModel, Mode, Snapshot
from codegen.model.sizes import input_terms

TOLERANCE = 1e-10
"""Slips and efforts count as zero below this fraction of the terms that make them up."""

ROUNDING = 1e-4
"""A little later, an acceleration above this fraction of what counts as zero is a real one."""


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
        slipping = tuple(sign or 1 for sign in mode)
        self.x = np.maximum(self.x, np.abs(model.at(t, s, pieces, slipping).x))
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
    late = 16 * np.spacing(abs(t)) * np.abs(slip_rates(model, now))
    slip = np.abs(numbers.F[readings]) @ x + np.abs(numbers.D[readings]) @ u
    # At rest states are rounding themselves: of what moves them within a time constant.
    x = np.maximum(x, peaks.time * (np.abs(numbers.P) @ x + np.abs(numbers.Q) @ u))
    moved = (
        np.abs(numbers.F[readings] @ numbers.P) @ x + np.abs(numbers.F[readings] @ numbers.Q) @ u
    )
    efforts = np.abs(now.u[model.friction_inputs]) + now.caps
    inertia = np.array([
        abs(numbers.F[r] @ numbers.Q[:, c]) + abs(numbers.D[r, c])
        for r, c in zip(readings, model.friction_inputs, strict=True)
    ])  # fmt: skip
    driven = np.divide(moved, inertia, out=np.zeros_like(moved), where=inertia > 0)
    tiny = np.finfo(float).tiny
    return Scales(
        TOLERANCE * (slip + moved * peaks.time) + late + tiny,
        TOLERANCE * (efforts + driven) + tiny,
        TOLERANCE * 10 * moved + tiny,
    )


def decide(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    previous: Mode,
    at_zero: frozenset[int],
    ahead: float,
    peaks: Peaks | None = None,
    touched: frozenset[int] = frozenset(),
) -> Mode:
    """The mode just after t: every port in ``at_zero`` sticks if it can, else slips the way it is pushed.

    Other ports slip the way their slip shows. Where several modes are consistent, ports not ``touched``
    by the event keep their state. ``ahead`` [s] is how far to look where the instant itself
    does not decide. Raises `SimulationError`, with the numbers, if no mode is consistent.
    """
    if not previous:
        return ()
    undecided = set(at_zero) | {i for i in range(len(previous)) if model.coupled_directly(i)}
    now = model.at(t, s, pieces, tuple(sign or 1 for sign in previous))
    slips = now.y[model.friction_readings]
    near = scales(model, now, t, peaks).slip
    undecided |= {i for i, slip in enumerate(slips) if abs(slip) <= near[i]}
    tried = []
    for mode in _candidates(previous, slips, sorted(undecided), touched):
        complaint = _complaint(model, t, s, pieces, mode, undecided, ahead, peaks)
        if complaint is None:
            return mode
        tried.append(f"{mode}: {complaint}")
    names = ", ".join(repr(port.name) for port in model.program.friction)
    raise SimulationError(
        f"at t = {t:.9g} no way of sticking and slipping at {names} is consistent "
        f"(slips {slips.tolist()}); tried {'; '.join(tried)}"
    )


def _candidates(
    previous: Mode, slips: Array, undecided: list[int], touched: frozenset[int]
) -> Iterator[Mode]:
    """Modes by the number of ports that stick, most first; then those that change least."""

    def rank(choice: tuple[int, ...]) -> tuple[int, int]:
        kept = [i for i in undecided if i not in touched]
        changed = sum(choice[undecided.index(i)] != previous[i] for i in kept)
        return -choice.count(0), changed

    choices = sorted(
        product(*((0, previous[i] or 1, -(previous[i] or 1)) for i in undecided)),
        key=rank,
    )
    for choice in choices:
        mode = [1 if slip > 0 else -1 for slip in slips]
        for i, sign in zip(undecided, choice, strict=True):
            mode[i] = sign
        yield tuple(mode)


def _complaint(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    undecided: set[int],
    ahead: float,
    peaks: Peaks | None,
) -> str | None:
    """What contradicts a mode; None if it is consistent."""
    now = model.at(t, s, pieces, mode)
    size = scales(model, now, t, peaks)
    later: Snapshot | None = None
    for i in sorted(undecided):
        verdict = _stick_verdict(model, now, size, i) if mode[i] == 0 else _slip_verdict(
            model, now, size, i, mode[i]
        )  # fmt: skip
        if verdict == 0:
            later = later or a_moment_later(model, t, s, pieces, mode, ahead)
            verdict = _later_verdict(model, later, size, i, mode[i])
        if verdict < 0:
            name = model.program.friction[i].name
            effort = now.u[model.friction_inputs[i]]
            if mode[i] == 0:
                return f"{name!r} would need {effort:.6g} of at most {now.caps[i]:.6g} to stick"
            return f"{name!r} would not slip in the direction {mode[i]:+d}"
    return None


def _stick_verdict(model: ClosedModel, now: Snapshot, size: Scales, i: int) -> int:
    margin = now.caps[i] - abs(now.u[model.friction_inputs[i]])
    return 0 if abs(margin) <= size.effort[i] else (1 if margin > 0 else -1)


def _slip_verdict(model: ClosedModel, now: Snapshot, size: Scales, i: int, sign: int) -> int:
    """By the slip if efforts change it at once, else by its acceleration."""
    slip = sign * now.y[model.friction_readings[i]]
    if model.coupled_directly(i) and abs(slip) > size.slip[i]:
        return 1 if slip > 0 else -1
    pushed = sign * slip_rates(model, now)[i]
    return 0 if abs(pushed) <= size.acceleration[i] else (1 if pushed > 0 else -1)


def _later_verdict(model: ClosedModel, later: Snapshot, size: Scales, i: int, sign: int) -> int:
    """A tie decided a little later: still holding to rounding, or really moving off."""
    if sign == 0:
        margin = later.caps[i] - abs(later.u[model.friction_inputs[i]])
        return 1 if margin >= -size.effort[i] else -1
    slip = sign * later.y[model.friction_readings[i]]
    rounding = ROUNDING * size.acceleration[i]
    return 1 if sign * slip_rates(model, later)[i] > rounding or slip > size.slip[i] else -1


def slip_rates(model: ClosedModel, now: Snapshot) -> Array:
    """How fast each friction port's slip changes, inputs that cannot be differentiated held."""
    readings, numbers = model.friction_readings, now.numbers
    x_rate = numbers.P @ now.x + numbers.Q @ now.u + numbers.R @ now.du
    result: Array = numbers.F[readings] @ x_rate + numbers.D[readings] @ now.du
    return result


def a_moment_later(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, ahead: float
) -> Snapshot:
    """The model a little later in a mode, by one midpoint step."""
    half = s + 0.5 * ahead * model.at(t, s, pieces, mode).rate
    moved = s + ahead * model.at(t + 0.5 * ahead, half, pieces, mode).rate
    return model.at(t + ahead, moved, pieces, mode)

"""What keeps switches as they are; of affine modes that and their impacts as tables."""

from dataclasses import dataclass

import numpy as np

from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.affine import AffineMap
from codegen.program.layout import INPUTS, READINGS, STATES
from codegen.standalone.striking import rounded_by, struck
from codegen.tuning import TUNING

SLIPS, EFFORTS, GUARDS = range(3)
"""What keeps a switch: what it receives, what it gives, a condition of its own."""


def kept_by(model: ClosedModel, mode: Mode, port: int) -> tuple[int, int, int]:
    """What keeps a switch from changing over, its place there, and the sign with which it is positive."""
    switch, sign = model.switching[port], mode[port]
    assert switch is not None
    if not switch.side:
        return GUARDS, switch.condition(sign), -1
    return (SLIPS, port, switch.side) if sign else (EFFORTS, port, -switch.side)


def is_kept(model: ClosedModel, mode: Mode, port: int) -> bool:
    """Whether `watched_by` tells what is watched: of a switch, and of a jump of second order on a side."""
    return model.switching[port] is not None or (port in model.hung and mode[port] != 0)


def watched_by(model: ClosedModel, mode: Mode, port: int) -> tuple[int, int, int]:
    """The same of what is watched while the mode lasts: of a stop that is apart its gap.

    Of a jump of second order what it hangs on.
    """
    if port in model.hung:
        return GUARDS, model.hung[port], mode[port]
    switch = model.switching[port]
    if switch is not None and switch.stops and switch.is_on(mode[port]):
        return GUARDS, switch.guard, 1
    return kept_by(model, mode, port)


@dataclass(frozen=True)
class Impacts:
    """What an affine mode begins with, per unit of the slips that its switches stop.

    ``jump``: what s gains; ``shock``: how far the impulse goes with each switch's way; ``given``: what each
    port gives.
    """

    jump: Array
    shock: Array
    given: Array


def impacts_of(model: ClosedModel, mode: Mode) -> Impacts | None:
    """The impacts of a mode in which friction slips; None where nothing holds, or cannot."""
    if 0 not in mode:
        return None
    hold = model.hold(mode, model.constant)
    found = struck(hold, model.constant, np.eye(len(hold.mix)))
    jump = found.gained(model.size, model.law_rates)
    ways = _shocks(model, mode, found.given, found.received)
    return Impacts(jump.T, ways.T, found.given[model.friction_inputs].T)


def _shocks(model: ClosedModel, mode: Mode, given: Array, received: Array) -> Array:
    """How far impulses go with the way of each switch, less what is rounding of their terms."""
    terms = np.abs(model.constant.D) @ rounded_by(given)
    largest = np.abs(given).max(axis=0)
    guards = [_guards_pushed(model, g, r) for g, r in zip(given.T, received.T, strict=True)]
    rows = []
    for i, switch in enumerate(model.switching):
        if switch is None:
            rows.append((np.zeros(given.shape[1]), largest))
            continue
        part, at, sign = kept_by(model, mode, i)
        reading = model.friction_readings[i]
        if part == GUARDS:
            rows.append((np.array([sign * pushed[at] for pushed in guards]), largest))
        elif part == SLIPS:
            rows.append((sign * received[reading], terms[reading]))
        else:
            rows.append((sign * given[model.friction_inputs[i]], largest))
    return np.array([np.where(np.abs(way) <= TUNING.rounding * size, 0, way) for way, size in rows])


def _guards_pushed(model: ClosedModel, given: Array, received: Array) -> Array:
    """How affine conditions change with impulses."""
    program = model.program
    if not program.guards.results:
        return np.zeros(0)
    x, z = np.zeros(len(program.states)), np.zeros(len(program.law_states))
    u, w = np.zeros(len(program.inputs)), np.zeros(len(program.external))
    still = Snapshot(x, z, u, u, np.zeros(len(received)), w, w, w, model.constant)
    moved = still._replace(u=given, y=received)
    return np.asarray(model.guards(0.0, moved) - model.guards(0.0, still), dtype=float)


def keeping(model: ClosedModel, mode: Mode, affine: AffineMap) -> Array:
    """What keeps each switch of an affine mode, as rows over [s, w, w', 1]; of friction nothing.

    Of jumps of second order what they hang on.
    """
    rows = np.zeros((len(mode), affine.matrix.shape[1]))
    guards = model.guard_rows(mode, len(model.program.external))
    slips = affine.rows(READINGS)[model.friction_readings]
    efforts = affine.rows(INPUTS)[model.friction_inputs]
    for i, switch in enumerate(model.switching):
        if switch is not None:
            part, at, sign = kept_by(model, mode, i)
            found = (slips, efforts, guards)[part]
            assert found is not None
            rows[i] = sign * found[at]
        elif i in model.hung and guards is not None:
            rows[i] = guards[model.hung[i]]
    return rows


def becoming(model: ClosedModel, mode: Mode, affine: AffineMap) -> Array:
    """What resets set s to in an affine mode, as rows over [s, w, w', 1].

    What inputs that drive dependent storages add to states stays.
    """
    program, x = model.program, affine.rows(STATES)
    guards = model.guard_rows(mode, len(program.external))
    assert guards is not None
    found = []
    for one in program.resets:
        row = guards[one.value].copy()
        if one.place < len(x):
            row += np.eye(1, len(row), one.place)[0] - x[one.place]
        found.append(row)
    return np.array(found)

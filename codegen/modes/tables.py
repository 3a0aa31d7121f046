"""What affine modes of switches are judged by at a first look: tables, worked out once for each mode.

Bounds on what counts as zero are no smaller than what `rounding` finds, so a closer look, which is taken
wherever they are reached, would decide alike.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import GUARDS, SLIPS, impacts_of, keeping, kept_by
from codegen.numbers.arrays import Array
from codegen.program.affine import AffineMap
from codegen.program.layout import INPUTS, LAW_STATES, RATES_OF_INPUTS, READINGS, STATES


@dataclass(frozen=True)
class Glance:
    """What a mode is judged by, K ports, n states, m inputs, l states of laws, h slips that an impact stops.

    ``rows``: over [s, w, w', 1], what keeps each port, slips that an impact would stop, and [x, u, z, u', 1].
    ``least``: over magnitudes of [x, u, z, u', 1], bounds on what counts as zero of what keeps a port, four
    blocks of K rows: in roundings, these times a time constant, times its square, and in the time's own.
    ``still``: the same of the slips. ``shock``: how far the impulses go with each port's way, per slip;
    ``jump``: what they do to the values of ``rows``.
    """

    rows: Array
    least: Array
    still: Array
    shock: Array
    jump: Array
    #: Whether what keeps the ports are combinations of slips that only sources rule, which must be zero.
    ruled: bool = False

    @cached_property
    def shocks(self) -> Array:
        """The magnitudes of ``shock``."""
        return np.abs(self.shock)


def glance(model: ClosedModel, mode: Mode) -> Glance | None:
    """What a mode is judged by; None of modes with friction, and where a port takes a closer look."""
    try:
        return _glance(model, mode)
    except SimulationError:
        return None


def _glance(model: ClosedModel, mode: Mode) -> Glance | None:
    program, inputs = model.program, len(model.program.external)
    if model.rubbing or not program.affine or model.constant.R.any():
        return None
    loose, affine = (model.affine_map(one, inputs) for one in ((1,) * len(mode), mode))
    guards = model.guard_rows(mode, inputs)
    if affine is None or loose is None or guards is None:
        return None
    if 0 in mode and len(model.hold(mode, model.constant).ruled):
        return _ruled(model, mode, affine)
    least = _bounds(model, mode, guards)
    if least is None:
        return None
    kept, impacts = keeping(model, mode, affine), impacts_of(model, mode)
    slips, still = np.zeros((0, kept.shape[1])), np.zeros((0, least.shape[1]))
    if impacts is not None:
        hold = model.hold(mode, model.constant)
        slips = hold.slip_x @ loose.rows(STATES) + hold.slip_u @ loose.rows(INPUTS)
        still = np.vstack([np.abs(hold.mix) @ block[hold.ports] for block in _of_slips(model)])
    rows = np.vstack([kept, slips, _shown(affine)])
    if impacts is None:
        return Glance(rows, least, still, np.zeros((0, len(mode))), rows[:0])
    return Glance(rows, least, still, impacts.shock, impacts.jump @ rows[:, : model.size].T)


def _ruled(model: ClosedModel, mode: Mode, affine: AffineMap) -> Glance | None:
    """The same of a mode with slips that only sources rule; None where an impact may come before."""
    hold = model.hold(mode, model.constant)
    if len(hold.mix):
        return None
    slips = affine.rows(READINGS)[model.friction_readings][hold.ports]
    least = np.vstack([np.abs(hold.ruled) @ block[hold.ports] for block in _of_slips(model)])
    rows = np.vstack([hold.ruled @ slips, _shown(affine)])
    return Glance(rows, least, least[:0], rows[:0], rows[:0], ruled=True)


def _shown(affine: AffineMap) -> Array:
    """The rows of [x, u, z, u', 1]."""
    width = affine.matrix.shape[1]
    parts = (STATES, INPUTS, LAW_STATES, RATES_OF_INPUTS)
    return np.vstack([*(affine.rows(part) for part in parts), np.eye(1, width, width - 1)])


def _of_slips(model: ClosedModel) -> list[Array]:
    """Bounds on what counts as zero of slips: the four blocks."""
    moved, more = _moved(model)
    by = model.moves(model.constant)
    late = moved if by.by_rates is None else moved + _wide(model, 0 * by.pushes, by.by_rates)
    return [_wide(model, by.terms[: len(moved)]), moved, more, late]


def _moved(model: ClosedModel) -> tuple[Array, Array]:
    """How fast slips change at the most, at once and by what states change in a time constant."""
    by, count, n = model.moves(model.constant), len(model.switching), len(model.program.states)
    return _wide(model, by.pushes), _wide(model, by.pushes[:, :n] @ by.terms[count:])


def _wide(model: ClosedModel, rows: Array, rates: Array | None = None) -> Array:
    """Rows over [x, u], and over u', as rows over [x, u, z, u', 1]."""
    count, laws = len(rows), len(model.program.law_states)
    rates = np.zeros((count, len(model.program.inputs))) if rates is None else np.abs(rates)
    return np.hstack([rows, np.zeros((count, laws)), rates, np.zeros((count, 1))])


def _bounds(model: ClosedModel, mode: Mode, guards: Array) -> Array | None:
    """Bounds on what counts as zero of what keeps each port; None where that hangs on inputs' rates."""
    moved, more = _moved(model)
    slips, none = _of_slips(model), np.zeros(moved.shape[1])
    efforts, found = _efforts(model, mode), []
    for i in range(len(mode)):
        part, at, _ = kept_by(model, mode, i)
        if i in model.timed:
            found.append([none] * 4)
        elif part == SLIPS:
            found.append([block[at] for block in slips])
        elif part == GUARDS:
            blocks = _of_guard(model, guards[at])
            if blocks is None:
                return None
            found.append(blocks)
        else:
            mobility = model.moves(model.constant).mobility[at]
            found.append([efforts[at] + mobility * moved[at], mobility * more[at], none, none])
    return np.vstack([[blocks[k] for blocks in found] for k in range(4)])


def _efforts(model: ClosedModel, mode: Mode) -> Array:
    """The magnitudes of what makes the ports' efforts up."""
    n, inputs = len(model.program.states), model.friction_inputs
    rows = np.zeros((len(mode), n + len(model.program.inputs)))
    rates = np.zeros((len(mode), len(model.program.inputs)))
    rows[np.arange(len(mode)), n + np.array(inputs)] = 1.0
    if 0 in mode:
        hold = model.hold(mode, model.constant)
        X, U, V, inverse = hold.magnitudes
        rows[hold.ports] += inverse @ np.hstack([X, U])
        rates[hold.ports] = inverse @ V
    return _wide(model, rows, rates)


def _of_guard(model: ClosedModel, row: Array) -> list[Array] | None:
    """Bounds on what counts as zero of a condition; None where it reads inputs."""
    n, size, laws = len(model.program.states), model.size, len(model.program.law_states)
    own = np.abs(row)
    if own[size:-1].any():
        return None
    by, m = model.moves(model.constant), model.constant
    rates = by.terms[len(model.switching) :]
    own_rates = np.abs(np.hstack([m.F, m.D]))[model.law_rates]
    terms = np.concatenate(
        [own[:n], np.zeros(m.Q.shape[1]), own[n : n + laws], np.zeros(m.Q.shape[1] + 1)]
    )
    terms[-1] = own[-1]
    moving = _wide(model, (own[:n] @ rates)[None])[0]
    late = moving + _wide(model, (own[n : n + laws] @ own_rates)[None])[0]
    return [terms, moving, np.zeros_like(terms), late]

"""How large the terms are that make up what laws give: where they cancel, their rounding remains."""

from collections.abc import Sequence

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import INPUTS
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
    now = model.at(t, s, pieces, mode)
    terms = np.abs(now.u)
    for j in np.flatnonzero(s):
        moved = s.copy()
        moved[j] *= 1 + TUNING.term
        try:
            change = np.abs(model.at(t, moved, pieces, mode).u - now.u) / TUNING.term
        except SimulationError:
            continue
        terms += np.nan_to_num(change, nan=0.0, posinf=0.0)
    return terms

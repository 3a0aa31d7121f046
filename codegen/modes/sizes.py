"""How large the terms are that make up what laws give: where they cancel, their rounding remains."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import INPUTS
from codegen.standalone.levels import terms_of


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

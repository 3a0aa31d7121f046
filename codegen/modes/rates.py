"""The rates of a model's states at one instant, its ports in the mode that holds there."""

from collections.abc import Sequence

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.choices import Occasion
from codegen.modes.choose import decide
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def rates(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], before: Mode) -> Array:
    """The rates of the states of a model and of its laws.

    ``s``: the integrated vector, ``before``: the mode that is left. Where a switch holds what still
    moves, the rates are those just after the impact. `SimulationError` where there are none.
    """
    peaks, program = Peaks.none(model), model.program
    with np.errstate(all="ignore"):
        here = Sight(model, t, s, pieces)
        peaks.see(here, before)
        ahead = TUNING.look_ahead * TUNING.standing
        mode, s, *_ = decide(Occasion(model, t, pieces, before, ahead, peaks), here)
        now = model.at(t, s, pieces, mode)
    n = len(program.states)
    rate = now.rate[: n + len(program.law_states)].copy()
    if not program.varying:
        rate[:n] += now.numbers.R @ now.du
    return rate

"""How slips change, and how much states and inputs can do to them: for what rounding is."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.numbers.arrays import Array
from codegen.standalone.matrices import Numbers


@dataclass(frozen=True)
class Moves:
    """Rows over states and inputs, one after the other; K friction ports, n states, m inputs.

    ``slips``: how fast the slips change, K x (n + m); ``by_rates``: the same by rates of inputs, K x m, None
    where these do nothing. ``terms``: magnitudes of what makes slips up, then of the rates of states,
    (K + n) x (n + m). ``pushes``: those of ``slips``. ``mobility``: what each port's own effort divides by,
    zero where it moves nothing. Of many runs each is a stack.
    """

    slips: Array
    by_rates: Array | None
    terms: Array
    pushes: Array
    mobility: Array


def moves(numbers: Numbers, readings: Sequence[int], inputs: Sequence[int]) -> Moves:
    """Those of ports that receive these readings and give these inputs."""
    F, D = numbers.F[..., readings, :], numbers.D[..., readings, :]
    rates = np.concatenate([numbers.P, numbers.Q], axis=-1)
    slips, by_rates = F @ rates, F @ numbers.R + D
    pushes = np.abs(slips)
    own = ..., np.arange(F.shape[-2]), inputs
    inertia = pushes[..., numbers.P.shape[-1] :][own] + np.abs(D[own])
    mobility = np.divide(1.0, inertia, out=np.zeros_like(inertia), where=inertia > 0)
    terms = np.abs(np.concatenate([np.concatenate([F, D], axis=-1), rates], axis=-2))
    return Moves(slips, by_rates if by_rates.any() else None, terms, pushes, mobility)

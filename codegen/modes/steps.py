"""Lengths of fixed steps: the longest that is stable where a run starts, and round ones below it."""

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.errors import BondGraphError, ParameterError
from codegen.inputs.signal import Signal
from codegen.modes.closed import ClosedModel
from codegen.modes.stability import longest_stable_step
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

INTEGRATORS = ("rk4", "rosenbrock")
"""Methods of fixed steps: the classical one of order 4, and a linearly implicit one for stiff laws."""


def is_implicit(integrator: str) -> bool:
    """Whether a fixed step is linearly implicit; `ParameterError` for a method that is none of these."""
    if integrator not in INTEGRATORS:
        known = " and ".join(repr(one) for one in INTEGRATORS)
        raise ParameterError(
            f"there is no integrator {integrator!r} of fixed steps; there are {known}"
        )
    return integrator == "rosenbrock"


def step_at_start(model: ClosedModel, states: Array, signals: Sequence[Signal]) -> float:
    """The longest stable step [s] at time 0, in every friction mode; inf where nothing bounds it."""
    pieces = [signal.piece(0.0) for signal in signals]
    try:
        with np.errstate(all="ignore"):
            given, slopes = model.given(0.0, pieces)
            vector = model.vector(0.0, states, given)
            return longest_stable_step(model, 0.0, vector, given, slopes)
    except BondGraphError:
        return math.inf


def round_step(longest: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above a bound.

    >>> round_step(3e-4), round_step(1e-3)
    (0.0002, 0.001)
    """
    power = 10.0 ** math.floor(math.log10(longest))
    digit = max(one for one in (1, 2, 5) if one * power <= longest * (1 + TUNING.whole_steps))
    return float(f"{digit}e{round(math.log10(power))}")


UNBOUNDED = 1e300
"""The longest stable step [s] of a model that has none, where a finite number is wanted."""


def told_step(longest: float) -> float:
    """A step in six digits, which no linear algebra library sees differently.

    >>> told_step(0.00272546691181)
    0.00272547
    """
    return float(f"{min(longest, UNBOUNDED):.6g}")

"""`Prepared`: what a run of a differential needs, ready to be run, swept or exported."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bondgraph as bg
import codegen

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SAMPLE = 1e-3
"""Sampling interval of a simulation [s]."""


@dataclass(frozen=True)
class Prepared:
    """A full model in a scenario: equations, numbers, laws, start, inputs, samples [s].

    ``initially_on``: the switches of a file's graph that are on at first.
    """

    equations: bg.StateEquations
    parameters: Mapping[str, float]
    laws: Mapping[Hashable, object]
    initial: Mapping[str, float]
    inputs: Mapping[str, codegen.Signal]
    times: NDArray[np.float64]
    initially_on: tuple[Hashable, ...] = ()


def samples(duration: float) -> NDArray[np.float64]:
    """Times [s] every `SAMPLE` from 0 to the end of a run."""
    # What lists scenarios does without numpy.
    import numpy as np

    return np.linspace(0.0, duration, round(duration / SAMPLE) + 1)

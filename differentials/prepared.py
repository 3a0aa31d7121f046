"""`Prepared`: what a run of a differential needs, ready to be run, swept or exported."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import bondgraph as bg
import codegen

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

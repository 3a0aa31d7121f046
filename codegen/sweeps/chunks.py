"""Runs that are done together, and what they gave."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from codegen.numbers.arrays import Array
from codegen.sweeps.columns import Columns

NOTHING: Mapping[int, Mapping[str, float]] = MappingProxyType({})


class Chunk(NamedTuple):
    """Runs that are done together: their indices, and a row of numbers for each."""

    indices: Sequence[int] | NDArray[np.intp]
    rows: Sequence[Sequence[float]] | Array


class Outcome(NamedTuple):
    """What a chunk gave: for each run its measures, or the text of why there are none.

    ``seconds``: how long it took. ``fallen``: why numpy ran what C was asked to, once for each run.
    ``completed``: by index the states that a run's start did not name and that followed what switches held.
    """

    indices: Sequence[int] | NDArray[np.intp]
    results: Sequence[tuple[Array, ...] | str] | Columns
    seconds: float
    fallen: tuple[str, ...] = ()
    completed: Mapping[int, Mapping[str, float]] = NOTHING

"""What many runs gave, measure by measure."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.numbers.arrays import Array

Found = tuple[Array, ...] | str
"""A run's measures, or why there are none."""


@dataclass(frozen=True, eq=False)
class Columns:
    """An array for each measure with a row for each run.

    ``others``: what stands in no column, by the place of its run; so it is a sequence, run by run.
    """

    columns: tuple[Array, ...]
    others: Mapping[int, Found]

    def __len__(self) -> int:
        return len(self.columns[0])

    def __getitem__(self, at: int) -> Found:
        if at in self.others:
            return self.others[at]
        return tuple(np.array(column[at]) for column in self.columns)

    def __iter__(self) -> Iterator[Found]:
        return map(self.__getitem__, range(len(self)))

    @property
    def plain(self) -> NDArray[np.bool_]:
        """Which runs stand in the columns."""
        found = np.ones(len(self), dtype=bool)
        found[[*self.others]] = False
        return found

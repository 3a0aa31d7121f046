"""What a file or a frame recorded over time, in place of a run that is compared."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from bondgraph.errors import SignalError
from codegen.data.columns import read_columns
from codegen.numbers.arrays import Array, read_only

TIMES = ("t", "time")
"""What the column of time [s] is called: the first of these that there is."""


@dataclass(frozen=True)
class Recording:
    """Columns over time, read-only; it tells no events and no units."""

    time: Array = field(repr=False)
    columns: Mapping[str, Array] = field(repr=False)
    events: tuple[()] = ()
    units: Mapping[str, str] = field(repr=False, default_factory=lambda: MappingProxyType({}))

    @property
    def states(self) -> tuple[str, ...]:
        """All its columns, as it tells no states from others."""
        return tuple(self.columns)

    def __getitem__(self, name: str) -> Array:
        """The values of one column; `KeyError` naming what there is."""
        if name not in self.columns:
            raise KeyError(f"{name!r} is no column; there are {', '.join(self.columns)}")
        return self.columns[name]


def recording(source: Any, names: Sequence[str] | None = None) -> Recording:
    """The columns of these names, or all of numbers, over the column of time.

    Raises `SignalError` where there are none, or where time does not increase.

    >>> recording({"t": [0, 1], "v": [2, 4]})["v"]
    array([2., 4.])
    """
    found = read_columns(source, None if names is None else [TIMES, *names])
    columns = dict(zip(found.names, found.arrays, strict=True))
    axis = next((name for name in TIMES if name in columns), None)
    if axis is None:
        raise SignalError(f"{found.source} has no column {TIMES[0]!r} or {TIMES[1]!r} for time")
    time = columns.pop(axis)
    back = np.flatnonzero(~(np.diff(time) > 0))
    if len(back) or not len(time):
        where = found.place(int(back[0]) + 1) if len(back) else found.source
        raise SignalError(f"{where}, column {axis!r}: time must increase from row to row")
    kept = {name: read_only(column) for name, column in columns.items()}
    return Recording(read_only(time), MappingProxyType(kept))

"""`Columns`: columns of numbers by name, and where each row came from."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bondgraph.errors import SignalError, nearest
from codegen.numbers.arrays import Array

Column = str | int | tuple[str, ...]
"""A name, the first of several that there is, or in files of text a number, counted from 1."""

Place = Callable[[int], str]
"""What a message calls a row, such as "cycle.csv, line 7"."""

INSTALL = "install the optional extra: pip install bondgraph-toolkit[tables]"

LISTED = 12
"""Names that a message lists."""


@dataclass(frozen=True)
class Columns:
    """Columns of one length as finite numbers; ``source``: what messages call the table."""

    source: str
    names: tuple[str, ...]
    arrays: tuple[Array, ...]
    place: Place


def rows_of(source: str) -> Place:
    """Rows counted from 1."""
    return lambda row: f"{source}, row {row + 1}"


def chosen(source: str, known: Sequence[Any], wanted: Column) -> Any:
    """The column that is wanted; `SignalError` with the nearest one and those there are."""
    names = wanted if isinstance(wanted, tuple) else (wanted,)
    found = next((one for one in names if one in known), None)
    if found is not None:
        return found
    told, name = [str(one) for one in known], names[0]
    more = f" and {len(told) - LISTED} more" if len(told) > LISTED else ""
    listed = ", ".join(told[:LISTED]) + more or "none"
    other = "".join(f" or {one!r}" for one in names[1:])
    raise SignalError(
        f"{source} has no column {name!r}{other}{nearest(str(name), told)}; there are {listed}"
    )


def numbers(values: Any, name: str, source: str, place: Place) -> Array:
    """One column as finite floats; `SignalError` naming the row of what is none."""
    found = np.asarray(values)
    if found.ndim != 1:
        raise SignalError(
            f"{source}, column {name!r} has the shape {found.shape}; an input needs one number a row"
        )
    if found.dtype.kind in "Mm":
        raise SignalError(
            f"{source}, column {name!r} holds dates or durations; give seconds as numbers, such as "
            "(dates - dates[0]) / numpy.timedelta64(1, 's')"
        )
    if found.dtype.kind not in "iuf":
        found = _one_by_one(found.tolist(), name, place)
    column = np.array(found, dtype=np.float64)
    wrong = np.flatnonzero(~np.isfinite(column))
    if len(wrong):
        row = int(wrong[0])
        raise SignalError(
            f"{place(row)}, column {name!r}: {float(column[row])!r} is not a finite number; fill the gap, "
            "or leave the row out"
        )
    return column


def _one_by_one(values: Sequence[Any], name: str, place: Place) -> Any:
    """Numbers of a column that holds other things, too, as frames do where a value is missing."""
    for row, value in enumerate(values):
        if isinstance(value, bool) or not isinstance(value, int | float):
            told = "an empty cell" if value is None else f"{value!r}"[:40] + " is not a number"
            raise SignalError(f"{place(row)}, column {name!r}: {told}")
    return np.array(values, dtype=np.float64)

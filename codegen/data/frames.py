"""Columns of what gives them by name: frames of pandas, xarray, pyarrow, mappings. None is imported."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.errors import SignalError
from codegen.data.record import Column, Columns, chosen, numbers, rows_of


def read_frame(frame: Any, wanted: Sequence[Column] | None, source: str | None = None) -> Columns:
    """Columns by name, all of numbers in one row each if none are named; ``source``: the file it is of.

    Raises `SignalError` naming column and row for what is no number.
    """
    told = source or f"the {type(frame).__name__}"
    known = _names(frame, told)
    index = _index(frame, known)
    if wanted is None:
        wanted = [name for name in (*index, *known) if _plain(_column(frame, name, index))]
    place, arrays = rows_of(told), []
    names = [chosen(told, [*index, *known], one) for one in wanted]
    for name in names:
        arrays.append(numbers(_column(frame, name, index), str(name), told, place))
    lengths = {len(one) for one in arrays}
    if len(lengths) > 1:
        raise SignalError(f"{told}: columns of different lengths, {', '.join(map(str, lengths))}")
    return Columns(told, tuple(map(str, names)), tuple(arrays), place)


def _names(frame: Any, source: str) -> list[Any]:
    """The columns that there are, by the first of these that a frame tells."""
    if isinstance(frame, np.ndarray) and frame.dtype.names:
        return [*frame.dtype.names]
    for attribute in ("column_names", "variables", "columns"):
        if hasattr(frame, attribute) and hasattr(frame, "__getitem__"):
            return [*getattr(frame, attribute)]
    if isinstance(frame, Mapping):
        return [*frame]
    raise SignalError(
        f"{source} is neither a path nor a frame; give a path, a data frame of pandas, a data set of xarray, "
        "a table of pyarrow, or a mapping of names to arrays"
    )


def _index(frame: Any, known: Sequence[Any]) -> tuple[str, ...]:
    """The name of a data frame's index, if it has one that no column has."""
    name = getattr(getattr(frame, "index", None), "name", None)
    return () if not isinstance(name, str) or name in known else (name,)


def _column(frame: Any, name: Column, index: Sequence[Column]) -> Any:
    return np.asarray(frame.index if name in index else frame[name])


def _plain(values: Any) -> bool:
    return values.ndim == 1 and values.dtype.kind in "iuf"

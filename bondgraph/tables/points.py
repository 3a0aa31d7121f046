"""What users give as points becomes tuples of floats, each of them looked at."""

import math
from collections.abc import Sequence
from numbers import Real
from typing import Any

from bondgraph.errors import TableError
from bondgraph.tables.record import MOST, Sampled, check_axis, check_choices

Floats = tuple[float, ...]


def points(name: str, samples: Sequence[Any]) -> tuple[tuple[Floats, ...], list[Any]]:
    """Axes, and rows of values, still unchecked, from arrays or from one Series or DataFrame."""
    if len(samples) == 1:
        samples = _of_frame(name, samples[0])
    if len(samples) not in (2, 3):
        raise TableError(
            f"table {name!r}: give x and z, or x, y and z, or a pandas Series or DataFrame, "
            f"not {len(samples)} argument(s)"
        )
    *axes, rows = samples
    told = tuple(numbers(name, letter, axis) for letter, axis in zip("xy", axes, strict=False))
    return told, _listed(name, "z", rows)


def checked(
    name: str, axes: tuple[Floats, ...], rows: list[Any], method: object, outside: object
) -> Sampled:
    """The table of these points; `TableError` where they are none."""
    method = check_choices(name, len(axes), method, outside)
    for letter, axis in zip("xy", axes, strict=False):
        check_axis(name, letter, axis, method)
    count = len(axes[0])
    if len(rows) != count:
        raise TableError(
            f"table {name!r}: z has {len(rows)} row(s) for {count} of x; it needs one each"
        )
    if len(axes) == 1:
        values = numbers(name, "z", rows)
    else:
        values = tuple(
            value for at, row in enumerate(rows, 1) for value in _row(name, at, row, axes[1])
        )
    if len(values) > MOST:
        raise TableError(f"table {name!r}: {len(values)} values; at most {MOST} are allowed")
    return Sampled(name, axes, values, method, str(outside))


def _row(name: str, at: int, row: Any, columns: Floats) -> Floats:
    found = numbers(name, f"row {at} of z", row)
    if len(found) != len(columns):
        raise TableError(
            f"table {name!r}: row {at} of z has {len(found)} value(s) for {len(columns)} of y; "
            "it needs one each"
        )
    return found


def numbers(name: str, what: str, values: Any) -> Floats:
    """Finite floats; what is none is refused by its place, counted from 1."""
    return tuple(
        _number(name, what, at, value) for at, value in enumerate(_listed(name, what, values), 1)
    )


def _number(name: str, what: str, at: int, value: Any) -> float:
    whole = (
        value.item() if hasattr(value, "item") and getattr(value, "shape", None) == () else value
    )
    if isinstance(whole, bool) or not isinstance(whole, Real):
        raise TableError(f"table {name!r}: {what}, row {at}: {_short(whole)} is not a number")
    found = float(whole)
    if not math.isfinite(found):
        raise TableError(
            f"table {name!r}: {what}, row {at}: {found!r}; fill the gap or leave the row out"
        )
    return found + 0.0


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def _listed(name: str, what: str, values: Any) -> list[Any]:
    if isinstance(values, str | bytes | dict | set) or not hasattr(values, "__iter__"):
        raise TableError(f"table {name!r}: {what} must be a list or an array, not {_short(values)}")
    try:
        return list(values.tolist() if hasattr(values, "tolist") else values)
    except TypeError:
        raise TableError(f"table {name!r}: {what} is one number; a table needs several") from None


def _of_frame(name: str, frame: Any) -> tuple[Any, ...]:
    """A pandas Series by its index, a DataFrame by its index and columns; pandas itself is not needed."""
    if not (hasattr(frame, "index") and hasattr(frame, "to_numpy")):
        raise TableError(
            f"table {name!r}: {_short(frame)} is no pandas Series or DataFrame; give x and z, or x, y and z"
        )
    values = frame.to_numpy()
    if hasattr(frame, "columns") and len(frame.columns) != 1:
        return frame.index, frame.columns, values
    return frame.index, values.ravel()

"""Tables of a graph as plain data of a file, and back."""

from collections.abc import Mapping
from typing import Any

from bondgraph.algebra.lookup_table import LookupTable
from bondgraph.errors import FileFormatError, TableError
from bondgraph.tables.record import Sampled

AXES = ("x", "y")
NEEDED = ("name", "x", "z", "method", "outside")


def plain_table(table: Sampled) -> dict[str, Any]:
    """A table as texts and lists of numbers, in a file's order.

    >>> plain_table(LookupTable("map", [0, 1], [2, 4]))["z"]
    [2.0, 4.0]
    """
    axes = {letter: list(axis) for letter, axis in zip(AXES, table.axes, strict=False)}
    rows: list[Any] = list(table.values)
    if len(table.axes) == 2:
        width = len(table.axes[1])
        rows = [rows[at : at + width] for at in range(0, len(rows), width)]
    choices = {"method": table.method, "outside": table.outside}
    return {"name": table.name, **axes, "z": rows, **choices}


def restored_table(parts: Any, where: str) -> LookupTable:
    """The table that a file tells; `FileFormatError` or `TableError` for what is none."""
    if not isinstance(parts, Mapping):
        raise FileFormatError(f"{where}: a table must be an object, not {str(parts)[:40]!r}")
    unknown = sorted(set(parts) - {*NEEDED, "y"})
    missing = [key for key in NEEDED if key not in parts]
    if unknown or missing:
        told = f"{unknown[0][:40]!r} is unknown" if unknown else f"{missing[0]!r} is missing"
        raise FileFormatError(
            f"{where}: {told}; a table has name, x, y or none, z, method, outside"
        )
    for key in ("name", "method", "outside"):
        if not isinstance(parts[key], str):
            raise FileFormatError(f"{where}, {key}: {str(parts[key])[:40]!r} must be a text")
    samples = [parts[key] for key in ("x", "y", "z") if key in parts]
    for key, rows in zip(("x", "y", "z"), samples, strict=False):
        if not isinstance(rows, list):
            raise FileFormatError(f"{where}, {key}: {str(rows)[:40]!r} must be a list")
    try:
        return LookupTable(
            parts["name"], *samples, method=parts["method"], outside=parts["outside"]
        )
    except TableError as error:
        raise TableError(f"{where}: {error}") from None

"""Tables in CSV files: one axis in two columns, two axes as a grid."""

import csv
import math
import os
from pathlib import Path

from bondgraph.errors import TableError

MAX_BYTES = 10_000_000
"""Files beyond this are refused."""

Line = tuple[int, list[str]]
"""A line of the file by its number, and its cells."""


def read_points(name: str, path: str | os.PathLike[str]) -> tuple[list[object], ...]:
    """x and z, or x, y and z, of a file; `TableError` naming file and line for what is no number."""
    where = f"table {name!r}, {os.fspath(path)}"
    lines = _lines(path, where)
    if not lines:
        raise TableError(f"{where}: no lines; a table needs some points")
    width = len(lines[0][1])
    for number, cells in lines:
        if len(cells) != width:
            raise TableError(
                f"{where}, line {number}: {len(cells)} column(s), but the first line has {width}"
            )
    if width < 2:
        raise TableError(f"{where}: one column; a table needs x and z, or a grid")
    if width == 2:
        body = lines if is_number(lines[0][1][0]) else lines[1:]
        rows = [[_number(cell, where, number) for cell in cells] for number, cells in body]
        return [row[0] for row in rows], [row[1] for row in rows]
    (number, head), *body = lines
    y: list[object] = [_number(cell, where, number) for cell in head[1:]]
    rows = [[_number(cell, where, number) for cell in cells] for number, cells in body]
    return [row[0] for row in rows], y, [row[1:] for row in rows]


def _lines(path: str | os.PathLike[str], where: str) -> list[Line]:
    with Path(path).open("rb") as file:
        raw = file.read(MAX_BYTES + 1)
    if len(raw) > MAX_BYTES:
        raise TableError(f"{where}: more than {MAX_BYTES} bytes, too large for a table")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TableError(f"{where}: not UTF-8: {error.reason}") from None
    head = text.lstrip().partition("\n")[0]
    mark = max(",;\t", key=head.count)
    try:
        rows = list(csv.reader(text.splitlines(), delimiter=mark, strict=True))
    except csv.Error as error:
        raise TableError(f"{where}: not CSV: {error}") from None
    return [(at, row) for at, row in enumerate(rows, 1) if any(cell.strip() for cell in row)]


def is_number(cell: str) -> bool:
    """Whether a cell of a file reads as a number, be it finite or not."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _number(cell: str, where: str, line: int) -> float:
    if not cell.strip():
        raise TableError(f"{where}, line {line}: an empty cell; fill the gap or leave the line out")
    if not is_number(cell):
        raise TableError(f"{where}, line {line}: {cell.strip()[:40]!r} is not a number")
    value = float(cell)
    if not math.isfinite(value):
        raise TableError(f"{where}, line {line}: {cell.strip()[:40]} is not a finite number")
    return value

"""Columns of files of text: separated by commas, semicolons or tabs, with a line of names or without."""

import csv
import math
from array import array
from collections.abc import Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np

from bondgraph.errors import SignalError
from bondgraph.tables.read import is_number
from codegen.data.record import Column, Columns, chosen

MARKS = ",;\t"
"""What may separate the cells of a line; in the first line the most frequent one does."""

LOOKED = 1 << 16
"""Characters of the first line that are looked at for its mark."""


def read_text(path: Path, wanted: Sequence[Column] | None) -> Columns:
    """Columns by name or number, all if none are named; `SignalError` naming file, line and column."""
    source = str(path)
    with path.open(encoding="utf-8-sig", newline="") as file:
        try:
            return _read(file, source, wanted)
        except UnicodeDecodeError as error:
            raise SignalError(f"{source} is not text in UTF-8: {error.reason}") from None


def _read(file: TextIO, source: str, wanted: Sequence[Column] | None) -> Columns:
    head = file.readline(LOOKED)
    file.seek(0)
    lines = _lines(file, max(MARKS, key=head.count), source)
    first = list(islice(lines, 1))
    if not first:
        raise SignalError(f"{source} is empty; it needs a line of names and one for each sample")
    number, cells = first[0]
    named = not all(map(is_number, cells))
    names = cells if named else [str(at) for at in range(1, len(cells) + 1)]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise SignalError(f"{source}, line {number}: two columns are called {twice!r}; rename one")
    places = range(len(names)) if wanted is None else [_place(source, names, one) for one in wanted]
    numbers, found = array("q"), [array("d") for _ in places]
    for number, cells in lines if named else chain(first, lines):
        if len(cells) != len(names):
            raise SignalError(
                f"{source}, line {number}: {len(cells)} column(s), but the first line has {len(names)}"
            )
        numbers.append(number)
        for at, column in zip(places, found, strict=True):
            try:
                value = float(cells[at])
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                raise SignalError(_refusal(f"{source}, line {number}", names[at], cells[at]))
            column.append(value)
    return Columns(
        source, tuple(names[at] for at in places), tuple(map(np.array, found)),
        lambda row: f"{source}, line {numbers[row]}",
    )  # fmt: skip


def _lines(file: TextIO, mark: str, source: str) -> Iterator[tuple[int, list[str]]]:
    """The lines that are not empty by their numbers, as cells without blanks around."""
    reader = csv.reader(file, delimiter=mark, skipinitialspace=True, strict=True)
    try:
        for cells in reader:
            if any(cells):
                yield reader.line_num, [cell.strip() for cell in cells]
    except csv.Error as error:
        raise SignalError(f"{source}, line {reader.line_num}: not CSV: {error}") from None


def _place(source: str, names: Sequence[str], wanted: Column) -> int:
    """Where a column stands: by its name, else by its number."""
    told = str(wanted)
    if wanted not in names and told.isdecimal() and 1 <= int(told) <= len(names):
        return int(told) - 1
    return names.index(chosen(source, names, wanted))


def _refusal(where: str, name: str, cell: str) -> str:
    if not cell:
        return f"{where}, column {name!r}: an empty cell; fill the gap, or leave the line out"
    if is_number(cell):
        return (
            f"{where}, column {name!r}: {cell[:40]} is not a finite number; fill the gap, or leave the "
            "line out"
        )
    comma = "; write decimals with a point" if is_number(cell.replace(",", ".")) else ""
    return f"{where}, column {name!r}: {cell[:40]!r} is not a number{comma}"

"""Columns of a file or a frame, whatever wrote it."""

import os
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from bondgraph.errors import MissingExtraError, SignalError
from codegen.data.frames import read_frame
from codegen.data.matlab import read_matlab
from codegen.data.record import INSTALL, Column, Columns, chosen
from codegen.data.text import read_text

TEXT = (".csv", ".tsv", ".txt")
"""Endings of files of text."""

ENDINGS = (*TEXT, ".parquet", ".mat", ".nc")
"""Endings of all files that are read."""


def read_columns(source: Any, wanted: Sequence[Column] | None = None) -> Columns:
    """Columns of a path or a frame, all of numbers if none are named.

    Raises `SignalError` naming file, line or row, and column for what cannot be used, `MissingExtraError`
    without the package that reads a file.

    >>> read_columns({"t": [0, 1], "v": [2, 4]}, ["v"]).arrays
    (array([2., 4.]),)
    """
    if not isinstance(source, str | os.PathLike):
        return read_frame(source, wanted)
    path = Path(source)
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise SignalError(f"{str(path)!r} must end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    try:
        if ending in TEXT:
            return read_text(path, wanted)
        if not path.is_file():
            raise FileNotFoundError(2, "there is no such file")
        if ending == ".mat":
            return read_frame(read_matlab(path), wanted, str(path))
        return _parquet(path, wanted) if ending == ".parquet" else _netcdf(path, wanted)
    except OSError as error:
        raise SignalError(f"{path} cannot be read: {error.strerror or error}") from None


def _parquet(path: Path, wanted: Sequence[Column] | None) -> Columns:
    if find_spec("pyarrow") is None:
        raise MissingExtraError(f"parquet files need pyarrow; {INSTALL}")
    import pyarrow
    import pyarrow.parquet

    try:
        known = pyarrow.parquet.read_schema(path).names
        names = None if wanted is None else [chosen(str(path), known, one) for one in wanted]
        found = pyarrow.parquet.read_table(path, columns=names)
    except pyarrow.ArrowInvalid as error:
        raise SignalError(f"{path} is no parquet file: {error}") from None
    return read_frame(found, names, str(path))


def _netcdf(path: Path, wanted: Sequence[Column] | None) -> Columns:
    if find_spec("xarray") is None:
        raise MissingExtraError(f"netCDF files need xarray; {INSTALL}")
    import xarray

    try:
        found = xarray.open_dataset(path, decode_times=False)
    except ValueError as error:
        if find_spec("h5netcdf") is None:
            raise MissingExtraError(f"netCDF files need h5netcdf; {INSTALL}") from None
        raise SignalError(f"{path} is no netCDF file: {error}") from None
    with found:
        return read_frame(found, wanted, str(path))

"""Runs as tables of other packages: xarray, pandas, and files of netCDF. The extra ``tables``."""

from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from io import BytesIO
from os import PathLike
from typing import Any

import numpy as np

from bondgraph.errors import MissingExtraError
from bondgraph.writing import replacing, write_bytes
from codegen.data.record import INSTALL
from codegen.numbers.arrays import Array
from codegen.runs.track import Event


def free(name: str, taken: Mapping[str, object]) -> str:
    """A name for an axis that no signal has: underscores are appended until it is free.

    >>> free("time", {"time": 0})
    'time_'
    """
    while name in taken:
        name += "_"
    return name


def dataset(
    time: Array, columns: Mapping[str, Array], attributes: Mapping[str, Mapping[str, str]],
    events: Sequence[Event],
) -> Any:  # fmt: skip
    """An `xarray.Dataset` over time [s], with the events along an axis of their own.

    ``attributes``: of columns, by name.
    """
    try:
        import xarray
    except ImportError:
        raise MissingExtraError(f"data sets need xarray; {INSTALL}") from None
    axis, event = free("time", columns), free("event", columns)
    parts = {
        "event_time": (event, np.array([one.time for one in events], dtype=float), {"units": "s"}),
        "event_port": (event, np.array([str(one.port) for one in events], dtype=str)),
        "event_kind": (event, np.array([one.kind for one in events], dtype=str)),
    }
    coordinates: dict[str, Any] = {axis: (axis, time.copy(), {"units": "s"})}
    coordinates |= {free(name, columns): part for name, part in parts.items()}
    data = {
        name: (axis, values.copy(), dict(attributes.get(name, {})))
        for name, values in columns.items()
    }
    return xarray.Dataset(data, coordinates)


def frame(time: Array, columns: Mapping[str, Array]) -> Any:
    """A `pandas.DataFrame` with a row for each sample, over time [s]."""
    try:
        import pandas
    except ImportError:
        raise MissingExtraError(f"data frames need pandas; {INSTALL}") from None
    return pandas.DataFrame(
        dict(columns), index=pandas.Index(time, name=free("time", columns)), copy=True
    )


def write_columns(
    path: str | PathLike[str], names: Sequence[str], columns: Sequence[Array]
) -> None:
    """Write columns as comma-separated text with one line of names, in digits that give them back."""
    table = np.column_stack([*columns])
    with replacing(path) as file:
        np.savetxt(
            file, table, delimiter=",", header=",".join(names), comments="", fmt="%.17g",
            encoding="utf-8",
        )  # fmt: skip


def write_netcdf(table: Any, path: str | PathLike[str]) -> None:
    """Write a data set as a netCDF-4 file; `MissingExtraError` without h5netcdf.

    It is made in memory: HDF5 ends the process where a disk is full.
    """
    if find_spec("h5netcdf") is None:
        raise MissingExtraError(f"netCDF files need h5netcdf; {INSTALL}")
    made = BytesIO()
    table.to_netcdf(made, engine="h5netcdf")
    write_bytes(path, made.getvalue())

"""`Timed`: columns over time, and the files that they go to."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from os import PathLike
from typing import Any

from codegen.numbers.arrays import Array
from codegen.record.files import write_mat, write_parquet
from codegen.record.tables import frame, free, write_columns, write_netcdf
from codegen.runs.track import Event


class Timed(ABC):
    """A record of signals over time [s]: ``columns`` by name, ``units`` of those of which they are known."""

    time: Array
    columns: Mapping[str, Array]
    units: Mapping[str, str]
    events: tuple[Event, ...]

    @abstractmethod
    def to_xarray(self) -> Any:
        """An `xarray.Dataset` of every column over "time" [s]; `MissingExtraError` without xarray."""

    def write_csv(self, path: str | PathLike[str]) -> None:
        """Write time and every column as comma-separated columns with one line of names.

        Raises `WriteError` where that cannot be; what was there is kept.
        """
        write_columns(path, ["t", *self.columns], [self.time, *self.columns.values()])

    def to_pandas(self) -> Any:
        """A `pandas.DataFrame` of every column over time [s]; `MissingExtraError` without pandas."""
        return frame(self.time, self.columns)

    def write_netcdf(self, path: str | PathLike[str]) -> None:
        """Write `to_xarray` as a netCDF file, which ``xarray.open_dataset`` reads back digit for digit.

        Raises `MissingExtraError` without xarray or h5netcdf, `WriteError` where the file cannot be written.
        """
        write_netcdf(self.to_xarray(), path)

    def write_parquet(self, path: str | PathLike[str]) -> None:
        """Write time, as "t", and every column as a parquet file, digit for digit.

        Units are metadata of its columns, ``unit``; events, as JSON, are metadata of the table. Raises
        `MissingExtraError` without pyarrow, `WriteError` where the file cannot be written.
        """
        write_parquet(path, *self._timed(), self.events)

    def write_mat(self, path: str | PathLike[str]) -> None:
        """Write time, as "t", and every column as variables of a MAT file, for MATLAB and Octave.

        The variable ``signals`` lists variable, signal and unit, as not every name is one in MATLAB; events
        are ``event_time``, ``event_port`` and ``event_kind``. Raises `SignalError` for a name beyond 63
        characters, `WriteError` where the file cannot be written.
        """
        write_mat(path, *self._timed(), self.events)

    def _timed(self) -> tuple[list[str], list[Array], dict[str, str]]:
        """Names, columns and units with those of time in front."""
        t = free("t", self.columns)
        return [t, *self.columns], [self.time, *self.columns.values()], {**self.units, t: "s"}

"""Files that grow by rows: tables of numbers and of events, as CSV and as parquet."""

import csv
import io
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import numpy as np

from bondgraph.errors import MissingExtraError, SignalError
from codegen.data.record import INSTALL
from codegen.numbers.arrays import Array
from codegen.runs.track import Event

ENDINGS = (".csv", ".parquet")
"""Of files that grow."""

GROUP = 1 << 16
"""Rows that a parquet file holds together."""

EVENTS = ("event_time", "event_port", "event_kind", "event_impulse")
"""Columns of a table of events."""


class Growing(Protocol):
    """A table in a file that rows are added to."""

    def begin(self) -> None:
        """Begin the file, perhaps once more: without rows."""

    def add(self, columns: Sequence[Array]) -> None:
        """More rows, as columns."""

    def end(self) -> None:
        """Write what is left."""

    def clear(self) -> None:
        """Leave an empty file."""


def checked_ending(path: Path) -> str:
    """How the name of a file ends; `SignalError` for none that grows, `MissingExtraError` without pyarrow."""
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise SignalError(f"{str(path)!r} must end in {' or '.join(ENDINGS)}: only such files grow")
    if ending == ".parquet" and find_spec("pyarrow") is None:
        raise MissingExtraError(f"parquet files need pyarrow; {INSTALL}")
    return ending


def numbers_into(
    file: BinaryIO, ending: str, names: Sequence[str], units: Mapping[str, str]
) -> Growing:
    """A table of numbers, which gives each back digit for digit."""
    if ending == ".csv":
        return _Csv(file, names)
    import pyarrow

    fields = [
        pyarrow.field(
            name, pyarrow.float64(), metadata={"unit": units[name]} if name in units else None
        )
        for name in names
    ]
    return _Parquet(file, pyarrow.schema(fields))


def events_into(file: BinaryIO, ending: str) -> Growing:
    """A table of events: times and impulses as numbers, ports and kinds as text."""
    if ending == ".csv":
        return _EventCsv(file)
    import pyarrow

    number, text = pyarrow.float64(), pyarrow.string()
    kinds = zip(EVENTS, (number, text, text, number), strict=True)
    return _Parquet(file, pyarrow.schema([pyarrow.field(*one) for one in kinds]))


def event_columns(events: Sequence[Event]) -> list[Any]:
    """Events as columns."""
    return [
        np.array([one.time for one in events], dtype=np.float64),
        [str(one.port) for one in events],
        [one.kind for one in events],
        np.array([one.impulse for one in events], dtype=np.float64),
    ]


class _Table:
    """What is in a file."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def clear(self) -> None:
        """See `Growing`."""
        self._file.seek(0)
        self._file.truncate()


class _Csv(_Table):
    """Comma-separated text with one line of names."""

    def __init__(self, file: BinaryIO, names: Sequence[str]) -> None:
        super().__init__(file)
        self._head = ",".join(names) + "\n"

    def begin(self) -> None:
        """See `Growing`."""
        self.clear()
        self._file.write(self._head.encode())

    def add(self, columns: Sequence[Array]) -> None:
        """See `Growing`."""
        np.savetxt(self._file, np.column_stack(columns), delimiter=",", fmt="%.17g")

    def end(self) -> None:
        """See `Growing`."""


class _EventCsv(_Csv):
    """The same of events, whose ports may have any name."""

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file, EVENTS)

    def add(self, columns: Sequence[Any]) -> None:
        """See `Growing`."""
        made = io.StringIO()
        lines = csv.writer(made, lineterminator="\n")
        lines.writerows(
            (f"{t:.17g}", port, kind, f"{impulse:.17g}")
            for t, port, kind, impulse in zip(*columns, strict=True)
        )
        self._file.write(made.getvalue().encode())


class _Parquet(_Table):
    """A parquet file, whose rows are written in groups; by its name, so that Ctrl-C does not come between."""

    def __init__(self, file: BinaryIO, schema: Any) -> None:
        super().__init__(file)
        self._schema = schema
        self._opened: tuple[Any, Any] | None = None
        self._waiting: list[Any] = []
        self._rows = 0

    def begin(self) -> None:
        """See `Growing`."""
        import pyarrow.parquet

        self.clear()
        into = pyarrow.OSFile(self._file.name, "wb")
        # Numbers that hardly recur would fill a dictionary for nothing.
        texts = [one.name for one in self._schema if one.type == pyarrow.string()]
        writer = pyarrow.parquet.ParquetWriter(into, self._schema, use_dictionary=texts or False)
        self._opened = writer, into

    def add(self, columns: Sequence[Any]) -> None:
        """See `Growing`."""
        import pyarrow

        kinds = zip(columns, self._schema.types, strict=True)
        arrays = [pyarrow.array(one, type=kind) for one, kind in kinds]
        self._waiting.append(pyarrow.RecordBatch.from_arrays(arrays, schema=self._schema))
        self._rows += len(columns[0])
        if self._rows >= GROUP:
            self._write()

    def end(self) -> None:
        """See `Growing`."""
        self._write()
        self._close()

    def clear(self) -> None:
        """See `Growing`."""
        self._waiting, self._rows = [], 0
        self._close()
        super().clear()

    def _write(self) -> None:
        import pyarrow

        if self._rows and self._opened is not None:
            table = pyarrow.Table.from_batches(self._waiting, schema=self._schema)
            count, self._waiting, self._rows = self._rows, [], 0
            self._opened[0].write_table(table.combine_chunks(), row_group_size=count)

    def _close(self) -> None:
        """Write the file's end, without which nobody reads it."""
        if self._opened is not None:
            (writer, into), self._opened = self._opened, None
            try:
                writer.close()
            finally:
                into.close()

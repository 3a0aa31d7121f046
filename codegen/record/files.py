"""Runs as files of other programs: parquet, and MAT for MATLAB and Octave."""

import json
from collections.abc import Iterable, Mapping, Sequence
from importlib.util import find_spec
from io import BytesIO
from os import PathLike
from typing import Any

import numpy as np

from bondgraph.errors import MissingExtraError, SignalError
from bondgraph.writing import write_bytes
from codegen.data.matlab import SIGNALS
from codegen.data.record import INSTALL
from codegen.numbers.arrays import Array
from codegen.program.identifiers import identifiers
from codegen.runs.track import Event

HEAD = b"MATLAB 5.0 MAT-file, written by bondgraph-toolkit"
"""In place of the text that scipy writes, which holds the time of day."""

LONGEST = 63
"""Characters of a variable's name that MATLAB reads."""

EVENTS = ("event_time", "event_port", "event_kind")
"""Variables of a MAT file with a row for each event."""


def write_parquet(
    path: str | PathLike[str], names: Sequence[str], columns: Sequence[Array],
    units: Mapping[str, str], events: Sequence[Event] = (),
) -> None:  # fmt: skip
    """Columns as a parquet file; units are metadata of the columns, events, as JSON, of the table.

    Raises `MissingExtraError` without pyarrow, `WriteError` where the file cannot be written.
    """
    if find_spec("pyarrow") is None:
        raise MissingExtraError(f"parquet files need pyarrow; {INSTALL}")
    import pyarrow
    import pyarrow.parquet

    fields = [
        pyarrow.field(
            name, pyarrow.float64(), metadata={"unit": units[name]} if name in units else None
        )
        for name in names
    ]
    told = [[event.time, str(event.port), event.kind] for event in events]
    schema = pyarrow.schema(fields, metadata={"events": json.dumps(told, ensure_ascii=False)})
    arrays = [np.asarray(column, dtype=np.float64) for column in columns]
    table = pyarrow.Table.from_arrays([pyarrow.array(one) for one in arrays], schema=schema)
    made = BytesIO()
    pyarrow.parquet.write_table(table, made)
    write_bytes(path, made.getvalue())


def write_mat(
    path: str | PathLike[str], names: Sequence[str], columns: Sequence[Array],
    units: Mapping[str, str], events: Sequence[Event] | None = None,
) -> None:  # fmt: skip
    """Columns as variables of a MAT file, which MATLAB and Octave load.

    ``signals`` lists variable, signal and unit: what is no name in MATLAB has another. ``events``: kept where
    they are told. Raises `WriteError` where the file cannot be written.
    """
    from scipy.io import savemat

    variables = _variables(names, EVENTS if events is not None else ())
    table = np.empty((len(names), 3), dtype=object)
    table[:] = [(variable, name, units.get(name, "")) for name, variable in variables.items()]
    found: dict[str, Any] = {SIGNALS: table}
    found |= dict(zip(variables.values(), columns, strict=True))
    if events is not None:
        found["event_time"] = np.array([one.time for one in events], dtype=np.float64)
        found["event_port"] = _cells(str(one.port) for one in events)
        found["event_kind"] = _cells(one.kind for one in events)
    made: Any = BytesIO()
    savemat(made, found, oned_as="column")
    write_bytes(path, HEAD.ljust(116) + made.getvalue()[116:])


def _cells(texts: Iterable[str]) -> Any:
    told = [*texts]
    cells = np.empty(len(told), dtype=object)
    cells[:] = told
    return cells


def _variables(names: Sequence[str], taken: Sequence[str]) -> Mapping[str, str]:
    """A name in MATLAB for each signal; its own where that can be."""
    found = identifiers(names, "matlab", (*taken, SIGNALS))
    long = [name for name, variable in found.items() if len(variable) > LONGEST]
    if long:
        raise SignalError(
            f"{long[0]!r} makes a name of more than {LONGEST} characters in MATLAB; rename it, or write "
            "another kind of file"
        )
    return found

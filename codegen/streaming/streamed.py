"""`Streamed`: what is left of a run whose samples are in a file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from codegen.data.columns import read_columns
from codegen.numbers.arrays import Array


@dataclass(frozen=True)
class Streamed:
    """A run that was written to a file as it went on: how much there is, and where it ended.

    ``path``: the table of its samples, over "t" [s]. ``events_path``: that of its events; None where they
    were not kept. ``samples``, ``events``: how many there are. ``signals``: the columns beside the time.
    ``final``: what the columns of a run and the signals written were at the last sample, just after what
    happens there. ``units``, ``backend``, ``completed``: as of a `Result`.
    """

    path: Path
    events_path: Path | None
    samples: int
    events: int
    signals: tuple[str, ...]
    final: Mapping[str, float] = field(repr=False)
    units: Mapping[str, str] = field(repr=False)
    backend: str
    completed: Mapping[str, float] = field(repr=False)

    def read(self, *names: str) -> Mapping[str, Array]:
        """These columns of the file, digit for digit as a run has them; time and all if none is named.

        It takes the memory of what is read. Raises `SignalError` for a name that the file does not have.
        """
        found = read_columns(self.path, names or None)
        return dict(zip(found.names, found.arrays, strict=True))

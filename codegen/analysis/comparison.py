"""`compare`: how far runs differ in signals and events."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from bondgraph.errors import SignalError
from bondgraph.show.blocks import aligned
from codegen.analysis.recording import Recording, recording
from codegen.numbers.arrays import Array
from codegen.pictures.labels import measured, plain
from codegen.pictures.marks import Marks
from codegen.pictures.stacked import Line, Panel, stacked
from codegen.record.result import Result, values_of


class Difference(NamedTuple):
    """The largest difference of a signal between a run and the first, and when [s].

    ``relative``: over the range of the first run's values; infinite where that is zero and they differ.
    """

    signal: str
    run: str
    largest: float
    time: float
    relative: float


class Shift(NamedTuple):
    """The n-th event of a kind at a port, in the first run and in another; None where a run has none."""

    port: Hashable
    kind: str
    run: str
    first: float | None
    other: float | None

    @property
    def shift(self) -> float | None:
        """How much later it is in the other run [s]."""
        if self.first is None or self.other is None:
            return None
        return self.other - self.first


@dataclass(frozen=True)
class Comparison:
    """Runs, and recordings from files, by name; the first is what the others are compared with."""

    runs: Mapping[str, Result | Recording] = field(repr=False)
    signals: tuple[str, ...]
    differences: tuple[Difference, ...]
    shifts: tuple[Shift, ...]

    def __str__(self) -> str:
        """Differences and shifts of events as tables."""
        first = next(iter(self.runs))
        rows = [(f"against {first}", "largest", "of range", "at")]
        rows += [
            (f"{d.signal}, {d.run}", f"{d.largest:.4g}", f"{d.relative:.2g}", f"{d.time:.6g} s")
            for d in self.differences
        ]
        lines = aligned(rows)
        if self.shifts:
            events = [("events", first, "other", "later by")]
            events += [
                (f"{s.port}: {s.kind}, {s.run}", _time(s.first), _time(s.other), _time(s.shift, 3))
                for s in self.shifts
            ]
            lines += ["", *aligned(events)]
        return "\n".join(lines)

    def plot(self, title: str = "") -> Any:
        """A `matplotlib.figure.Figure`: a panel for each signal, the runs over one another.

        Each run's events are marked in its colour. Raises `MissingExtraError` without matplotlib.
        """
        first = next(iter(self.runs.values()))
        shown = [
            Panel(
                measured(name, first.units.get(name, "")),
                tuple(
                    Line(run.time, values_of(run, name), plain(key))
                    for key, run in self.runs.items()
                ),
            )
            for name in self.signals
        ]
        events = [(event, at) for at, run in enumerate(self.runs.values()) for event in run.events]
        marks = Marks(tuple(e for e, _ in events), owners=tuple(at for _, at in events))
        return stacked(shown, marks, title, tall=2.4 if len(shown) < 3 else 1.6)


def _time(value: float | None, digits: int = 6) -> str:
    return "-" if value is None else f"{value:.{digits}g} s"


def compare(
    runs: Mapping[str, Any] | Sequence[Any], names: Sequence[str] | None = None
) -> Comparison:
    """Compare signals of two or more runs, the states of the first if none are named, and their events.

    In place of a run may stand a file or a frame, as `Sampled.read` takes them, whose time [s] is the column
    "t" or "time"; it has the signals that its columns are called by, and no events.

    Signals are compared at the first run's samples, as far as both runs go; between samples of another
    run straight lines are drawn. At a jump that comes a moment later the whole jump is the difference. A
    list of runs counts as called "1", "2" and so on.

    Raises `SignalError` for fewer than two runs, unknown names, runs that have no time in common, and files
    that cannot be used; `MissingExtraError` without the package that reads a file.
    """
    given = dict(runs) if isinstance(runs, Mapping) else {}
    if not isinstance(runs, Mapping):
        given = {str(at): run for at, run in enumerate(runs, 1)}
    if len(given) < 2:
        raise SignalError(f"{len(given)} runs; comparing needs two or more")
    if isinstance(names, str):
        raise SignalError(f"names must be a list of signals, not {names!r}")
    (key, begun), *rest = given.items()
    first = begun if isinstance(begun, Result) else recording(begun, names)
    signals = tuple(first.states if names is None else names)
    if not signals:
        raise SignalError(f"names must be a list of signals, not {names!r}")
    others = [(at, one if isinstance(one, Result) else recording(one, signals)) for at, one in rest]
    differences = [_difference(name, first, at, run) for name in signals for at, run in others]
    shifts = [shift for at, run in others for shift in _shifts(first, run, at)]
    named = MappingProxyType({key: first, **dict(others)})
    return Comparison(named, signals, tuple(differences), tuple(shifts))


def _difference(
    name: str, first: Result | Recording, key: str, other: Result | Recording
) -> Difference:
    mine, theirs = values_of(first, name), values_of(other, name)
    inside = (first.time >= other.time[0]) & (first.time <= other.time[-1])
    if not inside.any():
        raise SignalError(f"run {key!r} has no time in common with the first")
    apart = abs(np.interp(first.time[inside], other.time, theirs) - mine[inside])
    at = int(np.argmax(apart))
    largest = float(apart[at])
    return Difference(
        name, key, largest, float(first.time[inside][at]), _over_range(largest, mine[inside])
    )


def _over_range(largest: float, values: Array) -> float:
    size = float(np.ptp(values))
    if size:
        return largest / size
    return float("inf") if largest else 0.0


def _shifts(first: Result | Recording, other: Result | Recording, run: str) -> list[Shift]:
    """Events of a port and kind side by side, in their order, earliest first; a recording knows none."""
    if isinstance(first, Recording) or isinstance(other, Recording):
        return []
    both = first.events, other.events
    kinds = dict.fromkeys((event.port, event.kind) for side in both for event in side)
    found = []
    for port, kind in kinds:
        sides = ([e.time for e in side if (e.port, e.kind) == (port, kind)] for side in both)
        found += [Shift(port, kind, run, a, b) for a, b in zip_longest(*sides)]
    return sorted(
        found, key=lambda shift: min(t for t in (shift.first, shift.other) if t is not None)
    )

"""`CoSimulation`: the record of several models that ran side by side."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bondgraph.errors import SignalError, nearest
from codegen.cosimulation.ends import end_of
from codegen.numbers.arrays import Array, read_only
from codegen.pictures.stacked import stacked
from codegen.record.result import Result, grouped, marks_of, panel_of
from codegen.record.tables import dataset
from codegen.record.timed import Timed
from codegen.runs.track import Event


@dataclass(frozen=True)
class CoSimulation(Timed):
    """Every participant's signals at the communication points: ``result["plant.omega"]``.

    ``time`` [s]; ``participants``: their names; ``columns``: signals by name, read-only arrays; ``units``: of
    those of which participants tell them; ``events``: of our models, in order, ports named as signals are.
    ``connections``: of each connected input what it is connected to. At each point a sample shows what there
    is under the inputs that hold from it on; what a unit of others gives is told by those that held before.
    `cosimulate` makes it.

    >>> import bondgraph as bg
    >>> from codegen import cosimulate, simulator
    >>> def mass(force): return simulator(bg.derive(bg.graph(
    ...     [bg.Se("push", force), bg.One("cart"), bg.I("m", 2, flow="v")], "push > cart > m")), {})
    >>> run = cosimulate({"a": mass("F")}, {}, end=1, every=0.5, inputs={"a.F": 4})
    >>> run["a.v"].tolist(), run.of("a").states, list(run)
    ([0.0, 1.0, 2.0], ('v',), ['a.v', 'a.F', 'a.f_push'])
    """

    time: Array = field(repr=False)
    participants: tuple[str, ...]
    columns: Mapping[str, Array] = field(repr=False)
    units: Mapping[str, str] = field(repr=False)
    events: tuple[Event, ...]
    connections: Mapping[str, str] = field(repr=False)
    results: Mapping[str, Result] = field(repr=False)
    #: Connected inputs that were not held.
    lines: frozenset[str] = field(repr=False, default=frozenset())

    def __getitem__(self, name: str) -> Array:
        """The values of one signal; `KeyError` naming what there is."""
        if name in self.columns:
            return self.columns[name]
        part, _, signal = name.partition(".")
        if part in self.results:
            try:
                return self.results[part][signal]
            except KeyError as error:
                raise KeyError(f"participant {part!r}: {error.args[0]}") from None
        raise KeyError(
            f"there is no signal {name!r}{nearest(name, self.columns)}; there are {', '.join(self.columns)}"
        )

    def __iter__(self) -> Iterator[str]:
        """The names of the columns."""
        return iter(self.columns)

    def of(self, participant: str) -> Result:
        """The run of one model, with powers, energies, work and audit; its inputs as they were held.

        Raises `SignalError` for a participant that there is not, and for a unit, of which only the columns
        are known.
        """
        if participant in self.results:
            return self.results[participant]
        if participant in self.participants:
            raise SignalError(
                f"{participant!r} is a unit, of which nothing but its variables is known: ask for them as "
                f"{[name for name in self.columns if name.startswith(participant + '.')][:1]}"
            )
        raise SignalError(
            f"there is no participant {participant!r}{nearest(participant, self.participants)}; there are "
            f"{', '.join(self.participants)}"
        )

    def created(self, one: str, other: str) -> Array:
        """Energy [J] that the coupling has made up to each sample, at two inputs whose product is power.

        ``one`` and ``other`` are inputs of two participants, each fed by the other's: an effort one way, a
        flow the other, counted so that their product is power into the participant of ``one``, out of that
        of ``other``. Each works with the other's signal as it was held, so one does not get quite what the
        other gives: this is the difference. It falls with the interval.

        Raises `SignalError` for inputs that are not connected so, for those of units, of which no integrals
        are known, and for inputs along lines, which are not held.
        """
        ends = [end_of(name, self.participants, "created") for name in (one, other)]
        sources = []
        for name in (one, other):
            if name not in self.connections:
                raise SignalError(
                    f"created: {name!r} is no connected input{nearest(name, self.connections)}"
                )
            sources.append(end_of(self.connections[name], self.participants, "created"))
        if (sources[0].part, sources[1].part) != (ends[1].part, ends[0].part):
            raise SignalError(
                f"created: {one!r} comes from {str(sources[0])!r} and {other!r} from {str(sources[1])!r}; "
                "a power connection has two inputs of two participants, each from the other's"
            )
        for name in (one, other):
            if name in self.lines:
                raise SignalError(
                    f"created: {name!r} goes along lines; energy is told of held inputs"
                )
        gets, gives = (
            _held_work(self.of(end.part), end.signal, source.signal)
            for end, source in zip(ends, reversed(sources), strict=True)
        )
        return read_only(gets - gives)

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` of every column over "time" [s]; `MissingExtraError` without xarray."""
        attributes = {name: {"units": unit} for name, unit in self.units.items()}
        return dataset(self.time, self.columns, attributes, self.events)

    def plot(self, *names: str | Sequence[str], title: str = "") -> Any:
        """A `matplotlib.figure.Figure` of signals, with events marked; of those that are exchanged if none
        are named, each participant's in a panel.

        Names share one panel; with a list among them each name or list has its own, as of `panels`.

        Raises `SignalError` for unknown names, `MissingExtraError` without matplotlib.
        """
        groups = grouped(names, ()) if names else self._exchanged()
        return stacked([panel_of(self, group) for group in groups], marks_of(self), title)

    def _exchanged(self) -> list[list[str]]:
        """The signals that connections come from by participants; every signal where there are none."""
        told = dict.fromkeys(self.connections.values()) or self.columns
        parts = [[name for name in told if name.startswith(f"{one}.")] for one in self.participants]
        return [names for names in parts if names]

    def __str__(self) -> str:
        first, last = float(self.time[0]), float(self.time[-1])
        return (
            f"co-simulation of {', '.join(self.participants)} from {first:.6g} s to {last:.6g} s: "
            f"{len(self.time) - 1} intervals, {len(self.columns)} signals, {len(self.events)} events"
        )


def _held_work(result: Result, held: str, signal: str) -> Array:
    """The integral of an input, held between samples, times a signal."""
    steps = np.diff(result.integral(signal))
    return np.concatenate([[0.0], np.cumsum(result[held][:-1] * steps)])

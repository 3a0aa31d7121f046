"""Samples and events of a run into the files that grow with it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.record.beyond import refuse_all_beyond
from codegen.record.columns import named_columns, table_names, with_switches
from codegen.record.observer import Observer
from codegen.record.resting import Resting
from codegen.record.snapshots import Snapshots
from codegen.runs.track import Event
from codegen.streaming.files import Growing, event_columns


@dataclass(frozen=True)
class Block:
    """Some samples of a run, by the names of its signals."""

    time: Array
    columns: Mapping[str, Array]
    observer: Observer

    def __getitem__(self, name: str) -> Array:
        """The values of one signal; `KeyError` naming what there is."""
        return self.columns[name] if name in self.columns else self.observer.signal(name)


class Writing:
    """A `Sink` that writes what it gets: these signals in ``samples``, events where they are kept."""

    def __init__(
        self, model: ClosedModel, times: Array, signals: Sequence[str], samples: Growing,
        events: Growing | None,
    ) -> None:  # fmt: skip
        self._model, self._times, self._signals = model, times, signals
        self._table = table_names(model.program)
        self._files = samples, events
        #: How many samples and events there are so far.
        self.samples = self.events = 0
        #: What was told at the latest sample.
        self.final: Mapping[str, float] = {}
        self.resting = Resting(model)

    def begin(self) -> None:
        """See `Sink`."""
        self.samples = self.events = 0
        self.resting = Resting(self._model)
        for file in self._files:
            if file is not None:
                file.begin()

    def take(self, shots: Snapshots, modes: Sequence[Mode]) -> None:
        """See `Sink`."""
        times = self._times[self.samples : self.samples + len(modes)]
        columns, observer = named_columns(self._model, times, shots)
        block = Block(times, with_switches(columns, self._model.program, modes), observer)
        refuse_all_beyond(self._model, block)
        self.resting.see(block)
        written = {name: block[name] for name in self._signals}
        self._files[0].add([times, *written.values()])
        self.samples += len(modes)
        told = {name: block[name] for name in self._table} | written
        self.final = {name: float(values[-1]) for name, values in told.items()}

    def happened(self, events: Sequence[Event]) -> None:
        """See `Sink`."""
        if events and self._files[1] is not None:
            self._files[1].add(event_columns(events))
            self.events += len(events)

    def end(self) -> None:
        """Write what is left; nothing of a run that ended before its first samples."""
        for file in self._files:
            if file is not None and self.samples:
                file.end()
            elif file is not None:
                file.clear()

"""What a run records, block by block: vectors as everything at their samples, to be kept or passed on."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Protocol

import numpy as np

from codegen.inputs.signal import Signal
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.record.snapshots import Snapshots, snapshots
from codegen.runs.track import Event, Track


class Sink(Protocol):
    """Who gets everything at a run's samples, a block at a time, and its events as they come."""

    def begin(self) -> None:
        """A run begins, perhaps once more: what was taken before is none of it."""

    def take(self, shots: Snapshots, modes: Sequence[Mode]) -> None:
        """Everything at the next samples."""

    def happened(self, events: Sequence[Event]) -> None:
        """The next events."""


class Blocks:
    """A `Taker` of vectors that works out everything else at their samples."""

    def __init__(
        self, model: ClosedModel, times: Array, signals: Sequence[Signal], sink: Sink
    ) -> None:
        self._times, self._signals, self._sink = times, signals, sink
        self._track = Track(np.zeros((0, model.size)), [], np.zeros(model.size))
        self._model, self._taken = model.within(self._track), 0

    def begin(self) -> None:
        """See `Taker`."""
        self._taken = 0
        self._sink.begin()

    def take(self, vectors: Array, modes: Sequence[Mode], largest: Array) -> None:
        """See `Taker`."""
        first, self._taken = self._taken, self._taken + len(vectors)
        track, times = self._track, self._times[first : self._taken]
        track.vectors, track.modes, track.largest = vectors, [*modes], largest
        if len(times):
            self._sink.take(snapshots(self._model, times, self._signals, track), modes)

    def happened(self, events: Sequence[Event]) -> None:
        """See `Taker`."""
        self._sink.happened(events)


class Whole:
    """A `Sink` that keeps all of a run of so many samples."""

    def __init__(self, samples: int) -> None:
        self._samples = samples
        self.begin()

    def begin(self) -> None:
        """See `Sink`."""
        self._tables: dict[str, Array] = {}
        self.modes: list[Mode] = []
        self.events: list[Event] = []

    def take(self, shots: Snapshots, modes: Sequence[Mode]) -> None:
        """See `Sink`."""
        first, last = len(self.modes), len(self.modes) + len(modes)
        for name, table in vars(shots).items():
            if len(modes) == self._samples:
                self._tables[name] = table
                continue
            if first == 0:
                self._tables[name] = np.empty((self._samples, table.shape[1]))
            self._tables[name][first:last] = table
        self.modes += modes

    def happened(self, events: Sequence[Event]) -> None:
        """See `Sink`."""
        self.events += events

    @property
    def shots(self) -> Snapshots:
        """Everything at all samples."""
        return Snapshots(*(self._tables[field.name] for field in fields(Snapshots)))

"""The named signals of one instant, each worked out as it is asked for."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import accumulate
from typing import NamedTuple, Protocol

import numpy as np

from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import RECORDED, recorded
from codegen.record.beyond import refuse_beyond, turned_storages
from codegen.record.columns import column_places, named_columns, with_switches
from codegen.record.observer import Observer
from codegen.record.snapshots import Snapshots


class Row(Protocol):
    """Everything at an instant."""

    @property
    def time(self) -> float:
        """The instant [s]."""

    @property
    def values(self) -> Sequence[float]:
        """The recorded parts, one after the other."""

    @property
    def mode(self) -> Mode:
        """The mode of each port."""


class PlainRow(NamedTuple):
    """One that is worked out."""

    time: float
    values: Sequence[float]
    mode: Mode


class Plan:
    """Where the named signals of a model stand in a row, and how modes tell switches."""

    def __init__(self, model: ClosedModel) -> None:
        self.model = model
        self.widths = recorded(model.program)
        firsts = [0, *accumulate(self.widths)]
        self._cuts = firsts[1:-1]
        first = dict(zip(RECORDED, firsts, strict=False))
        columns = column_places(model.program)
        self.places = {name: first[part] + at for name, (part, at) in columns.items()}
        self.switches = {
            str(port.name): (at, {sign: float(port.switch.is_on(sign)) for sign in (-1, 0, 1)})
            for at, port in enumerate(model.program.friction)
            if port.switch is not None and not port.slides and port.transition is None
        }
        inner = model.program.inner
        self.names = tuple(name for name in (*self.places, *self.switches) if name not in inner)
        self.turned = turned_storages(model)

    def check(self, row: Row) -> None:
        """Refuse an instant, as a run does its samples, where a signal is not finite."""
        if not self.turned and math.isfinite(sum(row.values)):
            return
        columns, observer = self.columns([row])
        for element in self.turned:
            name = str(element.co_energy)
            values = columns[name] if name in columns else observer.signal(name)
            refuse_beyond(self.model, element, np.array([row.time]), values)

    def columns(self, rows: Sequence[Row]) -> tuple[Mapping[str, Array], Observer]:
        """Instants as the columns of a run of so many samples; refuses what is not finite."""
        parts = np.split(np.array([row.values for row in rows], dtype=float), self._cuts, axis=1)
        times = np.array([row.time for row in rows])
        columns, observer = named_columns(self.model, times, Snapshots(*parts))
        return with_switches(columns, self.model.program, [row.mode for row in rows]), observer


class Signals(Mapping[str, float]):
    """Every named signal of an instant, by name; names beside those of columns can be asked for, too."""

    __slots__ = ("__dict__", "_plan", "row")

    def __init__(self, plan: Plan, row: Row) -> None:
        self._plan, self.row = plan, row

    def __getitem__(self, name: str) -> float:
        """One signal; `KeyError` naming what there is."""
        at = self._plan.places.get(name)
        if at is not None:
            return float(self.row.values[at])
        if name in self._plan.switches:
            port, told = self._plan.switches[name]
            return told[self.row.mode[port]]
        return float(self._observer.signal(name)[0])

    def __iter__(self) -> Iterator[str]:
        """The names of a run's columns."""
        return iter(self._plan.names)

    def __len__(self) -> int:
        return len(self._plan.names)

    @cached_property
    def _observer(self) -> Observer:
        return self._plan.columns([self.row])[1]

    def __repr__(self) -> str:
        return repr(dict(self))

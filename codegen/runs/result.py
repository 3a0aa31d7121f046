"""`Result`: the record of a run, and every effort, flow, power and energy in it."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Protocol

import numpy as np

from codegen.arrays import Array
from codegen.runs.events import Event


class Watcher(Protocol):
    """What works out a run's signals, bonds, powers and energies."""

    def signal(self, name: str) -> Array:
        """A named effort or flow."""

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond."""

    def power(self, node: Hashable) -> Array:
        """Effort times flow of a one-port."""

    def energy(self, node: Hashable) -> Array:
        """What a storage holds."""


@dataclass(frozen=True)
class Result:
    """The record of a run: ``result["omega_1"]`` is any named signal of the graph over ``result.time``.

    ``events``: what happened at friction ports and switches, in order. At a step or an event a sample
    shows the instant just after. ``columns``: the signals that a table of the run holds: states, inputs,
    outputs and what laws read.
    """

    time: Array = field(repr=False)
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    events: tuple[Event, ...]
    columns: Mapping[str, Array] = field(repr=False)
    observer: Watcher = field(repr=False, compare=False)

    def __getitem__(self, name: str) -> Array:
        """The values of one signal; `KeyError` naming what there is."""
        if name in self.columns:
            return self.columns[name]
        return self.observer.signal(name)

    def __iter__(self) -> Iterator[str]:
        """The names of the columns."""
        return iter(self.columns)

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond, as declared; see `StateEquations.bond`."""
        return self.observer.bond(tail, head)

    def power(self, node: Hashable) -> Array:
        """Power that an I, C or R absorbs, or that a source supplies."""
        return self.observer.power(node)

    def energy(self, node: Hashable) -> Array:
        """Energy stored in an I or C, 0 where its state is 0."""
        return self.observer.energy(node)

    def work(self, node: Hashable) -> Array:
        """Power integrated over the samples by trapezoids, 0 at the first; no impulses are in it."""
        power = self.power(node)
        steps = np.diff(self.time) * (power[1:] + power[:-1]) / 2
        return np.concatenate([[0.0], np.cumsum(steps)])

    def write_csv(self, path: str | PathLike[str]) -> None:
        """Write time and every column as comma-separated columns with one line of names."""
        table = np.column_stack([self.time, *self.columns.values()])
        header = ",".join(["t", *self.columns])
        np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.17g")

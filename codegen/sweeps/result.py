"""`Sweep`: what the runs gave, as columns, as a table or as an xarray data set."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bondgraph.errors import MissingExtraError
from bondgraph.show.blocks import aligned
from bondgraph.show.html import html_lines, html_table
from codegen.numbers.arrays import Array
from codegen.sweeps.chunks import NOTHING, Outcome
from codegen.sweeps.columns import Columns
from codegen.sweeps.design import Table
from codegen.sweeps.views import sweep_rows

Shapes = tuple[tuple[int, ...], ...]


class Failure(NamedTuple):
    """A run that gave nothing: its index, its numbers by name and why."""

    run: int
    values: Mapping[str, float]
    message: str


@dataclass(frozen=True, eq=False)
class Sweep:
    """The measures of all runs: ``sweep["name"]`` has a row for each run, NaN where there is none.

    Its arrays are read-only. ``design``: the runs' numbers. ``failed``: runs that gave nothing, in the
    order of their indices.
    ``done``: which runs were done, failed ones included; all of them, unless the sweep was interrupted.
    ``completed``: of runs by their index the states that ``initial`` does not name and that followed what
    switches held at the start, see `Result`.
    """

    design: Table
    time: Array = field(repr=False)
    measures: Mapping[str, Array] = field(repr=False)
    failed: tuple[Failure, ...]
    done: NDArray[np.bool_] = field(repr=False)
    over_time: frozenset[str] = field(repr=False, default=frozenset())
    completed: Mapping[int, Mapping[str, float]] = field(
        repr=False, default_factory=lambda: NOTHING
    )

    def __len__(self) -> int:
        return len(self.design)

    def __getitem__(self, name: str) -> Array:
        """A measure, or the numbers of one name, for each run; `KeyError` naming what there is."""
        if name in self.measures:
            return self.measures[name]
        if name in self.design.names:
            return self.design.column(name)
        known = ", ".join((*self.design.names, *self.measures))
        raise KeyError(f"no column {name!r}; there are {known}")

    def _ipython_key_completions_(self) -> list[str]:
        return [*self.design.names, *self.measures]

    def __str__(self) -> str:
        """How many runs, and of every column the least, the mean and the most."""
        head, rows = sweep_rows(self.table(), len(self), int(self.done.sum()), len(self.failed))
        return "\n".join([head, *aligned(rows)])

    def _repr_html_(self) -> str:
        head, rows = sweep_rows(self.table(), len(self), int(self.done.sum()), len(self.failed))
        return html_lines([head]) + html_table(rows[0], rows[1:])

    @property
    def complete(self) -> bool:
        """Whether every run was done."""
        return bool(self.done.all())

    def table(self) -> dict[str, Array]:
        """The numbers of each run and what it gave, as columns by name."""
        return {name: self[name] for name in (*self.design.names, *self.measures)}

    def to_xarray(self) -> Any:
        """An `xarray.Dataset`: a grid with an axis for each name, other sweeps along "run".

        Raises `MissingExtraError` without xarray.
        """
        try:
            import xarray
        except ImportError:
            raise MissingExtraError(
                "data sets need xarray; install the optional extra: "
                "pip install bondgraph-toolkit[sweep]"
            ) from None
        design, shape = self.design, self.design.shape
        axes = ("run",) if shape is None else design.names
        lengths = (len(self),) if shape is None else shape
        coordinates: dict[str, Any] = {name: (axes, design.axis(name)) for name in design.names}
        if shape is None:
            coordinates["run"] = np.arange(len(self))
        else:
            coordinates = {name: design.axis(name) for name in design.names}
        if self.over_time:
            coordinates["time"] = self.time
        data = {}
        for name, values in self.measures.items():
            inner = [f"{name}_{at}" for at in range(values.ndim - 1)]
            inner = ["time"] if name in self.over_time else inner
            data[name] = ((*axes, *inner), values.reshape(*lengths, *values.shape[1:]))
        return xarray.Dataset(data, coordinates)


class SweepInterrupted(KeyboardInterrupt):
    """A sweep that was interrupted; ``sweep`` has what is done."""

    def __init__(self, sweep: Sweep) -> None:
        super().__init__(f"{int(sweep.done.sum())} of {len(sweep)} runs are done")
        self.sweep = sweep


class Collected:
    """What comes in, in whatever order; each run counts once.

    All runs must give measures of the shapes that the first run by index gives; others fail in the end.
    """

    def __init__(self, runs: int, measures: Sequence[str]) -> None:
        self.done = np.zeros(runs, dtype=bool)
        #: Why numpy ran what C was asked to, and how often.
        self.fallen: Counter[str] = Counter()
        self._completed: dict[int, Mapping[str, float]] = {}
        self._measures = tuple(measures)
        self._messages: dict[int, str] = {}
        self._shapes: Shapes | None = None
        self._arrays: list[Array] = []
        #: Runs of other shapes than the first that came in.
        self._others: dict[int, tuple[Array, ...]] = {}

    def add(self, outcome: Outcome) -> int:
        """Take what is new; how many runs that is."""
        self.fallen.update(outcome.fallen)
        self._completed |= outcome.completed
        if isinstance(outcome.results, Columns) and self._alike(outcome.results):
            return self._add_columns(np.asarray(outcome.indices), outcome.results)
        new = 0
        for index, result in zip(map(int, outcome.indices), outcome.results, strict=True):
            if self.done[index]:
                continue
            self.done[index] = True
            new += 1
            if isinstance(result, str):
                self._messages[index] = result
            else:
                self._put(index, result)
        return new

    def _alike(self, results: Columns) -> bool:
        """Whether columns have the shapes of what came in before."""
        shapes = tuple(column.shape[1:] for column in results.columns)
        if self._shapes is None and results.plain.any():
            self._allot(shapes)
        return shapes == self._shapes

    def _add_columns(self, indices: NDArray[np.intp], results: Columns) -> int:
        new = ~self.done[indices]
        taken = new & results.plain
        for array, column in zip(self._arrays, results.columns, strict=True):
            array[indices[taken]] = column[taken]
        self.done[indices[taken]] = True
        others = [at for at in results.others if new[at]]
        found = tuple(results[at] for at in others)
        return int(taken.sum()) + self.add(Outcome(indices[others].tolist(), found, 0.0))

    def _put(self, index: int, result: tuple[Array, ...]) -> None:
        shapes = tuple(part.shape for part in result)
        if self._shapes is None:
            self._allot(shapes)
        if shapes != self._shapes:
            self._others[index] = result
            return
        for array, part in zip(self._arrays, result, strict=True):
            array[index] = part

    def _allot(self, shapes: Shapes) -> None:
        self._shapes = shapes
        self._arrays = [np.full((len(self.done), *shape), np.nan) for shape in shapes]

    def sweep(self, design: Table, time: Array, over_time: frozenset[str]) -> Sweep:
        """The record of what came in so far."""
        messages = self._messages | self._misshapen()
        failed = tuple(
            Failure(
                index,
                MappingProxyType(dict(zip(design.names, design.row(index), strict=True))),
                messages[index],
            )
            for index in sorted(messages)
        )
        arrays = self._arrays or [np.full(len(self.done), np.nan) for _ in self._measures]
        for array in arrays:
            array.flags.writeable = False
        measures = MappingProxyType(dict(zip(self._measures, arrays, strict=True)))
        done = self.done.copy()
        done.flags.writeable = False
        completed = {
            index: MappingProxyType(dict(self._completed[index]))
            for index in sorted(self._completed)
        }
        return Sweep(design, time, measures, failed, done, over_time, MappingProxyType(completed))

    def _misshapen(self) -> dict[int, str]:
        """Why runs whose measures have other shapes than the first run's are left out."""
        if not self._others or self._shapes is None:
            return {}
        plain = self.done.copy()
        plain[[*self._messages, *self._others]] = False
        first = min(self._others)
        if first < int(np.argmax(plain)):
            self._swap(plain, first)
        expected = self._shapes
        return {
            index: f"the measures have the shapes {_shapes(result)}, in the first run {expected}"
            for index, result in self._others.items()
        }

    def _swap(self, plain: NDArray[np.bool_], first: int) -> None:
        """Let the shapes of the first run by index rule."""
        others, arrays = self._others, self._arrays
        self._others = {
            int(index): tuple(array[index] for array in arrays) for index in np.flatnonzero(plain)
        }
        self._allot(_shapes(others[first]))
        for index, result in others.items():
            self._put(index, result)


def _shapes(result: tuple[Array, ...]) -> Shapes:
    return tuple(part.shape for part in result)

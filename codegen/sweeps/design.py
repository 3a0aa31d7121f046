"""Which numbers each run of a sweep has: a grid, a table, or samples."""

import hashlib
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bondgraph.algebra.atoms import normal
from bondgraph.errors import SignalError
from codegen.numbers.arrays import Array, real_array

Draw = Callable[[np.random.Generator], float]
"""Draws one number from a random generator."""


class Table:
    """A run for each row: columns of equal length, or a list of rows.

    Raises `SignalError` for columns of several lengths, or what is no list of numbers.

    >>> table = Table(m=[1, 2, 3], k=[10, 10, 40])
    >>> len(table), table.names, table.row(2)
    (3, ('m', 'k'), (3.0, 40.0))
    >>> Table([{"m": 1, "k": 10}, {"k": 10, "m": 2}]).row(1)
    (2.0, 10.0)
    """

    names: tuple[str, ...]
    #: The lengths of a grid's axes; None for other designs.
    shape: tuple[int, ...] | None = None

    def __init__(
        self, rows: Sequence[Mapping[str, float]] | None = None, /, **columns: ArrayLike
    ) -> None:
        if rows is not None:
            columns = _columns_of(rows, columns)
        self._columns = _numbers(columns.items())
        self.names = tuple(self._columns)
        lengths = {name: len(column) for name, column in self._columns.items()}
        if len(set(lengths.values())) != 1:
            raise SignalError(f"the columns of a table must have one length, not {lengths}")
        self._length = next(iter(lengths.values()))

    def __len__(self) -> int:
        return self._length

    def row(self, index: int) -> tuple[float, ...]:
        """The numbers of one run, in the order of ``names``."""
        return tuple(float(column[index]) for column in self._columns.values())

    def rows(self, indices: NDArray[np.intp]) -> Array:
        """The numbers of some runs, a row for each."""
        return np.column_stack([column[indices] for column in self._columns.values()])

    def column(self, name: str) -> Array:
        """The numbers of one name, one for each run."""
        return self._columns[name]

    def axis(self, name: str) -> Array:
        """The numbers that a name takes."""
        return self._columns[name]

    def fingerprint(self) -> str:
        """A digest of the names and the numbers."""
        digest = hashlib.sha256(repr((self.shape, self.names)).encode())
        for name in self.names:
            digest.update(np.ascontiguousarray(self.axis(name)).tobytes())
        return digest.hexdigest()


class Grid(Table):
    """A run for each combination; the last name changes fastest.

    Raises `SignalError` for what is no list of numbers, a name without values, or one that comes twice.

    >>> grid = Grid(m=[1, 2], k=[10, 20, 30])
    >>> len(grid), grid.row(1), grid.row(3)
    (6, (1.0, 20.0), (2.0, 10.0))
    """

    def __init__(self, axes: Mapping[str, ArrayLike] | None = None, /, **more: ArrayLike) -> None:
        if not isinstance(axes, Mapping | None):
            raise SignalError(f"a grid's axes must map names to lists of numbers, not be {axes!r}")
        self._columns = _numbers([*(axes or {}).items(), *more.items()])
        self.names = tuple(self._columns)
        self.shape = tuple(len(axis) for axis in self._columns.values())
        self._length = math.prod(self.shape)

    def row(self, index: int) -> tuple[float, ...]:
        """The numbers of one run, in the order of ``names``."""
        places = np.unravel_index(index, self.shape or (1,))
        return tuple(
            float(axis[at]) for axis, at in zip(self._columns.values(), places, strict=False)
        )

    def rows(self, indices: NDArray[np.intp]) -> Array:
        """The numbers of some runs, a row for each."""
        places = np.unravel_index(indices, self.shape or (1,))
        axes = zip(self._columns.values(), places, strict=False)
        return np.column_stack([axis[at] for axis, at in axes])

    def column(self, name: str) -> Array:
        """The numbers of one name, one for each run."""
        places = np.unravel_index(np.arange(len(self)), self.shape or (1,))
        return self._columns[name][places[self.names.index(name)]]


class Samples(Table):
    """Random runs: uniform between two limits, or by a function of a `numpy.random.Generator`.

    Every name has random numbers of its own: they change neither with other names nor, as far as they
    go, with the number of runs.

    Raises `SignalError` for what is neither two finite limits, the lower first, nor a function, and for
    a number of runs or a seed that is no whole number.

    >>> draws = Samples(100, seed=1, m=(1, 2), k=lambda generator: generator.normal(40, 2))
    >>> draws.row(0) == Samples(1, seed=1, k=lambda generator: generator.normal(40, 2), m=(1, 2)).row(0)[::-1]
    True
    """

    def __init__(
        self, runs: int, /, seed: int, **draws: tuple[float, float] | Draw | list[float]
    ) -> None:
        _check_whole(runs, "runs", 1)
        _check_whole(seed, "seed", 0)
        columns: dict[str, ArrayLike] = {}
        for name, draw in draws.items():
            generator = np.random.default_rng([seed, *str(normal(name)).encode()])
            if callable(draw):
                columns[name] = [draw(generator) for _ in range(runs)]
                continue
            columns[name] = generator.uniform(*_limits(name, draw), runs)
        super().__init__(**columns)


def design(parameters: object) -> Table:
    """A `Table` as it is, a mapping as a `Grid`, a list of mappings as a `Table`."""
    if isinstance(parameters, Mapping):
        parameters = Grid(parameters)
    elif isinstance(parameters, list | tuple):
        parameters = Table(parameters)
    if not isinstance(parameters, Table):
        raise SignalError(
            f"parameters must be a Grid, a Table, Samples, a mapping or a list of rows, not {parameters!r}"
        )
    return parameters


def _columns_of(
    rows: Sequence[Mapping[str, float]], columns: Mapping[str, ArrayLike]
) -> dict[str, ArrayLike]:
    if columns:
        raise SignalError("a table takes rows or columns, not both")
    listed = isinstance(rows, list | tuple) and all(isinstance(row, Mapping) for row in rows)
    if not listed or not rows:
        raise SignalError("a table's rows must be one or more mappings of names to numbers")
    for at, row in enumerate(rows):
        if row.keys() != rows[0].keys():
            raise SignalError(f"row {at} has the names {[*row]}, row 0 {[*rows[0]]}")
    return {name: [row[name] for row in rows] for name in rows[0]}


def _check_whole(count: object, what: str, least: int) -> None:
    whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
    if not whole or count < least:  # type: ignore[operator]
        raise SignalError(f"samples: {what} must be a whole number from {least} on, not {count!r}")


def _limits(name: str, draw: object) -> tuple[float, float]:
    """Two finite numbers, the lower first."""
    try:
        found = real_array(draw).tolist()  # type: ignore[arg-type]
    except (TypeError, ValueError):
        found = []
    if not isinstance(found, list) or len(found) != 2 or not np.isfinite(found).all():
        raise SignalError(f"samples of {name} need two limits or a function, not {draw!r}")
    if found[0] > found[1]:
        raise SignalError(f"samples of {name}: the lower limit comes first, not {draw!r}")
    return found[0], found[1]


def _numbers(columns: Iterable[tuple[str, ArrayLike]]) -> dict[str, Array]:
    result: dict[str, Array] = {}
    for given, values in columns:
        name = str(normal(given))
        if name in result:
            raise SignalError(f"{name} comes twice in the sweep's numbers; name it once")
        try:
            column = real_array(values)
        except (TypeError, ValueError) as error:
            raise SignalError(f"the values of {name} must be numbers: {error}") from None
        if column.ndim != 1:
            raise SignalError(f"the values of {name} must be a list, not of shape {column.shape}")
        if not len(column):
            raise SignalError(f"{name} has no values: give one number or more")
        column.flags.writeable = False
        result[name] = column
    return result

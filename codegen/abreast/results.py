"""What runs side by side have recorded, as records of single runs: worked out as far as it is asked for."""

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bondgraph.nodes.tasks import Transition
from codegen.abreast.fleet import Fleet
from codegen.abreast.modes import ModesAbreast
from codegen.energy.audit import Audit
from codegen.numbers.arrays import Array, read_only
from codegen.program.layout import EXTERNAL
from codegen.program.records import Program
from codegen.record.result import Result


@dataclass(frozen=True)
class Shared:
    """What the columns of all runs are made of: inputs, and their rates, by samples, each 1 in its size.

    ``sizes``: of the inputs, a row for each run. ``names``: of the columns, with part and place of each.
    """

    fleet: Fleet
    modes: ModesAbreast
    inputs: Array
    rates: Array
    sizes: Array
    names: Mapping[str, tuple[int, int]]


class RunColumns(Mapping[str, Array]):
    """The columns of one run; each is worked out when it is asked for.

    ``inner``: those of parts of nodes of signals, instead of all others.
    """

    def __init__(self, shared: Shared, run: int, inner: bool = False) -> None:
        self._shared, self._run, self._known = shared, run, dict[str, Array]()
        own = shared.modes.model.program.inner
        self._names = {name: at for name, at in shared.names.items() if (name in own) == inner}

    def __getitem__(self, name: str) -> Array:
        if name not in self._known:
            self._known[name] = read_only(self._made(*self._names[name]))
        return self._known[name]

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def _made(self, part: int, at: int) -> Array:
        shared, run = self._shared, self._run
        if part == EXTERNAL:
            return np.asarray(shared.inputs[:, at] * shared.sizes[run, at])
        vectors, m = shared.fleet.vectors[run], shared.inputs.shape[1]
        n, found = vectors.shape[1], np.empty(len(vectors))
        for begin, end, mode in shared.fleet.stretches(run):
            made = shared.modes.of(mode)
            assert made is not None
            row = made.maps.rows(part)[run, at]
            value = vectors[begin:end] @ row[:n] + row[-1]
            for tables, where in ((shared.inputs, n), (shared.rates, n + m)):
                if (used := row[where : where + m]).any():
                    value += tables[begin:end] @ used
            found[begin:end] = value
        return found


class Again:
    """What is not recorded: the run by itself has it, and is done when that is asked for."""

    def __init__(self, alone: Callable[[], Result], program: Program) -> None:
        self._alone, self._program = alone, program

    @cached_property
    def _result(self) -> Result:
        return self._alone()

    def names(self) -> Sequence[str]:
        """Of the signals that the run by itself has."""
        return self._result.observer.names()

    def nodes(self) -> Sequence[Hashable]:
        """Those of the graph."""
        return self._program.nodes

    def transitions(self) -> tuple[Transition, ...]:
        """Those of its state machines."""
        return self._program.transitions

    def signal(self, name: str) -> Array:
        """See `Result`; so the others."""
        return self._result.observer.signal(name)

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond."""
        return self._result.bond(tail, head)

    def power(self, node: Hashable) -> Array:
        """Effort times flow of a one-port."""
        return self._result.power(node)

    def energy(self, node: Hashable) -> Array:
        """What a storage holds."""
        return self._result.energy(node)

    def work(self, node: Hashable) -> Array:
        """What a one-port absorbs, or a source supplies, up to each sample."""
        return self._result.work(node)

    def integral(self, name: str) -> Array:
        """A signal integrated up to each sample."""
        return self._result.integral(name)

    def audit(self) -> Audit:
        """The power balance of the run."""
        return self._result.audit()


def result_of(
    shared: Shared, run: int, times: Array, names: tuple[tuple[str, ...], ...],
    units: Mapping[str, str], events: bool, alone: Callable[[], Result],
) -> Result:  # fmt: skip
    """The record of one run; ``names``: of states, inputs, outputs; ``alone``: the same run by itself."""
    again, columns = Again(alone, shared.modes.model.program), RunColumns(shared, run)
    happened = tuple(shared.fleet.events[run]) if events else ()
    states, inputs, outputs = names
    return Result(
        times, states, inputs, outputs, happened, columns, again, again, units,
        inner=RunColumns(shared, run, inner=True),
    )  # fmt: skip

"""Runs of a family side by side: those with other numbers for the same model, of which nothing is doubtful."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from bondgraph.algebra.atoms import normal
from bondgraph.errors import BondGraphError
from codegen.abreast.course import Course
from codegen.abreast.fit import even, fits, sound, suits
from codegen.abreast.fleet import Fleet
from codegen.abreast.leading import Leader, Precedents
from codegen.abreast.modes import ModesAbreast
from codegen.abreast.results import Shared, names_of, result_of
from codegen.family import Family
from codegen.inputs.present import Inputs
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.inputs.swept import Swept
from codegen.numbers.arrays import Array
from codegen.program.layout import STATES
from codegen.program.units import told_units
from codegen.record.result import Result
from codegen.runs.arguments import initial_values, signals_for
from codegen.runs.impulses import refuse_impulses
from codegen.runs.methods import EXACT
from codegen.simulator import Simulator
from codegen.tuning import TUNING

FEWEST = 4
"""Fewer runs than these are as quick one by one."""


class Asked(NamedTuple):
    """What all runs share: a family, what each has numbers for, times [s], initial values, inputs, method.

    ``events``: whether they are kept.
    """

    family: Family
    names: tuple[str, ...]
    times: Array
    initial: Mapping[str, float]
    inputs: Mapping[str, Any]
    method: str
    events: bool


class Abreast:
    """Does runs side by side; made once for a sweep."""

    def __init__(self, asked: Asked) -> None:
        self._asked, program = asked, asked.family.program
        names = asked.names
        #: Each external input as all share it, and the column of its sizes.
        self._units, self._columns = _shared(asked)
        self._swept = frozenset(name for name in names if name in asked.family.parameters)
        self._models = dict[tuple[float, ...], Simulator]()
        #: The run that tells what is exact.
        self._first: Simulator | None = None
        self._precedents: Precedents = {}
        self._names = names_of(program)
        given = {str(normal(name)): value for name, value in asked.initial.items()}
        states = asked.family.states
        self._start = initial_values(given, states)
        self._started = [(states.index(n), at) for at, n in enumerate(names) if n in states]

    def together(self) -> int:
        """How many runs at once."""
        return max(FEWEST, TUNING.together_in_numpy // (len(self._asked.times) * self._asked.family.program.size))

    def results(
        self, rows: Array, alone: Callable[[Sequence[float]], Result]
    ) -> list[Result | None]:
        """The record of each run, None of those that have to be done by themselves.

        ``alone``: a run by itself, for what its record does not hold.
        """
        found: list[Result | None] = [None] * len(rows)
        if len(rows) < FEWEST:
            return found
        with np.errstate(all="ignore"):
            for begin in range(0, len(rows), self.together()):
                part = rows[begin : begin + self.together()]
                try:
                    found[begin : begin + len(part)] = self._part(part, alone)
                except BondGraphError:
                    # What refuses the run that tells what is exact may not be so of others.
                    continue
        return found

    def _part(
        self, rows: Array, alone: Callable[[Sequence[float]], Result]
    ) -> list[Result | None]:
        asked, runs = self._asked, len(rows)
        if self._first is None:
            self._first = self._simulator(rows[0])
            refuse_impulses(self._first.closed, self._signals(rows[0]), asked.times)
        first = self._first
        model, program = first.closed, first.closed.program
        if not suits(model):
            return [None] * runs
        numbers = {name.name: float(model.parameters[name.name]) for name in program.parameters}
        parameters: dict[str, Any] = dict(numbers)
        parameters |= {n: rows[:, at].copy() for at, n in enumerate(asked.names) if n in self._swept}
        sizes = np.ones((runs, len(program.external)))
        for input_at, column in self._columns.items():
            sizes[:, input_at] = rows[:, column]
        modes = ModesAbreast(model, parameters, sizes)
        fleet = self._fleet(rows, modes, model.size)
        fleet.alone |= ~sound(model.equations, {**model.parameters, **parameters}, self._swept, runs)
        fleet.alone |= ~(modes.finite & np.isfinite(rows).all(axis=1))
        fleet.alone |= ((modes.numbers.G != 0) != (modes.numbers.G[:1] != 0)).any(axis=(1, 2))

        def lead(run: int) -> Leader:
            ready = self._simulator(rows[run])
            inputs = Inputs(self._signals(rows[run]))
            return Leader(ready.closed, fleet.s[run].copy(), inputs.at(float(fleet.t[run])))

        Course(modes, fleet, self._units, asked.times, self._precedents, lead).run()
        self._models.clear()
        fleet.alone |= ~(np.abs(fleet.vectors).max(axis=(1, 2)) < TUNING.ordinary)
        return self._records(first, rows, modes, fleet, sizes, alone)

    def _records(
        self, first: Simulator, rows: Array, modes: ModesAbreast, fleet: Fleet, sizes: Array,
        alone: Callable[[Sequence[float]], Result],
    ) -> list[Result | None]:  # fmt: skip
        times = self._asked.times
        inputs = np.array([unit.sampled(times) for unit in self._units]).reshape(-1, len(times)).T
        rates = np.zeros_like(inputs)
        if first.closed.program.rated and len(self._units):
            rates = np.array([unit.sampled(times, rates=True) for unit in self._units]).T
        shared = Shared(fleet, modes, inputs, rates, sizes, self._names)
        about = {
            "states": first.states, "inputs": first.inputs, "outputs": first.outputs,
            "units": told_units(first.closed.equations),
        }  # fmt: skip
        return [
            None if fleet.alone[run] else result_of(
                shared, run, times, about, self._asked.events,
                lambda row=rows[run].tolist(): alone(row),
            )
            for run in range(len(rows))
        ]  # fmt: skip

    def _fleet(self, rows: Array, modes: ModesAbreast, size: int) -> Fleet:
        """The runs at their starts."""
        asked, runs = self._asked, len(rows)
        program, begin = asked.family.program, float(asked.times[0])
        states = np.tile(self._start, (runs, 1))
        for place, column in self._started:
            states[:, place] = rows[:, column]
        s = np.zeros((runs, size))
        s[:, : states.shape[1]] = states
        given = np.array([unit(begin) for unit in self._units])
        n, m = len(program.states), len(given)
        forwards = modes.of(tuple(1 for _ in program.friction))
        assert forwards is not None
        # What inputs that drive dependent storages add to states; their rates do not.
        s[:, :n] -= forwards.maps.rows(STATES)[:, :, size : size + m] @ given
        s[:, :n] -= forwards.maps.rows(STATES)[:, :, -1]
        both = np.zeros((runs, n + len(program.inputs)))
        vectors = np.zeros((runs, len(asked.times), size))
        return Fleet(np.full(runs, begin), s, both, np.zeros(runs), vectors)

    def _simulator(self, row: Array) -> Simulator:
        key = tuple(row.tolist())
        if key not in self._models:
            values = zip(self._asked.names, key, strict=True)
            changes = {name: value for name, value in values if name in self._swept}
            self._models[key] = self._asked.family.simulator(**changes)
        return self._models[key]

    def _signals(self, row: Array) -> list[Signal]:
        """The external inputs of one run."""
        return [
            float(row[self._columns[at]]) * unit if at in self._columns else unit
            for at, unit in enumerate(self._units)
        ]


def abreast(asked: Asked) -> Abreast | None:
    """What does these runs side by side; None where they have to be done one by one."""
    family, swept = asked.family, frozenset(asked.names) & frozenset(asked.family.parameters)
    ready = family.backend == "numpy" and asked.method in ("auto", EXACT) and even(asked.times)
    if not ready or not fits(family.program, family.equations, swept):
        return None
    try:
        return Abreast(asked)
    except BondGraphError:
        # Told by each run.
        return None


def _shared(asked: Asked) -> tuple[list[Signal], dict[int, int]]:
    """The external inputs as all runs share them; the columns of those that have a size of their own."""
    inputs = {str(normal(name)): value for name, value in asked.inputs.items()}
    columns = {name: at for at, name in enumerate(asked.names)}
    sized: dict[str, int] = {}
    for at, name in enumerate(asked.names):
        if name in asked.family.inputs:
            inputs[name], sized[name] = Constant(1.0), at
    for name, value in list(inputs.items()):
        if isinstance(value, Swept):
            inputs[name], sized[name] = value.signal, columns[value.name]
    signals = signals_for(inputs, asked.family.inputs)
    return signals, {asked.family.inputs.index(name): at for name, at in sized.items()}

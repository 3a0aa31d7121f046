"""A unit of somebody else's as a participant: what it is given is set, it steps, its outputs are got."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from bondgraph.errors import SignalError, UnitError, nearest
from codegen.cosimulation.described import UnitDescription
from codegen.cosimulation.fitting import by_kind, fitting
from codegen.cosimulation.library import Library
from codegen.cosimulation.part import Given
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array, read_only
from codegen.runs.track import Event


class UnitPart:
    """A unit, by its library. ``given``: signals of inputs that are not connected, told at each instant.

    The standard lets outputs be asked for after a step, and not again once inputs are set: what a unit
    shows at an instant is told by the inputs of the step before. At the start they are told by its own.
    """

    def __init__(
        self, name: str, about: UnitDescription, given: Mapping[str, Signal],
        initial: Mapping[str, float], shown: Iterable[str],
    ) -> None:  # fmt: skip
        self.name, self.about, self.open = name, about, dict(given)
        self.inputs = about.names("input")
        self.time, self.every = 0.0, 0.0
        self._initial = initial
        self._shown = tuple(dict.fromkeys([*about.names("output"), *shown]))
        self._now = dict[str, Given]()
        self._seen = dict[str, float]()
        self._starting, self._sloped = True, set[str]()
        self._kept: dict[str, list[float]] = {one: [] for one in (*self.inputs, *self._shown)}
        self._library: Library | None = None

    def connect(self, library: Library, every: float) -> None:
        """Take an instance; ``every``: how long steps are [s]."""
        self._library, self.every = library, every

    def fed(self, signal: str, first: bool) -> frozenset[str]:
        """See `Part`."""
        if not first:
            return frozenset()
        told = self.about.variables[signal].first
        return frozenset(self.inputs) if told is None else told & frozenset(self.inputs)

    def certain(self, first: bool) -> bool:
        """See `Part`: at the start a unit may tell more than there is."""
        return not first

    def begin(self, time: float) -> None:
        """See `Part`."""
        self.time, library = time, self.library
        if self.about.second:
            library.call("setupExperiment", None, time)
        self._set(self._starts())
        library.call("enterInitializationMode", *(() if self.about.second else (None, time)))
        self._now = {name: Given(value) for name, value in self._got(self.inputs).items()}
        self._apply({name: Given(signal(time)) for name, signal in self.open.items()})
        self._look()

    def give(self, given: Mapping[str, Given]) -> bool:
        """See `Part`."""
        changed = {name: one for name, one in given.items() if one != self._now[name]}
        if self._starting and changed:
            self._apply(changed)
            self._look()
        self._now.update(changed)
        return bool(changed)

    def ready(self) -> None:
        """See `Part`."""
        self.library.call("exitInitializationMode")
        self._starting = False
        self._look()

    def read(self, signal: str) -> float:
        """See `Part`."""
        return self._seen[signal]

    def keep(self) -> None:
        """See `Part`."""
        self._now.update({name: Given(signal(self.time)) for name, signal in self.open.items()})
        for name, values in self._kept.items():
            values.append(self._now[name].value if name in self._now else self._seen[name])

    def advance(self, stop: float) -> None:
        """See `Part`."""
        self._apply(self._now)
        # What takes equal steps alone gets the interval itself, not what rounding leaves between instants.
        step = stop - self.time if self.about.variable_steps else self.every
        told = self.library.call("doStep", self.time, step)
        if told is not None:
            _, ended, early, last = told
            if ended or (early and last < stop):
                raise UnitError(
                    f"participant {self.name!r}: at t = {last!r} s it "
                    f"{'ends the run' if ended else 'returns before the step is over'}{self.library.logged}"
                )
        self.time = stop
        self._look()

    @property
    def library(self) -> Library:
        """Its instance."""
        assert self._library is not None
        return self._library

    @property
    def columns(self) -> Mapping[str, Array]:
        """See `Part`."""
        return {name: read_only(np.array(values)) for name, values in self._kept.items()}

    @property
    def units(self) -> Mapping[str, str]:
        """See `Part`."""
        told = {name: self.about.variables[name].unit for name in self._kept}
        return {name: unit for name, unit in told.items() if unit}

    @property
    def events(self) -> tuple[Event, ...]:
        """See `Part`: what happens inside a unit is not told."""
        return ()

    def _starts(self) -> dict[str, float]:
        """What its variables start at, where it was told."""
        known = self.about.variables
        for name in self._initial:
            if name not in known or known[name].causality == "independent":
                raise SignalError(
                    f"initial of {self.name!r}: the unit has no variable {name!r} of one number"
                    f"{nearest(name, known)}"
                )
        return dict(self._initial)

    def _apply(self, given: Mapping[str, Given]) -> None:
        self._set({name: one.value for name, one in given.items()})
        self._now.update(given)
        self._sloped |= {name for name, one in given.items() if one.slope}
        lines = {name: one.slope for name, one in given.items() if name in self._sloped}
        if lines and not self._starting:
            places = [self.about.variables[name].reference for name in lines]
            slopes = [*lines.values()]
            self.library.call("setRealInputDerivatives", places, [1] * len(places), slopes)

    def _look(self) -> None:
        self._seen = self._got(self._shown)
        for name, value in self._seen.items():
            if not math.isfinite(value):
                raise UnitError(
                    f"participant {self.name!r}: at t = {self.time!r} s its {name!r} is {value}"
                    f"{self.library.logged}"
                )

    def _got(self, names: Iterable[str]) -> dict[str, float]:
        found = dict[str, float]()
        for kind, several in by_kind(self.about.variables[name] for name in names):
            values = self.library.call(f"get{kind}", [one.reference for one in several])
            found.update(
                {one.name: float(value) for one, value in zip(several, values, strict=True)}
            )
        return found

    def _set(self, values: Mapping[str, float]) -> None:
        for kind, several in by_kind(self.about.variables[name] for name in values):
            told = [fitting(one, values[one.name], self.name) for one in several]
            self.library.call(f"set{kind}", [one.reference for one in several], told)

"""Commands that come to rest at zero, where a switch that is on stays on: a trap of commands of 0 and 1."""

import math
import warnings
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from bondgraph.equations import StateEquations
from bondgraph.errors import ModelWarning
from codegen.inputs.signal import Signal
from codegen.model.commands import Command, commands
from codegen.model.exact_values import exact_parameters
from codegen.model.outside import outside
from codegen.numbers.arrays import Array

BEYOND = 1.0
"""So long [s] after the last breakpoint of signals a run is looked at whose end nobody tells."""

LOOKS = 101
"""Samples of such a run."""

REPEATS = 1000
"""So many breakpoints are looked at of what repeats."""


@dataclass(frozen=True)
class Rest:
    """A switch that is on while its command is zero from a time [s] on."""

    command: Command
    time: float

    def __str__(self) -> str:
        one = self.command
        return (
            f"switch {one.name!r} stays on while its command {one.on} rests at zero, from "
            f"t = {self.time:.9g} on: {self.way_out}"
        )

    @property
    def way_out(self) -> str:
        """When it turns off, and what is meant by most who meet with this."""
        one = self.command
        return (
            f"it turns off as {one.off} rises above zero. For a command of 0 and 1 write "
            f"on='{one.on} - 1/2'"
        )


def first_rest(one: Command, on: Array, values: Array, times: Array) -> Rest | None:
    """The first rest: two times one after the other at which the switch is on and its command zero."""
    [at] = _first(np.atleast_2d(on), np.atleast_2d(values))
    return Rest(one, float(times[at])) if at >= 0 else None


def first_rests(
    one: Command, sized: Mapping[str, tuple[Signal, Array | float]], times: Array, on: bool
) -> Array:
    """The time of the first rest in each of many runs, NaN where there is none, without a run.

    Nothing but its command changes such a switch over, so its way through a run is known from the signs
    at the times, at breakpoints and halfway between. ``sized``: what it reads, as signals times a factor
    for each run. ``on``: whether it is on at first.
    """
    own = [sized[name] for name in one.signals]
    grid = _grid(one, times, [signal for signal, _ in own])
    read = [np.atleast_2d(s.sampled(grid)) * np.reshape(by, (-1, 1)) for s, by in own]
    values = np.atleast_2d(np.asarray(one.value(grid, *read), dtype=float) + 0 * grid)
    at = _first(_ways(values, on), values)
    return np.where(at >= 0, grid[at], np.nan)


def rests(
    told: Sequence[Command], signals: Mapping[str, Signal], times: Array, on: Collection[Hashable]
) -> tuple[Rest, ...]:
    """The first rest of each command whose signals are all given; ``on``: the switches on at first."""
    found = []
    for one in told:
        if all(name in signals for name in one.signals):
            own = [signals[name] for name in one.signals]
            if _steps(one, own):
                time = _rest_of_steps(one, own, times, one.name in on)
            else:
                sized = {name: (signals[name], 1.0) for name in one.signals}
                [time] = first_rests(one, sized, times, one.name in on).tolist()
            found += [] if math.isnan(time) else [Rest(one, time)]
    return tuple(found)


def _rest_of_steps(one: Command, signals: Sequence[Signal], times: Array, on: bool) -> float:
    """The same of a command that steps, without arrays, which take longer than a short run."""
    begin, end = float(times[0]), float(times[-1])
    breaks = {b for signal in signals for b in _breaks(signal, begin, end)}
    for at in (begin, *sorted(breaks)):
        value = float(one.value(at, *(signal(at) for signal in signals)))
        if on and value == 0:
            return at
        on = value > 0 or (on and value == 0)
    return math.nan


def warn_of_rests(
    equations: StateEquations, parameters: Mapping[str, object], signals: Mapping[str, Signal],
    on: Collection[Hashable], times: Array | None = None,
) -> None:  # fmt: skip
    """One `ModelWarning` for each rest, at the user's line.

    ``times``: samples of the run; left out, from 0 to a little after the signals' last breakpoint.
    """
    told = commands(equations, exact_parameters(parameters))
    if not told:
        return
    if times is None:
        finite = [signal for signal in signals.values() if not signal.endless]
        ends = [b for signal in finite for b in signal.breakpoints]
        times = np.linspace(0.0, max([0.0, *ends]) + BEYOND, LOOKS)
    for rest in rests(told, signals, times, on):
        warnings.warn(str(rest), ModelWarning, stacklevel=outside())


def _steps(one: Command, signals: Sequence[Signal]) -> bool:
    """Whether a command is constant between breakpoints of what it reads."""
    if one.timed or any(signal.endless for signal in signals):
        return False
    return all(piece.level is not None for signal in signals for piece in signal.pieces)


def _breaks(signal: Signal, begin: float, end: float) -> list[float]:
    """The breakpoints between two times; of one that repeats the first of them."""
    every = signal.within(begin, end)
    return [b for b in (islice(every, REPEATS) if signal.endless else every) if b < end]


def _grid(one: Command, times: Array, signals: Sequence[Signal]) -> Array:
    """The times, breakpoints between them, and halfway between all of these; of steps only their ends."""
    if _steps(one, signals):
        times = times[[0, -1]]
    breaks = [b for signal in signals for b in _breaks(signal, float(times[0]), float(times[-1]))]
    points = np.unique([*times.tolist(), *breaks])
    return np.unique([*points.tolist(), *((points[:-1] + points[1:]) / 2).tolist()])


def _ways(values: Array, on: bool) -> Array:
    """Whether a switch is on at each point of each run, from the last sign of its command so far."""
    places = np.where(values != 0, np.arange(values.shape[1]), -1)
    latest = np.maximum.accumulate(places, axis=1)
    signs = np.take_along_axis(values, np.maximum(latest, 0), axis=1)
    return np.where(latest >= 0, signs > 0, on)


def _first(on: Array, values: Array) -> NDArray[np.intp]:
    """Where each run's first rest is, -1 for none."""
    idle = (on == 1) & (values == 0)
    both = idle[:, :-1] & idle[:, 1:]
    return np.where(both.any(axis=1), both.argmax(axis=1) if both.size else 0, -1)

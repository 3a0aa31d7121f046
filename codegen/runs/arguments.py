"""What a run is given: times, initial values, inputs and settings, checked and as arrays and signals."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.algebra.atoms import normal
from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError, StructureError, nearest
from codegen.inputs.signal import Signal
from codegen.inputs.signals import as_signal
from codegen.numbers.arrays import Array, is_finite, is_number, read_only, real_array
from codegen.program.records import Program
from codegen.runs.methods import CHOICES
from codegen.runs.track import Settings


def numbers_of(values: ArrayLike, what: str) -> Array:
    """A fresh array of floats; `SignalError` for what makes none."""
    try:
        return real_array(values)
    except (TypeError, ValueError) as error:
        raise SignalError(f"{what} must be numbers: {error}") from None


def checked_times(time: ArrayLike) -> Array:
    """The points in time of a run: two or more, finite, increasing; a read-only array of its own."""
    times = numbers_of(time, "time")
    if times.ndim != 1 or len(times) < 2:
        raise SignalError(f"time must be a list of two or more points, not of shape {times.shape}")
    if not np.isfinite(times).all():
        raise SignalError("time: a point is not finite")
    if not (times[1:] > times[:-1]).all():
        at = int(np.argmin(np.diff(times)))
        raise SignalError(f"time must increase; {times[at]:g} is followed by {times[at + 1]:g}")
    return read_only(times)


def initial_values(initial: Mapping[str, float], states: Sequence[str]) -> Array:
    """A value for each state, zero where none is given; `SignalError` for other names and no numbers."""
    given = named_numbers(initial, states)
    return np.array([given.get(name, 0.0) for name in states], dtype=float)


def named_numbers(initial: Mapping[str, float], states: Sequence[str]) -> dict[str, float]:
    """Initial values by their states' names, checked."""
    if not isinstance(initial, Mapping):
        if hasattr(initial, "states"):
            raise SignalError(
                "initial must map names to values, not be a whole run; where one ends is "
                "{name: run[name][-1] for name in run.states}"
            )
        raise SignalError(f"initial must map names to values, not be {initial!r}")
    result: dict[str, float] = {}
    for given, value in initial.items():
        name = str(normal(given))
        if name not in states:
            raise SignalError(
                f"{name!r} is not a state{nearest(name, states)}; there are {', '.join(states)}"
            )
        if not is_number(value):
            raise SignalError(f"initial {name}: {value!r} is not a number")
        if not is_finite(value):
            raise SignalError(f"initial {name}: {value!r} is not finite")
        result[name] = float(value)
    return result


def signals_for(
    inputs: Mapping[str, object], names: Sequence[str], whence: Callable[[str], str] | None = None
) -> list[Signal]:
    """A signal for each input in turn; `SignalError` for missing and unknown ones.

    ``whence``: what a message says after a missing name, of who reads it and what was meant.
    """
    if not isinstance(inputs, Mapping):
        raise SignalError(f"inputs must map names to values, not be {inputs!r}")
    inputs = {str(normal(name)): value for name, value in inputs.items()}
    for name in inputs:
        if name not in names:
            raise SignalError(
                f"unknown input {name!r}{nearest(name, names)}; the model's inputs are "
                f"{', '.join(names) or 'none'}"
            )
    missing = [name for name in names if name not in inputs]
    if missing:
        told = ", ".join(name + ("" if whence is None else whence(name)) for name in missing)
        raise SignalError(
            f"missing input(s) {told}: give each a signal or a number in inputs, "
            "a law in laws, or, if it is a parameter, a number in parameters"
        )
    return [as_signal(inputs[name], name) for name in names]


def settings_of(method: str, rtol: float, atol: float) -> Settings:
    """How to integrate, checked."""
    for tolerance, what in ((rtol, "rtol"), (atol, "atol")):
        if not is_number(tolerance) or not 0 < tolerance < np.inf:
            raise SignalError(f"{what} must be a positive number, not {tolerance!r}")
    if method not in CHOICES:
        raise SignalError(f"unknown method {method!r}; there are {', '.join(CHOICES)}")
    return Settings(method, rtol, atol)


def check_names(program: Program, equations: StateEquations) -> None:
    """Refuse switches whose columns would hide a signal's."""
    taken = {str(name) for name in (*equations.signals, *program.law_states, *program.asked)}
    for port in program.switches:
        if str(port.name) in taken:
            raise StructureError(
                f"switch {port.name!r} is called like a signal or another switch, and each is a column of a "
                "result; rename it"
            )
        taken.add(str(port.name))

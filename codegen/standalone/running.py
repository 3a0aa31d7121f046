"""Runs in fixed steps, sampled at given times."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Point, vector
from codegen.standalone.instant import Instant
from codegen.standalone.stepping import FixedSteps, Given, Signal
from codegen.tuning import TUNING


def named(
    changed: Mapping[str, object], defaults: Mapping[str, float], what: str
) -> dict[str, float]:
    """Defaults with some of them changed, as floats; names that are not known are refused."""
    if unknown := [name for name in changed if name not in defaults]:
        raise ValueError(f"no {what} is called {unknown[0]!r}; there is {', '.join(defaults)}")
    values = {**defaults, **changed}
    return {name: number(values[name], f"{what} {name}") for name in defaults}


def number(value: Any, what: str) -> float:
    """A float; what is no finite real number is refused."""
    if isinstance(value, (str, complex)) or not np.isfinite(float(value)):
        raise ValueError(f"{what} must be a finite real number, not {value!r}")
    return float(value)


def functions(inputs: Mapping[str, object], names: Sequence[str]) -> list[Signal]:
    """A function of time for each input; a number is held."""
    if wrong := {*names} ^ {*inputs}:
        raise ValueError(f"inputs must be exactly {names}; not so: {sorted(wrong)}")
    return [_signal(name, inputs[name]) for name in names]


def _signal(name: str, given: object) -> Signal:
    if callable(given):
        return given
    value = number(given, f"input {name}")
    return lambda t: value


def sampled(signals: Sequence[Signal], t: float, h: float) -> list[Given]:
    """The inputs and their rates at the start, the middle and the end of a step.

    The rates are those of the parabola through the three.
    """
    w_0, w_m, w_1 = (
        np.array([signal(time) for signal in signals], dtype=float)
        for time in (t, t + h / 2, t + h)
    )
    rates = 4 * w_m - 3 * w_0 - w_1, w_1 - w_0, 3 * w_1 + w_0 - 4 * w_m
    return [(w, rate / h) for w, rate in zip((w_0, w_m, w_1), rates, strict=True)]


def run(
    model: FixedSteps,
    time: ArrayLike,
    initial: Mapping[str, object],
    inputs: Mapping[str, object],
    step: float,
    dead_band: float,
    initially_on: Collection[str] = (),
) -> dict[str, Array]:
    """Integrate with steps of at most ``step`` [s] and sample at the times given."""
    names = model.names
    signals = model.recalling(functions(inputs, model.wanted))
    time = np.array(time, dtype=float)
    if time.ndim != 1 or len(time) == 0 or not np.isfinite(time).all() or (np.diff(time) < 0).any():
        raise ValueError("time must be a list of finite points that do not go back")
    if not 0 < step < np.inf:
        raise ValueError(f"a step must be a positive finite number of seconds, not {step}")
    start = named(initial, dict.fromkeys(names.states, 0.0), "state")
    given = sampled(signals, time[0], step)
    s = vector(model.form, time[0], np.array([*start.values()], dtype=float), *given[0])
    s = model.begin(Point(time[0], s, *given[0]), initially_on, initial)
    mode, rows = None, []
    for t, end in zip(time, [*time[1:], time[-1]], strict=True):
        begin, sampling = t, True
        while sampling or begin < end:
            stop = model.until(begin, end)
            parts = max(1, int(np.ceil((stop - begin) / step * (1 - TUNING.whole_steps))))
            h = (stop - begin) / parts or step
            for count in range(parts if end > t else 1):
                at = begin + count * h
                given = sampled(signals, at, h)
                mode, s = model.settled(Point(at, s, *given[0]), mode, dead_band, h)
                if sampling:
                    rows.append(_row(model, model.at(Point(at, s, *given[0]), mode), mode))
                    sampling = False
                if end > t:
                    mode, s = model.advance(at, h, s, given, mode)
            begin = stop
    columns = (*names.states, *names.external, *names.shown, *names.switches)
    return {"t": time, **dict(zip(columns, np.array(rows).T, strict=True))}


def _row(model: FixedSteps, now: Instant, mode: Mode) -> list[float]:
    """A sample: states, inputs, what is shown, switches. Refuses what is not finite."""
    shown = model.named(now)
    # What laws give may be infinite where states and rates are not.
    if not np.isfinite([*now.x, *now.z, *now.rate]).all():
        raise ArithmeticError(f"at t = {now.t:g} a value is not finite; give a shorter step")
    values = (shown[name] for name in model.names.shown)
    return [*now.x, *now.z, *now.w, *values, *model.shown(mode)]

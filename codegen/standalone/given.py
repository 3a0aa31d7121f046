"""What a run is given: numbers by name, and inputs as functions of time."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Signal = Callable[[float], float]


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

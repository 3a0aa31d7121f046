"""What delays read, with numbers for parameters."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.nodes.lagging import Lagging
from codegen.model.exact_values import at_parameters
from codegen.model.sources import Lag, lags
from codegen.numbers.lambdified import lambdified


@dataclass(frozen=True)
class Reading:
    """A delay with numbers: its name, how late it is, and what it reads of signals by name."""

    name: str
    lag: Lag
    value: Callable[[Mapping[str, float]], float]


def readings(
    delays: Sequence[Lagging], parameters: Mapping[str, sp.Rational]
) -> tuple[Reading, ...]:
    """The delays with numbers for their parameters.

    Raises what `lags` raises.
    """
    found = []
    for one, lag in zip(delays, lags(delays, parameters), strict=True):
        value = at_parameters(one.value, parameters)
        names = sorted(map(str, value.free_symbols))
        function = lambdified([sp.Symbol(name) for name in names], [value])
        found.append(Reading(one.given.name, lag, _by_name(function, names)))
    return tuple(found)


def _by_name(function: Callable[..., object], names: Sequence[str]) -> Callable[..., float]:
    def value(now: Mapping[str, float]) -> float:
        return float(np.asarray(function(*(now[name] for name in names))).ravel()[0])

    return value

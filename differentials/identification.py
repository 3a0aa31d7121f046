"""Inertias that the paper does not print, found from the mode frequencies that it does."""

from collections.abc import Mapping, Sequence

import bondgraph as bg
from bondgraph.analyse.state_space import StateSpace
from codegen.standalone.roots import root
from differentials.model import Model, model
from differentials.parameters import checked

LEAST, MOST = 1e-6, 10.0
"""Inertias [kg m^2] between which one is looked for."""


def linear_model(
    name: str, parameters: Mapping[str, float] | None = None, wheel_speed: float = 80.0
) -> StateSpace:
    """The full model with open clutches and tires linearised at a speed [rad/s], in numbers.

    Raises `ParameterError` for a name that the differential does not use, `StructureError` for an
    unknown differential.

    >>> shuffle = linear_model("alsd").modes()[0]
    >>> round(shuffle.damped_frequency, 1)
    18.6
    """
    full = model(name)
    return _linear(full).numeric(numbers(full, parameters or {}, wheel_speed))


def identified_inertia(
    name: str, symbols: Sequence[str], frequency: float, pattern: Mapping[str, float],
    parameters: Mapping[str, float] | None = None, wheel_speed: float = 80.0,
) -> float:  # fmt: skip
    """The common value of inertias at which a mode oscillates at a frequency [Hz].

    The mode is the one along ``pattern``, states to weights; all ``symbols`` get the same value, which is
    the assumption to state with the result. Clutches are open, tires linearised at ``wheel_speed`` [rad/s].

    Raises `ParameterError` if no inertia between 1e-6 and 10 kg m^2 gives that frequency.

    >>> opposite = {"omega_1": 1, "omega_2": -1}
    >>> round(identified_inertia("alsd", ["I_1", "I_2"], 165, opposite), 4)
    0.008
    """
    full = model(name)
    linear, given = _linear(full), dict(parameters or {})

    def distance(inertia: float) -> float:
        values = numbers(full, {**given, **dict.fromkeys(symbols, inertia)}, wheel_speed)
        return linear.numeric(values).mode(pattern).damped_frequency - frequency

    if distance(LEAST) * distance(MOST) > 0:
        raise bg.ParameterError(
            f"{name}: no inertia {', '.join(symbols)} from {LEAST:g} to {MOST:g} kg m^2 gives that mode "
            f"{frequency:g} Hz"
        )
    return root(distance, LEAST, MOST)


def _linear(full: Model) -> bg.LinearModel:
    """Slipping clutches give constant torques, which no small deviation changes."""
    return bg.linearize(full.equations, laws=full.laws)


def numbers(full: Model, changed: Mapping[str, float], speed: float) -> dict[str, float]:
    """A full model's defaults, its tires at a wheel speed [rad/s], and what is changed.

    Raises `ParameterError` for a name that the differential does not use.
    """
    name = full.differential.name
    values = {symbol: parameter.value for symbol, parameter in full.parameters.items()}
    values |= dict.fromkeys(full.starts, speed)
    return values | checked(name, changed, values)

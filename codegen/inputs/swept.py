"""`Swept`: an input of a sweep whose size is one of each run's numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bondgraph.algebra.atoms import normal
from bondgraph.errors import SignalError
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant

_ONE = Constant(1.0)


@dataclass(frozen=True)
class Swept:
    """A signal times the number that a run has by this name; the number alone without a signal.

    Stands where `codegen.sweep` takes a signal. The name is one that is swept, and may but need not be
    that of a parameter, too.

    Raises `SignalError` for what is no name, or no signal.

    >>> from codegen import Lag, Step
    >>> torque = Swept("torque", Lag(Step(0.5, 1.0), 0.04))
    >>> round(torque.of({"torque": 1000.0})(0.54), 3)
    632.121
    """

    name: str
    signal: Signal = _ONE

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not isinstance(self.signal, Signal):
            raise SignalError(f"{self}: a swept input has the name of a swept number and a signal")
        object.__setattr__(self, "name", str(normal(self.name)))

    def of(self, values: Mapping[str, float]) -> Signal:
        """The signal of a run with these numbers; `SignalError` where there is none of this name."""
        if self.name not in values:
            raise SignalError(f"{self.name!r} is not swept; swept are {', '.join(values)}")
        return values[self.name] * self.signal


def settled(inputs: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """Inputs of the run with these numbers; `SignalError` for what is no mapping."""
    if not isinstance(inputs, Mapping):
        raise SignalError(f"inputs must map names to values, not be {inputs!r}")
    return {
        name: given.of(values) if isinstance(given, Swept) else given
        for name, given in inputs.items()
    }

"""The numbers: what the paper prints, and what it leaves open."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Parameter:
    """A number, its unit, what it is, and where it comes from."""

    value: float
    unit: str
    meaning: str
    source: str


_PAPER = "IMECE2008-69248, simulation results"
_ASSUMED = "assumed: the paper estimates it from drawings and does not print it"

PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {
        "i": Parameter(2.8, "", "final drive ratio, input over case speed", _PAPER),
        "I_i": Parameter(0.1604, "kg m^2", "input inertia with the case referred to it", _PAPER),
        "I_1": Parameter(0.008, "kg m^2", "left output inertia", _ASSUMED),
        "I_2": Parameter(0.008, "kg m^2", "right output inertia", _ASSUMED),
        "I_w": Parameter(0.8, "kg m^2", "wheel inertia", _PAPER),
        "k": Parameter(8600, "N m/rad", "halfshaft stiffness", _PAPER),
        "b": Parameter(0, "N m s/rad", "halfshaft damping", _PAPER),
        "k_t": Parameter(200_000, "N", "slope of the tire's force over slip at zero slip", _PAPER),
        "r": Parameter(0.3, "m", "effective tire radius", _PAPER),
    }
)
"""By the paper's symbols."""

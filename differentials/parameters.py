"""The numbers: what the paper prints, what follows from its mode frequencies, what is assumed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import bondgraph as bg
from bondgraph.named import Named


@dataclass(frozen=True)
class Parameter:
    """A number, its unit, what it is, and where it comes from."""

    value: float
    unit: str
    meaning: str
    source: str


_PAPER = "IMECE2008-69248, Appendix B"
_ASSUMED = "assumed: the paper does not give it"
_CLUTCH_MODE = (
    "identified from the ALSD's clutch mode, 165 Hz; assumes equal inertias at all outputs"
)
_BRAKE_MODE = "identified from the stationary TVD's clutch mode, 11.4 Hz; assumes equal carriers"
_SUN_MODE = "identified from the 4WD's clutch mode, 41 Hz, taken as the antisymmetric one; assumes equal suns"


def _numbered(parameter: Parameter, *names: str) -> dict[str, Parameter]:
    return dict.fromkeys(names, parameter)


_OUTPUT = Parameter(0.008, "kg m^2", "output inertia, all that turns with the output", _CLUTCH_MODE)
_WHEEL = Parameter(0.808, "kg m^2", "wheel and output inertia", "I_w + I_1 of the full model")
_SHAFT = Parameter(8600, "N m/rad", "halfshaft stiffness", _PAPER)

PARAMETERS: Mapping[str, Parameter] = Named(
    {
        "i": Parameter(2.8, "", "final drive ratio, input over case speed", _PAPER),
        "I_i": Parameter(0.1604, "kg m^2", "input inertia, the case's referred to it", _PAPER),
        **_numbered(_OUTPUT, "I_1", "I_2", "I_3", "I_4"),
        "I_w": Parameter(0.8, "kg m^2", "wheel inertia", _PAPER),
        **_numbered(_WHEEL, "I_w1", "I_w2", "I_w3", "I_w4"),
        "k": _SHAFT,
        **_numbered(_SHAFT, "k_1", "k_2"),
        "b": Parameter(0, "N m s/rad", "halfshaft damping", _PAPER),
        "k_is": Parameter(20_000, "N m/rad", "input shaft stiffness", _ASSUMED),
        "b_is": Parameter(10, "N m s/rad", "input shaft damping", _ASSUMED),
        "gap": Parameter(0.03, "rad", "backlash, from face to face", _ASSUMED),
        "k_t": Parameter(200_000, "N", "slope of the tire's force over slip at zero slip", _PAPER),
        "r": Parameter(0.3, "m", "effective tire radius", _PAPER),
        "C_t": Parameter(1.65, "", "shape of the magic formula", _ASSUMED),
        "D_t": Parameter(4000, "N", "peak force of the magic formula", _ASSUMED),
        "E_t": Parameter(-1, "", "curvature of the magic formula", _ASSUMED),
    }
)
"""By the paper's symbols; `OWN` has what differs from one differential to another."""

_BRAKED = "kg m^2", "inertia of a carrier and its brake", _BRAKE_MODE

OWN: Mapping[str, Mapping[str, Parameter]] = MappingProxyType(
    {
        "superposition_tvd": {
            "h1": Parameter(0.875, "", "speed of clutch 1's input over the case's", _PAPER),
            "h2": Parameter(1.125, "", "speed of clutch 2's input over the case's", _PAPER),
        },
        "stationary_tvd": {
            **_numbered(
                Parameter(1.125, "", "output over case speed with the carrier held", _PAPER),
                "h1", "h2",
            ),
            **_numbered(Parameter(0.026, *_BRAKED), "I_c1", "I_c2"),
        },
        "four_wheel_drive_tvd": {
            "i_f": Parameter(2.8, "", "front final drive ratio", _PAPER),
            "i_r": Parameter(2.8 * 2.6 / 3.6, "", "rear ratio, i h/(1 + h)", _PAPER),
            "g": Parameter(1.05, "", "speedup of the rear", _PAPER),
            **_numbered(Parameter(2.6, "", "teeth of ring over sun", _PAPER), "h1", "h2"),
            **_numbered(
                Parameter(0.0094, "kg m^2", "inertia of a sun and its brake", _SUN_MODE),
                "I_s1", "I_s2",
            ),
        },
    }
)  # fmt: skip
"""Per differential, over `PARAMETERS`."""

PRINTED_FREQUENCIES: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        "alsd": (18.9, 165.0),
        "superposition_tvd": (165.0,),
        "stationary_tvd": (11.4,),
        "four_wheel_drive_tvd": (41.0,),
    }
)
"""The mode frequencies [Hz] that the paper's simulation results mention."""


def defaults(name: str, symbols: Iterable[str]) -> dict[str, Parameter]:
    """The default of each of these symbols in a differential, those that have one.

    >>> defaults("superposition_tvd", ["k", "h1", "unheard_of"])["h1"].value
    0.875
    """
    known = {**PARAMETERS, **OWN.get(name, {})}
    return {symbol: known[symbol] for symbol in symbols if symbol in known}


def checked(name: str, changed: Mapping[str, float], known: Iterable[str]) -> dict[str, float]:
    """The changed values; `ParameterError` for a name that the differential does not use."""
    names = list(known)
    for symbol in changed:
        if symbol not in names:
            raise bg.ParameterError(
                f"{name} has no parameter {symbol!r}; there are {', '.join(names)}"
            )
    return dict(changed)

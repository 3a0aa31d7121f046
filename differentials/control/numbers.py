"""The numbers of the car, of its clutches' actuators and of the controllers."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from bondgraph.named import Named
from differentials.parameters import Parameter, defaults

_ABE = "M. Abe, Vehicle Handling Dynamics, 2015, the car of chapter 3's examples"
_PAPER = "IMECE2008-69248, Appendix B"
_ASSUMED = "assumed"
_TUNED = "chosen by the open loop's margins"

CAR: Mapping[str, Parameter] = Named(
    {
        "v": Parameter(24.0, "m/s", "speed ahead: 80 rad/s of the wheels", "the paper's scenarios"),
        "m": Parameter(1500, "kg", "mass of the car", _ABE),
        "I_z": Parameter(2500, "kg m^2", "yaw moment of inertia", _ABE),
        "l_f": Parameter(1.1, "m", "from the centre of gravity to the front axle", _ABE),
        "l_r": Parameter(1.6, "m", "from the centre of gravity to the rear axle", _ABE),
        "K_f": Parameter(55_000, "N/rad", "cornering stiffness of a front tire", _ABE),
        "K_r": Parameter(60_000, "N/rad", "cornering stiffness of a rear tire", _ABE),
        "track": Parameter(1.5, "m", "from the left wheels to the right ones", _ASSUMED),
        **{
            f"k_t{wheel}": Parameter(
                200_000, "N", f"slope of tire {wheel}'s force over slip at zero slip", _PAPER
            )
            for wheel in range(1, 5)
        },
    }
)
"""Of the single-track car and its tires."""

_FOLLOWS = "understeer of the car to be followed: its yaw rate is v delta/(l + K_ref v^2)"

CONTROL: Mapping[str, Parameter] = Named(
    {
        "T_a": Parameter(0.04, "s", "lag of a clutch's actuator", "the paper's 40 ms"),
        "tau_max": Parameter(
            1000, "N m", "most that the wheels' torques are made to differ", _ASSUMED
        ),
        "rate_max": Parameter(
            10_000, "N m/s", "most that the demanded difference changes by", _ASSUMED
        ),
        "K_ref": Parameter(0.001, "s^2/m", _FOLLOWS, _ASSUMED),
        "T_ref": Parameter(0.1, "s", "lag of the car to be followed", _ASSUMED),
        "dw_ref": Parameter(1.0, "rad/s", "slip that is left", _ASSUMED),
    }
)
"""Of actuators and controllers; `GAINS` has those of the PI laws."""

GAINS: Mapping[str, Mapping[str, Parameter]] = MappingProxyType(
    {
        "yaw_rate": {
            "K_p": Parameter(10_000, "N m s/rad", "torque difference over yaw rate", _TUNED),
            "K_i": Parameter(100_000, "N m/rad", "the same over its integral", _TUNED),
        },
        "slip": {
            "K_p": Parameter(20, "N m s/rad", "torque difference over wheels' speeds", _TUNED),
            "K_i": Parameter(450, "N m/rad", "the same over their integral", _TUNED),
        },
    }
)
"""Of a PI law, by what it controls."""

UNDERSTEERING: Mapping[str, Parameter] = MappingProxyType(
    {"K_ref": Parameter(0.004, "s^2/m", _FOLLOWS, _ASSUMED)}
)
"""Of a differential that can only hold a turn back."""


def numbers(name: str, control: str, symbols: Iterable[str]) -> dict[str, Parameter]:
    """The default of each of these symbols in a loop, those that have one.

    >>> numbers("alsd", "slip", ["k", "m", "K_p"])["K_p"].value
    20
    """
    wanted = list(symbols)
    own = UNDERSTEERING if name == "alsd" else {}
    known = {**CAR, **CONTROL, **GAINS[control], **own}
    return defaults(name, wanted) | {one: known[one] for one in wanted if one in known}

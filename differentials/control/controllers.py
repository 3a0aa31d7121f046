"""What leads the clutches: a sampled PI law of the yaw rate or of the wheels' slip, and the actuators.

Both laws tell by how much the wheels' torques are to differ, and a clutch's demand is that over what 1 N m of
it does. So one pair of gains does for all differentials, and each keeps its bounds and its rate.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import bondgraph as bg
from differentials.parts import Part, part
from differentials.topologies import differential


@dataclass(frozen=True)
class Law:
    """What one differential's controller goes by.

    ``error``: what drives the wheels' difference of torques up. ``both``: whether that has a sign: then the
    first clutch drives the left wheel, the second the right one; else all clutches have one demand.
    ``ratio``: by clutch, the difference of the wheels' torques over the clutch's.
    """

    error: str
    both: bool
    ratio: tuple[str, ...]


ALONG, AHEAD = "omega_t1 - omega_t2", "(omega_t3 + omega_t4)/2 - (omega_t1 + omega_t2)/2"
BEND = "track*omega_z/r"
"""By how much the right wheel is faster than the left one in a bend, without slip."""

_RATIOS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "alsd": ("1",),
        "superposition_tvd": ("1", "1"),
        "stationary_tvd": ("1/(h1 - 1)", "1/(h2 - 1)"),
        "four_wheel_drive_tvd": ("(1 + h1)", "(1 + h2)"),
    }
)

CONTROLS = ("yaw_rate", "slip")
"""What is controlled."""


def law(name: str, control: str) -> Law:
    """What a differential's controller of the yaw rate or of the slip goes by.

    A limited slip differential holds a turn back, whichever way it goes; the others turn the car either way.
    Slip is how much faster the left wheel is than the right one, beyond the bend's own; of the four wheel
    drive, whose rear wheels get torque by the clutches alone, how far the front axle is ahead of the rear.

    Raises `StructureError` for a differential without a clutch behind its case, and for another control.

    >>> law("superposition_tvd", "yaw_rate").error
    'omega_ref - omega_z'
    """
    differential(name)
    if name not in _RATIOS:
        raise bg.StructureError(
            f"{name} has no clutch that moves torque between wheels; there is {', '.join(_RATIOS)}"
        )
    if control not in CONTROLS:
        raise bg.StructureError(
            f"no control is called {control!r}; there is {', '.join(CONTROLS)}"
        )
    limited, four = name == "alsd", name == "four_wheel_drive_tvd"
    if control == "yaw_rate":
        error = "abs(omega_z) - abs(omega_ref)" if limited else "omega_ref - omega_z"
    else:
        error = "abs(dw) - dw_ref"
        if not (limited or four):
            error = "max(dw - dw_ref, min(dw + dw_ref, 0))"
        elif four:
            error = "dw - dw_ref"
    both = not (limited or (four and control == "slip"))
    return Law(error, both, _RATIOS[name])


def demands(name: str) -> tuple[str, ...]:
    """The signals that the actuators follow, by clutch."""
    return tuple(level.replace("tau_h", "demand") for level in differential(name).clutches.values())


def actuators(name: str) -> Part:
    """Each clutch's hydraulic torque as a state that follows its demand by a first-order lag T_a."""
    levels = differential(name).clutches.values()
    lags = [
        bg.State(level, f"({demand} - {level})/T_a")
        for level, demand in zip(levels, demands(name), strict=True)
    ]
    return part([*lags, bg.Function("dw", _slip(name))])


FOLLOWED = "(v*delta/(l_f + l_r + K_ref*v**2) - omega_ref)/T_ref"
"""The rate of the yaw rate that is followed: a car's of understeer K_ref, by a first-order lag."""


def _slip(name: str) -> str:
    return AHEAD if name == "four_wheel_drive_tvd" else f"{ALONG} + {BEND}"


def controller(name: str, control: str, period: str, error: str | None = None) -> Part:
    """A PI law, sampled every ``period`` [s], within bounds and a rate; ``error``: another one to go by.

    The sum is told back by what the bounds left of the demand, so that it does not wind up (K. J. Astrom and
    B. Wittenmark, Computer-Controlled Systems, 3rd ed., 1997, section 8.5: back-calculation, here at once).
    """
    by = law(name, control)
    e = f"({by.error if error is None else error})"
    names = demands(name)
    last = f"{by.ratio[-1]}*{names[-1]}"
    low = "0"
    if by.both:
        last, low = f"({last} - {by.ratio[0]}*{names[0]})", "-tau_max"
    step = f"rate_max*({period})"
    near = f"max({last} - {step}, min({last} + {step}, K_p*{e} + integral))"
    wish = f"max({low}, min(tau_max, {near}))"
    signs = ("-", "") if by.both else ("",) * len(names)
    gives = {
        demand: f"max(0, {sign}{wish})/({ratio})" if by.both else f"{wish}/({ratio})"
        for demand, sign, ratio in zip(names, signs, by.ratio, strict=True)
    }
    told = {"integral": f"{wish} - K_p*{e} + K_i*({period})*{e}"}
    node = bg.Controller(
        "controller", every=period, states={"integral": 0}, update=told, gives=gives
    )
    return part([node, bg.State("omega_ref", FOLLOWED)] if control == "yaw_rate" else [node])

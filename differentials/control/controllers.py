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

RATIOS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "alsd": ("1",),
        "superposition_tvd": ("1", "1"),
        "stationary_tvd": ("1/(h1 - 1)", "1/(h2 - 1)"),
        "four_wheel_drive_tvd": ("(1 + h1)", "(1 + h2)"),
    }
)
"""Of each differential whose clutches move torque between wheels: `Law.ratio`."""

CONTROLS = ("yaw_rate", "slip")
"""What is controlled."""


def law(name: str, control: str) -> Law:
    """What a differential's controller of the yaw rate or of the slip goes by.

    A limited slip differential holds a turn back, whichever way it goes; the others turn the car either way.
    Slip ``dw`` is how much faster the left wheel is than the right one, beyond the bend's own; of the four
    wheel drive, whose rear wheels get torque by the clutches alone, how far the front axle is ahead of the
    rear. What only holds back, or drives the rear alone, leaves ``dw_ref`` of it.

    Raises `StructureError` for a differential without a clutch behind its case, and for another control.

    >>> law("superposition_tvd", "yaw_rate").error
    'omega_ref - omega_z'
    """
    differential(name)
    if name not in RATIOS:
        raise bg.StructureError(
            f"{name} has no clutch that moves torque between wheels; there is {', '.join(RATIOS)}"
        )
    if control not in CONTROLS:
        raise bg.StructureError(f"no control is called {control!r}; there is {', '.join(CONTROLS)}")
    limited, four = name == "alsd", name == "four_wheel_drive_tvd"
    if control == "yaw_rate":
        error = "abs(omega_z) - abs(omega_ref)" if limited else "omega_ref - omega_z"
    else:
        error = "abs(dw) - dw_ref" if limited else "dw - dw_ref" if four else "dw"
    both = not (limited or (four and control == "slip"))
    return Law(error, both, RATIOS[name])


def demands(name: str) -> tuple[str, ...]:
    """The signals that the actuators follow, by clutch."""
    count = len(differential(name).clutches)
    return ("demand",) if count == 1 else tuple(f"demand_{j}" for j in range(1, count + 1))


def actuators(name: str) -> Part:
    """Each clutch's hydraulic torque as a state that follows its demand by a first-order lag T_a."""
    levels = differential(name).clutches.values()
    lags = [
        bg.State(level, f"({demand} - {level})/T_a")
        for level, demand in zip(levels, demands(name), strict=True)
    ]
    slip = AHEAD if name == "four_wheel_drive_tvd" else f"{ALONG} + {BEND}"
    return part([*lags, bg.Function("dw", slip)])


FOLLOWED = "(v*delta/(l_f + l_r + K_ref*v**2) - omega_ref)/T_ref"
"""The rate of the yaw rate that is followed: a car's of understeer K_ref, by a first-order lag."""


def controller(name: str, control: str, period: str, error: str | None = None) -> Part:
    """A PI law, sampled every ``period`` [s], within bounds and a rate; ``error``: another one to go by.

    ``asked`` [N m] is the difference of the wheels' torques that it asks for. What the bounds left of it is
    told back to the sum, which so does not wind up (back-calculation: K. J. Astrom and T. Hagglund, PID
    Controllers, 2nd ed., 1995, section 3.5; here within one period).
    """
    by = law(name, control)
    e = f"({by.error if error is None else error})"
    low, step, free = "-tau_max" if by.both else "0", f"rate_max*({period})", f"K_p*{e} + integral"
    asked = f"max({low}, asked - {step}, min(tau_max, asked + {step}, {free}))"
    signs = ("-", "") if by.both else ("",) * len(by.ratio)
    shares = [f"max(0, {sign}{asked})" if by.both else asked for sign in signs]
    node = bg.Controller(
        "controller",
        every=period,
        states={"integral": 0},
        update={"integral": f"{asked} - K_p*{e} + K_i*({period})*{e}"},
        gives={
            "asked": asked,
            **{
                demand: f"{share}/({ratio})"
                for demand, share, ratio in zip(demands(name), shares, by.ratio, strict=True)
            },
        },
    )
    return part([node, bg.State("omega_ref", FOLLOWED)] if control == "yaw_rate" else [node])

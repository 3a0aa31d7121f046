"""Pictures of closed loops: all active differentials in one manoeuvre, and one run of one of them."""

from collections.abc import Mapping
from types import MappingProxyType

from codegen.pictures.labels import pretty
from differentials.control.controllers import RATIOS, law
from differentials.control.manoeuvres import Manoeuvre
from differentials.figures import Curve, Figure, Panel, panels
from differentials.topologies import Differential

SHORT: Mapping[str, str] = MappingProxyType(
    {
        "alsd": "ALSD", "superposition_tvd": "superposition", "stationary_tvd": "stationary",
        "four_wheel_drive_tvd": "4WD",
    }
)  # fmt: skip
"""What the differentials are called in a legend."""


def _each(label: str, signal: str, *after: Curve, minus: str | None = None) -> Panel:
    """A signal of every controlled run, in the catalog's order, and so in one colour in all panels."""
    curves = [Curve(signal, SHORT[name], minus, run=at) for at, name in enumerate(RATIOS)]
    return Panel(label, (*curves, *after))


_OPEN = len(RATIOS)
"""The first run with open clutches."""

_YAW = _each(
    "Yaw Rate\n[rad/s]",
    "omega_z",
    Curve("omega_z", "clutches open", run=_OPEN),
    Curve("omega_ref", "ALSD to follow"),
    Curve("omega_ref", "TVD to follow", run=1),
)

LOOP_FIGURES: Mapping[str, Figure] = MappingProxyType(
    {
        "step_steer": Figure(
            "Yaw rate control: a step of the steering by 0.02 rad at 24 m/s",
            (*((name, "step_steer") for name in RATIOS), ("superposition_tvd", "step_steer_open")),
            (
                _YAW,
                _each("Sideslip\n[rad]", "beta", Curve("beta", "clutches open", run=_OPEN)),
                _each("Asked\n[N m]", "asked"),
                _each("Right - Left\n[N m]", "tau_hs2", minus="tau_hs1"),
                _each("Left - Right\n[rad/s]", "omega_t1", minus="omega_t2"),
            ),
            marked=False,
        ),
        "ice": Figure(
            "Slip control: the engine pulls, the left wheel (4WD: the front axle) on ice",
            (
                *((name, "ice") for name in RATIOS),
                ("superposition_tvd", "ice_open"), ("four_wheel_drive_tvd", "ice_open"),
            ),
            (
                _each("Slip\n[rad/s]", "dw", Curve("dw", "clutches open", run=_OPEN),
                      Curve("dw", "4WD, clutches open", run=_OPEN + 1)),
                _each("Asked\n[N m]", "asked"),
                _each("Right Trq\n[N m]", "tau_hs2", Curve("tau_hs2", "clutches open", run=_OPEN)),
                _each("Yaw Rate\n[rad/s]", "omega_z"),
            ),
            marked=False,
        ),
    }
)  # fmt: skip
"""By manoeuvre."""


def loop_panels(chosen: Differential, case: Manoeuvre) -> tuple[Panel, ...]:
    """The panels of `panels`, above them the car and what its controller asks for."""
    law(chosen.name, case.control)
    yaw = ["omega_z", *(["omega_ref"] if case.closed and case.control == "yaw_rate" else [])]
    above = [("Yaw Rate\n[rad/s]", yaw), ("Slip\n[rad/s]", ["dw"])]
    if case.closed:
        above.append(("Asked\n[N m]", ["asked"]))
    shown = [
        Panel(label, tuple(Curve(one, pretty(one)) for one in names)) for label, names in above
    ]
    return (*shown, *panels(chosen))

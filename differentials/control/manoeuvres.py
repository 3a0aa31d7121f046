"""What a closed loop is driven through, as data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from bondgraph.named import Named


@dataclass(frozen=True)
class Manoeuvre:
    """A start straight ahead without torque, then a step of the steering, of the engine, or of both.

    ``control``: "yaw_rate" or "slip". ``closed``: whether the controller works; else the clutches are open.
    ``steering``: of the front wheels [rad], ``engine_torque`` [N m]: demands, stepped at ``step`` [s],
    followed by first-order lags of ``steering_lag`` and ``lag`` [s]. ``parameters``: what differs from the
    defaults, ``own``: by differential.

    Raises nothing by itself; `closed_loop` refuses what does not fit.
    """

    control: str
    closed: bool = True
    steering: float = 0.0
    engine_torque: float = 0.0
    step: float = 0.1
    duration: float = 1.5
    steering_lag: float = 0.05
    lag: float = 0.04
    parameters: Mapping[str, float] = field(default_factory=dict)
    own: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


ICE = 10_000.0
"""Slope of a tire's force over slip on ice [N], a twentieth of that on the road: assumed."""

_LEFT = {"k_t1": ICE}
_ICE = MappingProxyType(
    {
        "alsd": _LEFT, "superposition_tvd": _LEFT, "stationary_tvd": _LEFT,
        "four_wheel_drive_tvd": {"k_t3": ICE, "k_t4": ICE},
    }
)  # fmt: skip

manoeuvres: Mapping[str, Manoeuvre] = Named(
    {
        "step_steer": Manoeuvre("yaw_rate", steering=0.02),
        "step_steer_open": Manoeuvre("yaw_rate", closed=False, steering=0.02),
        "ice": Manoeuvre("slip", engine_torque=350.0, own=_ICE),
        "ice_open": Manoeuvre("slip", closed=False, engine_torque=350.0, own=_ICE),
    }
)
"""A step of the steering, as of ISO 7401, and one of the engine with a wheel, or the front axle, on ice."""

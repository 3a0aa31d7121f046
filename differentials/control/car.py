"""The linear single-track car as a bond graph, on the wheels of a differential.

M. Abe, Vehicle Handling Dynamics, 2nd ed., 2015, section 3.2, eqs. (3.12), (3.13), beside which the wheels'
forces ahead, F_x, turn the car by half a track each:

    m (v_y' + v omega_z) = F_yf + F_yr             F_yf = -2 K_f ((v_y + l_f omega_z)/v - delta)
    I_z omega_z' = l_f F_yf - l_r F_yr + M_z       F_yr = -2 K_r (v_y - l_r omega_z)/v

with ``M_z = track/2 (F_x right - F_x left)``. The axes are the car's: x ahead, y to the left, a turn to the
left is positive.
"""

import bondgraph as bg
from differentials.parts import Part, part

LEFT, RIGHT = (1, 3), (2, 4)
"""Wheels by their numbers: those on the left, those on the right."""


def single_track() -> Part:
    """The car at a constant speed v ahead [m/s]: lateral speed ``v_y`` [m/s], yaw rate ``omega_z`` [rad/s].

    Terminals: the 1-junctions ``forward`` and ``yaw``. ``delta`` is the steering angle of the front wheels
    [rad], ``beta`` the sideslip angle of the centre of gravity.

    The speed v is held by a source, as the tires of the paper have it, and so are the steered wheels' lateral
    speed ``v delta`` and the force ``-m v omega_z`` of the turning axes: what these take from the drive
    ahead, ``F_yf delta`` and ``m omega_z v_y``, is of second order, and the sources' power.

    Raises nothing.
    """
    return part(
        [
            bg.Sf("speed", "1*v"), bg.One("forward"),
            bg.One("lateral"), bg.I("m", "m", flow="v_y"), bg.Se("turning", "-m*v*omega_z"),
            bg.One("yaw"), bg.I("I_z", "I_z", flow="omega_z"),
            bg.Zero("front"), bg.TF("front_arm", "l_f"), bg.Sf("steering", "-v*delta"),
            bg.R("front_tires", "2*K_f/v", effort="F_f"),
            bg.Zero("rear"), bg.TF("rear_arm", "-l_r"), bg.R("rear_tires", "2*K_r/v", effort="F_r"),
            bg.Function("beta", "v_y/v"),
        ],
        ("speed", "forward"), ("lateral", "m"), ("turning", "lateral"), ("yaw", "I_z"),
        ("lateral", "front"), ("yaw", "front_arm"), ("front_arm", "front"), ("steering", "front"),
        ("front", "front_tires"),
        ("lateral", "rear"), ("yaw", "rear_arm"), ("rear_arm", "rear"), ("rear", "rear_tires"),
    )  # fmt: skip


def contact(number: int) -> Part:
    """A wheel on the road, between its shaft ``wheel_<number>`` and the car.

    The tire ``tire_<number>`` gives a force ``F_x<number>`` [N] ahead at the speed [m/s] at which it slips,
    ``s_x<number> = r omega_t - v_hub``, eqs. (18), (19) of the paper: ``F_x = k_t/v s_x``. The slope
    ``k_t<number>`` [N] is its own, so that one wheel may stand on ice. The hub moves at ``v -+ track/2
    omega_z``, less on the left, more on the right; so force times speed is the wheel's power, less the heat
    of slip.

    Raises nothing.
    """
    side = "-" if number in LEFT else ""
    radius, road, tire, arm = (f"{name}_{number}" for name in ("radius", "road", "tire", "track"))
    return part(
        [
            bg.TF(radius, "r"), bg.Zero(road),
            bg.R(
                tire, law=f"k_t{number}/v*s_x{number}", effort=f"F_x{number}", flow=f"s_x{number}"
            ), bg.TF(arm, f"{side}2/track"),
        ],
        (f"wheel_{number}", radius), (radius, road), (road, tire),
        (road, "forward"), (road, arm), (arm, "yaw"),
    )  # fmt: skip

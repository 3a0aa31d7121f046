"""Clutch and tire laws of the paper, as text and friction for open ports."""

import bondgraph as bg


def coulomb_clutch(level: str) -> bg.DryFriction:
    """The clutch of the paper's simulations: eq. (17) with T_S = T_C, hydraulic torque ``level``."""
    return bg.DryFriction(level)


def linear_tire(number: int) -> str:
    """The linearised tire, eqs. (18), (19): ``tau_t = r b_t (omega_t - omega_0)``, ``b_t = k_t r/v``.

    The tire's centre moves at the constant speed ``v = r omega_0``, each wheel with its own
    ``omega_0``, the parameter ``omega_t<number>_0`` [rad/s].

    >>> linear_tire(1)
    'k_t*r/omega_t1_0*(omega_t1 - omega_t1_0)'
    """
    start = f"omega_t{number}_0"
    return f"k_t*r/{start}*(omega_t{number} - {start})"

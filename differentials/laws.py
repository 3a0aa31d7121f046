"""Clutch, tire and backlash laws of the paper, as text and friction for open ports."""

import sympy as sp

import bondgraph as bg


def coulomb_clutch(level: str) -> bg.DryFriction:
    """The clutch of the paper's simulations: eq. (17) with T_S = T_C, hydraulic torque ``level`` [N m].

    Raises `ExpressionError` for a level that is no expression, or negative.

    >>> coulomb_clutch("tau_h").level
    tau_h
    """
    return bg.DryFriction(level)


def stribeck_clutch(level: str, ratio: object, speed: object) -> bg.DryFriction:
    """Eq. (17) with the curve of Fig. 8: T_S/T_C = ``ratio`` at standstill, 1 far above ``speed`` [rad/s].

    Numbers or names; ``f = 1 + (ratio - 1) exp(-slip/speed)``. The breakaway torque is ``ratio * level``.

    Raises `ParameterError` for a ratio below 1 or a speed that is not positive.

    >>> stribeck_clutch("tau_h", 1.2, 0.1).breakaway
    6/5
    """
    over = bg.expression(ratio, "T_S/T_C of a clutch")
    scale = bg.expression(speed, "Stribeck speed of a clutch")
    if (over - 1).is_negative:
        raise bg.ParameterError(f"T_S/T_C = {over}: a clutch holds at least what it slips with")
    if scale.is_nonpositive:
        raise bg.ParameterError(f"the Stribeck speed of a clutch must be positive, not {scale}")
    return bg.DryFriction(level, 1 + (over - 1) * sp.exp(-sp.Symbol("slip") / scale))


def linear_tire(number: int) -> str:
    """The linearised tire, eqs. (18), (19): ``tau_t = r b_t (omega_t - omega_0)``, ``b_t = k_t r/v``.

    The tire's centre moves at the constant speed ``v = r omega_0``, each wheel with its own
    ``omega_0``, the parameter ``omega_t<number>_0`` [rad/s].

    Raises nothing.

    >>> linear_tire(1)
    'k_t*r/omega_t1_0*(omega_t1 - omega_t1_0)'
    """
    start = f"omega_t{number}_0"
    return f"k_t*r/{start}*(omega_t{number} - {start})"


def magic_formula_tire(number: int) -> str:
    """Pacejka's magic formula: ``tau_t = r D sin(C atan(B s - E (B s - atan(B s))))``, s the slip.

    ``s = (omega_t - omega_0)/omega_0``, as in `linear_tire`. Peak force ``D_t`` [N], shapes ``C_t`` and
    ``E_t``; ``B = k_t/(C_t D_t)``, so that the force's slope at zero slip is k_t. H. B. Pacejka, Tyre and
    Vehicle Dynamics, 2002, section 4.3.

    Raises nothing.

    >>> law = bg.expression(magic_formula_tire(1), "tire")
    >>> law.diff("omega_t1").subs("omega_t1", "omega_t1_0")  # as the linear tire's
    k_t*r/omega_t1_0
    """
    start = f"omega_t{number}_0"
    turned = f"k_t/(C_t*D_t)*(omega_t{number} - {start})/{start}"
    return f"r*D_t*sin(C_t*atan({turned} - E_t*({turned} - atan({turned}))))"


def backlash(twist: str, rate: str, k: str, b: str | None, gap: str) -> sp.Expr:
    """Fig. 5: no torque while the twist is inside the gap, ``k (twist -+ gap/2)`` outside it.

    A damper b adds ``b * rate`` in contact, but the faces push only: they never hold each other.
    """
    q, half = sp.Symbol(twist), bg.expression(gap, "gap of a backlash") / 2
    stiffness = bg.expression(k, "stiffness behind a backlash")
    ahead, behind = stiffness * (q - half), stiffness * (q + half)
    if b is None:
        return sp.Max(ahead, 0) + sp.Min(behind, 0)
    damping = bg.expression(b, "damping behind a backlash") * sp.Symbol(rate)
    return sp.Piecewise(
        (sp.Max(ahead + damping, 0), q > half), (sp.Min(behind + damping, 0), q < -half), (0, True)
    )

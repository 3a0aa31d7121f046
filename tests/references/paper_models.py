"""Appendix B of the paper in numbers: the differentials and their full models, for checking.

Source: Deur, Hancock, Assadian, "Modeling of Active Differential Dynamics", IMECE2008-69248.
It stands alone, written from the equations only; no code is shared with the package it checks.

A differential is A w' = B u, w_f = F w, Eqs. (13), (14), with u = (tau_e, clutches, tires) and
w the speeds of its outputs (1, 2; four-wheel drive: 1, 2 rear and 3, 4 front).

Parameters go by their symbols: i i_f i_r g h1 h2 I_i I_1.. I_w k b k_t r, the stationary TVD's
carriers I_c1 I_c2 and the 4WD's suns I_s1 I_s2. I_i is the lumped I_i*, I_j the lumped inertia
on the differential's side of halfshaft j, so that Appendix B's I_wj* is I_w + I_j.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Parameters = Mapping[str, float]

_COMMON = {"i": 2.8, "I_i": 0.1604, "I_w": 0.8, "k": 8600.0, "b": 0.0, "k_t": 200000.0, "r": 0.3}
PRINTED: dict[str, dict[str, float]] = {
    "passive": _COMMON,
    "alsd": _COMMON,
    "superposition_tvd": _COMMON | {"h1": 0.875, "h2": 1.125},
    "stationary_tvd": _COMMON | {"h1": 1.125, "h2": 1.125},
    "four_wheel_drive_tvd": _COMMON
    | {"h1": 2.6, "h2": 2.6, "g": 1.05, "i_f": 2.8, "i_r": 2.8 * 2.6 / 3.6},
}
"""The parameters the paper prints; I_1.., I_c1, I_c2, I_s1 and I_s2 are not among them."""

SYMBOLS = {s for printed in PRINTED.values() for s in printed} | {
    *("I_1", "I_2", "I_3", "I_4", "I_c1", "I_c2", "I_s1", "I_s2")
}


class Matrices(NamedTuple):
    """A w' = B u, w_f = F w; the columns of B are tau_e, the clutches, the tires."""

    A: Array
    B: Array
    F: Array


class FullModel(NamedTuple):
    """A x' = J x + B u + c, w_f = F x, with u = (tau_e, clutches) and the tires in J and c.

    x = (omega_1..n, tau_k1..n, omega_t1..n).
    """

    A: Array
    J: Array
    B: Array
    c: Array
    F: Array
    start: Array


def _two_outputs(p: Parameters, outputs: Sequence[float]) -> Array:
    """Return Eq. (6)'s A, which the ALSD and the superposition TVD share."""
    a = p["i"] ** 2 * p["I_i"] / 4
    return np.array([[outputs[0] + a, a], [a, outputs[1] + a]])


def passive(p: Parameters, outputs: Sequence[float]) -> Matrices:
    """Return Eq. (6): the passive differential, without a clutch."""
    half = p["i"] / 2
    b = np.array([[half, -1.0, 0.0], [half, 0.0, -1.0]])
    return Matrices(_two_outputs(p, outputs), b, np.zeros((0, 2)))


def alsd(p: Parameters, outputs: Sequence[float]) -> Matrices:
    """Return Appendix B's ALSD."""
    half = p["i"] / 2
    b = np.array([[half, -0.5, -1.0, 0.0], [half, 0.5, 0.0, -1.0]])
    return Matrices(_two_outputs(p, outputs), b, np.array([[0.5, -0.5]]))


def superposition_tvd(p: Parameters, outputs: Sequence[float]) -> Matrices:
    """Return Appendix B's TVD with superposition clutches."""
    half, h1, h2 = p["i"] / 2, p["h1"], p["h2"]
    b = np.array(
        [
            [half, -h1 / 2, -h2 / 2, -1.0, 0.0],
            [half, 1 - h1 / 2, 1 - h2 / 2, 0.0, -1.0],
        ]
    )
    f = np.array([[h1 / 2, h1 / 2 - 1], [h2 / 2, h2 / 2 - 1]])
    return Matrices(_two_outputs(p, outputs), b, f)


def stationary_tvd(p: Parameters, outputs: Sequence[float]) -> Matrices:
    """Return Appendix B's TVD with stationary clutches (brakes on the carriers)."""
    half, h1, h2, c1, c2 = p["i"] / 2, p["h1"], p["h2"], p["I_c1"], p["I_c2"]
    h11, h12 = h1 / (2 * (h1 - 1)), (2 - h1) / (2 * (h1 - 1))
    h21, h22 = h2 / (2 * (h2 - 1)), (2 - h2) / (2 * (h2 - 1))
    cross = -h11 * h12 * c1 - h21 * h22 * c2
    a = _two_outputs(p, outputs) + np.array(
        [
            [h12**2 * c1 + h21**2 * c2, cross],
            [cross, h11**2 * c1 + h22**2 * c2],
        ]
    )
    b = np.array([[half, h12, -h21, -1.0, 0.0], [half, -h11, h22, 0.0, -1.0]])
    return Matrices(a, b, np.array([[-h12, h11], [h21, -h22]]))


def four_wheel_drive_tvd(p: Parameters, outputs: Sequence[float]) -> Matrices:
    """Return Appendix B's 4WD TVD; outputs 1, 2 are the rear ones, 3, 4 the front ones."""
    h1, h2, s1, s2 = p["h1"], p["h2"], p["I_s1"], p["I_s2"]
    ratio, half = p["g"] / p["i_r"], p["i_f"] / 2
    g1, g2, n1, n2 = ratio * h1 * half, ratio * h2 * half, 1 + h1, 1 + h2
    j = half**2 * (p["I_i"] + ratio**2 * (h1**2 * s1 + h2**2 * s2))
    rear1, rear2 = -g1 * n1 * s1, -g2 * n2 * s2
    a = np.diag(np.array(outputs, dtype=float)) + np.array(
        [
            [n1**2 * s1, 0.0, rear1, rear1],
            [0.0, n2**2 * s2, rear2, rear2],
            [rear1, rear2, j, j],
            [rear1, rear2, j, j],
        ]
    )
    clutches = np.array([[0.0, -n1, 0.0], [0.0, 0.0, -n2], [half, g1, g2], [half, g1, g2]])
    f = np.array([[n1, 0.0, -g1, -g1], [0.0, n2, -g2, -g2]])
    return Matrices(a, np.hstack([clutches, -np.eye(4)]), f)


_MODELS: dict[str, Callable[[Parameters, Sequence[float]], Matrices]] = {
    "passive": passive,
    "alsd": alsd,
    "superposition_tvd": superposition_tvd,
    "stationary_tvd": stationary_tvd,
    "four_wheel_drive_tvd": four_wheel_drive_tvd,
}


def outputs_of(name: str) -> int:
    """Return the number of outputs, and so of wheels."""
    return 4 if name == "four_wheel_drive_tvd" else 2


def complete(name: str, parameters: Parameters) -> dict[str, float]:
    """Return the parameters over the printed values."""
    if unknown := set(parameters) - SYMBOLS:
        raise ValueError(f"unknown parameters: {sorted(unknown)}")
    return {**PRINTED[name], **parameters}


def appendix_b(name: str, parameters: Parameters) -> Matrices:
    """Return A, B, F with rigid halfshafts, I_wj* = I_w + I_j."""
    p = complete(name, parameters)
    return _MODELS[name](p, [p["I_w"] + p[f"I_{n + 1}"] for n in range(outputs_of(name))])


def behind_halfshafts(name: str, parameters: Parameters) -> Matrices:
    """Return A, B, F of the full model's differential: I_j for I_wj*, tau_hs for tau_t."""
    p = complete(name, parameters)
    return _MODELS[name](p, [p[f"I_{n + 1}"] for n in range(outputs_of(name))])


def full_model(name: str, parameters: Parameters, wheel_speeds: Sequence[float]) -> FullModel:
    """Return Eqs. (12), (15), (16), each tire linearised about its start speed, Eqs. (18), (19).

    With tau_hsj = tau_kj + b (omega_j - omega_tj) and tau_tj = r b_t (omega_tj - omega_0j),
    b_t = k_t r / v, v = r omega_0j:
    tau_kj' = k (omega_j - omega_tj), I_w omega_tj' = tau_hsj - tau_tj.
    """
    p, starts = complete(name, parameters), np.array(wheel_speeds, dtype=float)
    n = outputs_of(name)
    if starts.shape != (n,) or (starts <= 0).any():
        raise ValueError(f"{name} needs {n} positive wheel speeds, not {wheel_speeds}")
    inner = behind_halfshafts(name, p)
    clutches = inner.F.shape[0]
    inputs, shafts = inner.B[:, : 1 + clutches], inner.B[:, 1 + clutches :]
    one, zero = np.eye(n), np.zeros((n, n))
    tire = p["k_t"] * p["r"] / starts  # r b_t
    a = np.block([[inner.A, zero, zero], [zero, one, zero], [zero, zero, p["I_w"] * one]])
    j = np.block(
        [
            [p["b"] * shafts, shafts, -p["b"] * shafts],
            [p["k"] * one, zero, -p["k"] * one],
            [p["b"] * one, one, -p["b"] * one - np.diag(tire)],
        ]
    )
    b = np.vstack([inputs, np.zeros((2 * n, 1 + clutches))])
    c = np.concatenate([np.zeros(2 * n), tire * starts])
    f = np.hstack([inner.F, np.zeros((clutches, 2 * n))])
    return FullModel(a, j, b, c, f, np.concatenate([starts, np.zeros(n), starts]))


class ModeRows(NamedTuple):
    """Rows over z = (x - start, tau_e, tau_h of each clutch, 1)."""

    rates: Array  # x'
    torques: Array  # tau_f
    slips: Array  # w_f


def in_mode(model: FullModel, signs: Sequence[int]) -> ModeRows:
    """Return the equations with each clutch slipping (sign of its slip) or sticking (0).

    Slipping, tau_f = tau_h sign(slip), Eq. (17); the sticking ones, s, have their torques jointly
    from F_s A^-1 (J x + B u) = 0.
    """
    n, clutches = len(model.start), len(signs)
    width, sign = n + clutches + 2, np.array(signs, dtype=float)
    torques = sign[:, None] * np.eye(width)[n + 1 : -1]
    constant = (model.J @ model.start + model.c)[:, None]
    forces = np.hstack([model.J, model.B[:, :1], np.zeros((n, clutches)), constant])
    push = np.linalg.solve(model.A, model.B[:, 1:])
    rates = np.linalg.solve(model.A, forces) + push @ torques
    stuck = np.flatnonzero(sign == 0)
    own = -model.F[stuck] @ push[:, stuck]
    torques[stuck] = np.linalg.solve(own, model.F[stuck] @ rates)
    rates += push[:, stuck] @ torques[stuck]
    rest = (model.F @ model.start)[:, None]
    slips = np.hstack([model.F, np.zeros((clutches, 1 + clutches)), rest])
    return ModeRows(rates, torques, slips)

"""The differential by hand for tools that know no bonds or parts, in what JAX can differentiate."""

from typing import Any

import jax.numpy as jnp

START = [80.0, 82.0, 0.0, 0.0, 80.0, 82.0, 0.0]
"""Speeds, torques of halfshafts, speeds of wheels, the engine's torque."""


def differential(p: dict[str, Any], y: Any, friction: Any, linear: bool) -> list[Any]:
    """Rates of speeds, halfshafts and wheels under the torques of engine and clutch."""
    w_1, w_2, k_1, k_2, t_1, t_2, tau_e = y[:7]
    a = p["i"] ** 2 * p["I_i"] / 4
    one, two = p["I_1"] + a, p["I_2"] + a
    q_1 = p["i"] / 2 * tau_e - friction / 2 - k_1
    q_2 = p["i"] / 2 * tau_e + friction / 2 - k_2
    d = one * two - a * a
    tires = [p["k_t"] * p["r"] / p[f"w_0{j}"] * (t - p[f"w_0{j}"]) for j, t in ((1, t_1), (2, t_2))]
    if not linear:
        tires = [p["limit"] * jnp.tanh(tire / p["limit"]) for tire in tires]
    return [
        (two * q_1 - a * q_2) / d, (one * q_2 - a * q_1) / d, p["k"] * (w_1 - t_1), p["k"] * (w_2 - t_2),
        (k_1 - tires[0]) / p["I_w"], (k_2 - tires[1]) / p["I_w"],
    ]  # fmt: skip


def opened(p: dict[str, Any], y: Any, linear: bool) -> Any:
    """All rates without the clutch, its engine's torque demanded from the first instant."""
    return jnp.stack([*differential(p, y, 0.0, linear), (p["torque_e"] - y[6]) / p["lag"]])


def hold(p: dict[str, Any], y: Any) -> Any:
    """The torque that keeps the clutch stuck."""
    mass = p["I_1"] + p["I_2"] + p["i"] ** 2 * p["I_i"]
    return y[3] - y[2] - (p["I_1"] - p["I_2"]) * (p["i"] * y[6] - y[2] - y[3]) / mass


def clutched(p: dict[str, Any], y: Any, friction: Any, demand_e: Any, demand_h: Any) -> Any:
    """All rates with the clutch, the torques of engine and clutch behind their demands."""
    lags = [(demand_e - y[6]) / p["lag"], (demand_h - y[7]) / p["lag"]]
    return jnp.stack([*differential(p, y, friction, True), *lags])

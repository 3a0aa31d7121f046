"""Closed loops of the active differentials in a single-track car, integrated by hand, for checking.

Sources: the differentials and halfshafts, Deur, Hancock, Assadian, IMECE2008-69248, as `paper_models` has
them; the car, M. Abe, Vehicle Handling Dynamics, 2015, section 3.2; the tires, eqs. (18), (19) of the paper,
about the hub's speed ``v -+ track/2 omega_z`` instead of a constant one. It stands alone: no code is shared
with the package it checks.

    m (v_y' + v omega_z) = F_yf + F_yr             F_yf = -2 K_f ((v_y + l_f omega_z)/v - delta)
    I_z omega_z' = l_f F_yf - l_r F_yr + M_z       F_yr = -2 K_r (v_y - l_r omega_z)/v
    M_z = track/2 (sum of F_x right - sum of F_x left),  F_xj = k_tj/v (r omega_tj - v +- track/2 omega_z)

The controller's law is written as a program would have it. Between its instants the clutches slip one way,
tau_f = tau_h sign(slip), and all is linear in z, so that z(t + h) = expm(M h) z(t) without discretisation
error; a slip whose sign changes while its clutch gives torque is beyond this judge, and refused.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from references.paper_models import Array, behind_halfshafts, complete, outputs_of

PERIOD, STEP = 0.01, 1e-3
SIDE = np.array([-1.0, 1.0, -1.0, 1.0])
"""The hubs' speeds over track/2 omega_z: left, right, left, right."""

CAR = {
    "m": 1500.0, "I_z": 2500.0, "l_f": 1.1, "l_r": 1.6, "K_f": 55e3, "K_r": 60e3, "v": 24.0, "track": 1.5,
}  # fmt: skip
LAW = {
    "T_a": 0.04, "tau_max": 1000.0, "rate_max": 1e4, "T_ref": 0.1, "dw_ref": 1.0, "T_e": 0.04, "T_d": 0.05,
}  # fmt: skip


@dataclass(frozen=True)
class Drive:
    """What is demanded from 0.1 s on: the steering [rad] and the engine [N m]; ``closed``: with control."""

    control: str
    closed: bool
    delta: float = 0.0
    tau_e: float = 0.0
    until: float = 1.5


def understeer(p: Mapping[str, float]) -> float:
    """The stability factor times the wheelbase, l A: the yaw rate is v delta/(l + l A v^2)."""
    length = p["l_f"] + p["l_r"]
    balance = p["l_r"] * p["K_r"] - p["l_f"] * p["K_f"]
    return p["m"] * balance / (2 * length * p["K_f"] * p["K_r"])


def steady_yaw_rate(p: Mapping[str, float], delta: float) -> float:
    """Abe's eq. (3.39): the yaw rate that a car without a yaw moment settles in."""
    return p["v"] * delta / (p["l_f"] + p["l_r"] + understeer(p) * p["v"] ** 2)


def steady_moment(p: Mapping[str, float], delta: float, yaw_rate: float) -> float:
    """The yaw moment that holds a yaw rate, of the two balances at rest."""
    over_speed = 2 * np.array([p["K_f"], p["K_r"]]) / p["v"]
    arms = np.array([p["l_f"], -p["l_r"]])
    steered = 2 * p["K_f"] * delta
    side = steered - p["m"] * p["v"] * yaw_rate - over_speed @ arms * yaw_rate
    v_y = side / over_speed.sum()
    return float(over_speed @ arms * v_y + over_speed @ arms**2 * yaw_rate - p["l_f"] * steered)


class Loop:
    """z = (omega, tau_k, omega_t, v_y, omega_z, tau_h.., omega_ref, tau_e, delta, demands.., 1)."""

    def __init__(self, name: str, drive: Drive, parameters: Mapping[str, float]) -> None:
        self.name, self.drive = name, drive
        self.p = {**complete(name, self._driveline(parameters)), **CAR, **LAW, **parameters}
        self.n = outputs_of(name)
        self.inner = behind_halfshafts(name, self._driveline(parameters))
        self.clutches = self.inner.F.shape[0]
        self.v_y, self.omega_z = 3 * self.n, 3 * self.n + 1
        self.tau_h = self.omega_z + 1
        self.ref = self.tau_h + self.clutches
        self.tau_e, self.delta = self.ref + 1, self.ref + 2
        self.demand = self.ref + 3
        self.size = self.demand + self.clutches + 1

    def _driveline(self, parameters: Mapping[str, float]) -> dict[str, float]:
        known = {"I_1", "I_2", "I_3", "I_4", "I_c1", "I_c2", "I_s1", "I_s2", "b", "k"}
        return {key: value for key, value in parameters.items() if key in known}

    def matrix(self, signs: Array, on: bool) -> Array:
        """M of z' = M z, the clutches slipping so, the demands stepped or not."""
        p, n, unit = self.p, self.n, np.eye(self.size)
        speed, shaft, wheel = unit[:n], unit[n : 2 * n], unit[2 * n : 3 * n]
        hub = p["v"] * unit[-1] + SIDE[:n, None] * p["track"] / 2 * unit[self.omega_z]
        slopes = np.array([p.get(f"k_t{j + 1}", p["k_t"]) for j in range(n)]) / p["v"]
        force = slopes[:, None] * (p["r"] * wheel - hub)
        torques = np.vstack([unit[self.tau_e], signs[:, None] * unit[self.tau_h : self.ref], shaft])
        m = np.zeros((self.size, self.size))
        m[:n] = np.linalg.solve(self.inner.A, self.inner.B @ torques)
        m[n : 2 * n] = p["k"] * (speed - wheel)
        m[2 * n : 3 * n] = (shaft - p["r"] * force) / p["I_w"]
        self._car(m, unit, force)
        m[self.tau_h : self.ref] = (unit[self.demand : -1] - unit[self.tau_h : self.ref]) / p["T_a"]
        wanted = p["v"] / (p["l_f"] + p["l_r"] + p.get("K_ref", 0.0) * p["v"] ** 2)
        m[self.ref] = (wanted * unit[self.delta] - unit[self.ref]) / p["T_ref"]
        m[self.tau_e] = (on * self.drive.tau_e * unit[-1] - unit[self.tau_e]) / p["T_e"]
        m[self.delta] = (on * self.drive.delta * unit[-1] - unit[self.delta]) / p["T_d"]
        return m

    def _car(self, m: Array, unit: Array, force: Array) -> None:
        p, v_y, omega_z = self.p, unit[self.v_y], unit[self.omega_z]
        front = -2 * p["K_f"] * ((v_y + p["l_f"] * omega_z) / p["v"] - unit[self.delta])
        rear = -2 * p["K_r"] * (v_y - p["l_r"] * omega_z) / p["v"]
        moment = p["track"] / 2 * SIDE[: self.n] @ force
        m[self.v_y] = (front + rear) / p["m"] - p["v"] * omega_z
        m[self.omega_z] = (p["l_f"] * front - p["l_r"] * rear + moment) / p["I_z"]

    def start(self) -> Array:
        """Straight ahead, no torque."""
        z = np.zeros(self.size)
        z[: self.n] = z[2 * self.n : 3 * self.n] = self.p["v"] / self.p["r"]
        z[-1] = 1.0
        return z

    def slip(self, z: Array) -> float:
        """What the slip's controller reads."""
        wheels = z[2 * self.n : 3 * self.n]
        if self.n == 4:
            return float(wheels[2:].mean() - wheels[:2].mean())
        bend = self.p["track"] * z[self.omega_z] / self.p["r"]
        return float(wheels[0] - wheels[1] + bend)

    def error(self, z: Array) -> float:
        """What drives the torque difference up."""
        yaw, wanted, slip = z[self.omega_z], z[self.ref], self.slip(z)
        if self.drive.control == "yaw_rate":
            return float(abs(yaw) - abs(wanted) if self.name == "alsd" else wanted - yaw)
        if self.name == "alsd":
            return abs(slip) - self.p["dw_ref"]
        return slip - self.p["dw_ref"] if self.n == 4 else slip

    def tick(self, z: Array, asked: float, integral: float) -> tuple[Array, float, float]:
        """One instant of the controller: the state after it, what it asks for, its sum."""
        p, e = self.p, self.error(z)
        both = self.name != "alsd" and not (self.n == 4 and self.drive.control == "slip")
        low = -p["tau_max"] if both else 0.0
        change = p["K_p"] * e + integral - asked
        wish = asked + np.clip(change, -p["rate_max"] * PERIOD, p["rate_max"] * PERIOD)
        wish = float(np.clip(wish, low, p["tau_max"]))
        after = z.copy()
        over = self._over()
        after[self.demand : -1] = (
            np.array([max(-wish, 0.0), max(wish, 0.0)] if both else wish) / over
        )
        return after, wish, wish - p["K_p"] * e + p["K_i"] * PERIOD * e

    def _over(self) -> Array:
        """The wheels' difference of torques over each clutch's torque: of B, once halfshafts are rigid."""
        p = self.p
        each = {"stationary_tvd": lambda h: 1 / (h - 1), "four_wheel_drive_tvd": lambda h: 1 + h}
        told = each.get(self.name, lambda h: 1.0)
        return np.array([told(p.get(f"h{j + 1}", 0.0)) for j in range(self.clutches)])


def closed_loop(name: str, drive: Drive, parameters: Mapping[str, float]) -> dict[str, Array]:
    """The response every 1 ms, just after what happens there, by the names that the package has."""
    loop = Loop(name, drive, parameters)
    count, every, begin = round(drive.until / STEP), round(PERIOD / STEP), round(0.1 / STEP)
    z, asked, integral = loop.start(), 0.0, 0.0
    rows, sums = [], []
    flows: dict[tuple[object, ...], Array] = {}
    for step in range(count + 1):
        if drive.closed and step % every == 0:
            z, asked, integral = loop.tick(z, asked, integral)
        rows.append(z)
        sums.append((asked, integral))
        slips = loop.inner.F @ z[: loop.n]
        signs = np.sign(slips)
        key = (*signs, step >= begin)
        if key not in flows:
            flows[key] = expm(loop.matrix(signs, step >= begin) * STEP)
        z = flows[key] @ z
        turned = np.sign(loop.inner.F @ z[: loop.n]) != signs
        if (turned & (z[loop.tau_h : loop.ref] > 1e-6) & (np.abs(slips) > 1e-9)).any():
            raise ValueError(f"a slip changes its sign at {step * STEP:g} s")
    return _named(loop, np.array(rows), np.array(sums))


def _named(loop: Loop, z: Array, sums: Array) -> dict[str, Array]:
    n, marks = loop.n, [""] if loop.clutches == 1 else ["1", "2"]
    found = {"v_y": z[:, loop.v_y], "omega_z": z[:, loop.omega_z]}
    for j in range(n):
        found |= {f"omega_{j + 1}": z[:, j], f"tau_k{j + 1}": z[:, n + j]}
        found[f"omega_t{j + 1}"] = z[:, 2 * n + j]
    for at, mark in enumerate(marks):
        found[f"tau_h{mark}"] = z[:, loop.tau_h + at]
    found |= {"dw": np.array([loop.slip(one) for one in z])}
    if loop.drive.closed:
        found |= {"asked": sums[:, 0], "integral": sums[:, 1]}
        if loop.drive.control == "yaw_rate":
            found["omega_ref"] = z[:, loop.ref]
    return found

"""Exact reference solution of the active limited slip differential (ALSD) of Fig. 11.

Source: Deur, Hancock, Assadian, "Modeling of Active Differential Dynamics", IMECE2008-69248.
It stands alone, written from the equations only; no code is shared with the package it checks.

Equations, with a = i^2 I_i / 4, omega_f = (omega_1 - omega_2) / 2 and j = 1, 2:

* differential, Eqs. (13), (14) and Appendix B, with the halfshafts joined as in (15), (16):
  (I_1 + a) omega_1' + a omega_2' = i tau_e / 2 - tau_f / 2 - tau_k1,
  a omega_1' + (I_2 + a) omega_2' = i tau_e / 2 + tau_f / 2 - tau_k2;
* undamped halfshafts and wheels, Eqs. (12), (16):
  tau_kj' = k (omega_j - omega_tj),  I_w omega_tj' = tau_kj - tau_tj;
* tyres, Eqs. (18), (19), each linearised about its own start speed omega_0j, where it carries
  no torque: tau_tj = (k_t r / omega_0j) (omega_tj - omega_0j);
* Coulomb clutch, Eq. (17) with T_S = T_C: tau_f = tau_h sign(omega_f) while it slips;
* engine and hydraulic torques: first-order lags of the stepped demands.

While the clutch sticks, omega_1' = omega_2' = omega'. The sum and the difference of the first
two equations then give
  omega' = (i tau_e - tau_k1 - tau_k2) / (I_1 + I_2 + 4 a),
  tau_f = tau_k2 - tau_k1 - (I_1 - I_2) omega',
and the clutch holds while |tau_f| <= tau_h.

Method: with both lagged torques and the constant 1 appended to the state, each mode is linear
and time-invariant, z' = M z, so z(t + h) = expm(M h) z(t) without discretisation error. A grid
of 0.01 ms shows where a mode's condition fails; a root of the exponential gives the instant.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm
from scipy.optimize import brentq

Array = npt.NDArray[np.float64]

SAMPLES, STEP = 1001, 1e-3  # every 1 ms
W_1, W_2, K_1, K_2, T_1, T_2, TAU_E, TAU_H, ONE = range(9)
TOLERANCE = {-1: 1e-11, 0: 1e-9, 1: 1e-11}  # rad/s (slip), N m (stick): rounding, not violation


@dataclass(frozen=True)
class Parameters:
    """Physical values (SI). Steps of the demands fall on whole milliseconds."""

    i: float = 2.8
    I_i: float = 0.1604  # including the case: I_i*
    I_1: float = 0.008
    I_2: float = 0.008
    I_w: float = 0.8
    k: float = 8600.0
    k_t: float = 200000.0
    r: float = 0.3
    lag: float = 0.04
    omega_0: float = 80.0  # start speed of side 1
    dw0: float = -2.0  # start speed of side 1 minus that of side 2
    tau_e: float = 350.0  # demands
    tau_h: float = 1000.0
    time_e: float = 0.1  # instants of the demand steps
    time_h: float = 0.5


@dataclass(frozen=True)
class Reference:
    """Response sampled every 1 ms; states: omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2.

    Events are (time, kind), kind being "stick", "slip" or "cross" (slip changes sign).
    """

    time: Array
    states: Array
    tau_f: Array
    tau_e: Array
    tau_h: Array
    omega_f: Array
    events: tuple[tuple[float, str], ...]


class System:
    """The clutch modes -1, 0 (stick), +1 as linear systems over z = (states, torques, 1)."""

    def __init__(self, parameters: Parameters, substeps: int = 100) -> None:
        p = parameters
        self.p, self.substeps = p, substeps
        unit = np.eye(9)
        inertia = p.I_1 + p.I_2 + p.i**2 * p.I_i
        self.stuck_rate = (p.i * unit[TAU_E] - unit[K_1] - unit[K_2]) / inertia
        self.hold = unit[K_2] - unit[K_1] - (p.I_1 - p.I_2) * self.stuck_rate
        self._flows: dict[tuple[int, bool, bool], tuple[Array, Array]] = {}

    def start(self) -> Array:
        """Return the equilibrium before any torque is applied."""
        first, second = self.p.omega_0, self.p.omega_0 - self.p.dw0
        return np.array([first, second, 0.0, 0.0, first, second, 0.0, 0.0, 1.0])

    def shaft_rates(self, mode: int) -> Array:
        """Return the two rows giving omega_1' and omega_2'."""
        p = self.p
        if mode == 0:
            return np.stack([self.stuck_rate, self.stuck_rate])
        a, unit = p.i**2 * p.I_i / 4, np.eye(9)
        engine, clutch = p.i / 2 * unit[TAU_E], mode / 2 * unit[TAU_H]
        torques = np.stack([engine - clutch - unit[K_1], engine + clutch - unit[K_2]])
        inverse = np.array([[p.I_2 + a, -a], [-a, p.I_1 + a]])
        determinant = p.I_1 * p.I_2 + a * (p.I_1 + p.I_2)
        return np.array(inverse @ torques / determinant)

    def matrix(self, mode: int, engine_on: bool, clutch_on: bool) -> Array:
        """Return M of z' = M z."""
        p, starts, m = self.p, self.start(), np.zeros((9, 9))
        m[[W_1, W_2]] = self.shaft_rates(mode)
        for shaft, spring, wheel in ((W_1, K_1, T_1), (W_2, K_2, T_2)):
            m[spring, [shaft, wheel]] = p.k, -p.k
            slope = p.k_t * p.r / starts[wheel]
            m[wheel, [spring, wheel, ONE]] = 1.0, -slope, slope * starts[wheel]
            m[wheel] /= p.I_w
        m[TAU_E, [TAU_E, ONE]] = -1 / p.lag, engine_on * p.tau_e / p.lag
        m[TAU_H, [TAU_H, ONE]] = -1 / p.lag, clutch_on * p.tau_h / p.lag
        return m

    def stack(self, matrix: Array, length: float) -> Array:
        """Return the exponentials on the sub-grid of a step of the given length."""
        grid = np.arange(self.substeps + 1) * (length / self.substeps)
        return np.array(expm(grid[:, None, None] * matrix))

    def flow(self, mode: int, demands: tuple[bool, bool]) -> tuple[Array, Array]:
        """Return M and its stack over a whole sample step."""
        if (key := (mode, *demands)) not in self._flows:
            matrix = self.matrix(*key)
            self._flows[key] = matrix, self.stack(matrix, STEP)
        return self._flows[key]

    def guard(self, mode: int, z: Array) -> Array:
        """Return what must stay positive for the mode to last (z: one state or one per row)."""
        if mode == 0:
            return np.array(z[..., TAU_H] - np.abs(z @ self.hold))
        return np.array(mode * (z[..., W_1] - z[..., W_2]) / 2)

    def switch(self, mode: int, z: Array, after: Array) -> int:
        """Return the mode that follows; after is a state past the end of the present one."""
        if mode and self.guard(0, z) >= 0:
            return 0
        return 1 if (z if mode else after) @ self.hold > 0 else -1

    def advance(
        self, z: Array, mode: int, demands: tuple[bool, bool]
    ) -> tuple[Array, int, list[tuple[float, str]]]:
        """Carry z over one sample step; event times count from the start of the step."""
        events: list[tuple[float, str]] = []
        done = 0.0
        matrix, stack = self.flow(mode, demands)
        for _ in range(100):
            path = stack @ z
            values = self.guard(mode, path)
            beyond = np.flatnonzero(values[1:] < -TOLERANCE[mode])
            if beyond.size == 0:
                return path[-1], mode, events
            first, width = int(beyond[0]), (STEP - done) / self.substeps
            root = self.root(mode, matrix, path[first], width) if values[first] > 0 else 0.0
            z = expm(matrix * root) @ path[first]
            z[[W_1, W_2]] = (z[W_1] + z[W_2]) / 2  # equal but for rounding
            done += first * width + root
            old, mode = mode, self.switch(mode, z, path[first + 1])
            if mode != old:
                events.append((done, "stick" if mode == 0 else "cross" if old else "slip"))
            matrix = self.matrix(mode, *demands)
            stack = self.stack(matrix, STEP - done)
        raise RuntimeError("the clutch keeps changing mode without end")

    def root(self, mode: int, matrix: Array, z: Array, width: float) -> float:
        """Return the delay, within width, after which the mode starting at z ends."""

        def margin(delay: float) -> float:
            return float(self.guard(mode, expm(matrix * delay) @ z))

        return float(brentq(margin, 0.0, width, xtol=1e-16))


def fig11(**overrides: float) -> Reference:
    """Return the response of Fig. 11; overrides replace fields of Parameters by name."""
    p = Parameters(**overrides)
    system = System(p)
    engine, clutch = round(p.time_e / STEP), round(p.time_h / STEP)
    if max(abs(engine * STEP - p.time_e), abs(clutch * STEP - p.time_h)) > 1e-9:
        raise ValueError("time_e and time_h must be whole milliseconds")
    mode = int(np.sign(p.dw0))
    z = np.zeros((SAMPLES, 9))
    z[0] = system.start()
    tau_f = np.zeros(SAMPLES)
    events: list[tuple[float, str]] = []
    for n in range(SAMPLES - 1):
        z[n + 1], mode, found = system.advance(z[n], mode, (n >= engine, n >= clutch))
        events += [(n * STEP + delay, kind) for delay, kind in found]
        tau_f[n + 1] = mode * z[n + 1, TAU_H] if mode else z[n + 1] @ system.hold
    time = np.linspace(0.0, (SAMPLES - 1) * STEP, SAMPLES)
    slip = (z[:, W_1] - z[:, W_2]) / 2
    return Reference(time, z[:, :6], tau_f, z[:, TAU_E], z[:, TAU_H], slip, tuple(events))

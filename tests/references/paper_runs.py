"""Exact runs of the paper's full models through stick and slip, for checking.

Source: Deur, Hancock, Assadian, "Modeling of Active Differential Dynamics", IMECE2008-69248.
It stands alone, written from the equations only; no code is shared with the package it checks.

Coulomb clutches, Eq. (17) with T_S = T_C: one that slips carries tau_h sign(slip), one that
sticks whatever keeps its slip at zero, |tau| <= tau_h. Engine and hydraulic torques follow their
stepped demands through first-order lags.

Method: over z = (states - start, tau_e, tau_h of each clutch, 1) each mode in {-1, 0, 1}^clutches
is linear, z' = M z, so that z(t + h) = expm(M h) z(t) without discretisation error. What must
stay positive for a mode to last, its guards, are linear in z too. A grid of 1/32 ms shows their
signs and, by their slopes, dips in between; brentq finds the instant. Then, and at each step of
a demand, the modes of all clutches without slip are chosen anew from all their combinations.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from references.paper_models import Array, FullModel, Parameters, full_model, in_mode, outputs_of

Mode = tuple[int, ...]

STEP, SUBSTEPS = 1e-3, 32
WIDTH = STEP / SUBSTEPS
SLIP_NOISE, TORQUE_NOISE = 1e-11, 1e-9  # rad/s, N m: rounding in a guard, not violation
AT_REST = 1e-8  # rad/s: slip of a clutch that may stick
LOOKS = ((0.0, 1e-6), (1e-7, 1e-8), (1e-6, 1e-8), (1e-5, 1e-8), (1e-4, 1e-8), (1e-3, 1e-9))
"""Delays (s) at which a mode is judged in turn, and margins (N m) up to which it is undecided."""


@dataclass(frozen=True)
class Reference:
    """Response every 1 ms: (samples), (samples x states) or (samples x clutches).

    Events are (time, clutch from 1, "stick" | "slip" | "cross"); "cross": the slip changes sign.
    The mode at time 0 is no event. At the instant of an event the values just after it hold.
    """

    time: Array
    states: Array
    tau_f: Array
    omega_f: Array
    tau_e: Array
    tau_h: Array
    events: tuple[tuple[float, int, str], ...]


class Flow(NamedTuple):
    """One mode with constant demands: z' = matrix z."""

    matrix: Array
    stack: Array  # its exponentials on the grid of 1 ms
    clutch: Array  # rows: clutch torques
    pull: Array  # rows: slip accelerations, over what 1 N m of the same clutch does to them
    guards: Array  # rows: what must stay positive
    noise: Array  # of the guards


class Segment(NamedTuple):
    """A stretch in one mode; states hold z every 1 ms from begin, the last at or past end."""

    begin: float
    end: float
    mode: Mode
    flow: Flow
    states: Array


class Scenario:
    """The modes of one model under given demands (tau_e, tau_h of each clutch)."""

    def __init__(self, model: FullModel, demands: Sequence[float], lag: float) -> None:
        self.model, self.demands, self.lag = model, np.array(demands, dtype=float), lag
        self.size, self.clutches = len(model.start), len(demands) - 1
        if model.F.shape[0] != self.clutches or (self.demands[1:] < 0).any():
            raise ValueError(f"needs {model.F.shape[0]} clutch torques >= 0, not {demands[1:]}")
        self.slip = in_mode(model, [1] * self.clutches).slips
        self.push = np.linalg.solve(model.A, model.B[:, 1:])  # states' rates by clutch torques
        self.brake = -model.F @ self.push  # slip decelerations by clutch torques
        self._flows: dict[tuple[Mode, bool, bool], Flow] = {}

    def flow(self, mode: Mode, on: tuple[bool, bool]) -> Flow:
        """Return a mode; on: whether the engine's and the clutches' demands have stepped."""
        if (key := (mode, *on)) in self._flows:
            return self._flows[key]
        rows, n, unit = in_mode(self.model, mode), self.size, np.eye(self.slip.shape[1])
        matrix = np.zeros_like(unit)
        matrix[:n] = rows.rates
        matrix[n:-1, n:-1] = -np.eye(1 + self.clutches) / self.lag
        matrix[n:-1, -1] = self.demands * [on[0], *[on[1]] * self.clutches] / self.lag
        pull = self.model.F @ rows.rates / np.diag(self.brake)[:, None]
        moving, stuck = np.flatnonzero(mode), np.flatnonzero(np.array(mode) == 0)
        sliding = np.array(mode, dtype=float)[moving, None] * self.slip[moving]
        tau_h, hold = unit[n + 1 : -1][stuck], rows.torques[stuck]
        guards = np.vstack([sliding, tau_h - hold, tau_h + hold])
        noise = np.repeat([SLIP_NOISE, TORQUE_NOISE], [len(moving), 2 * len(stuck)])
        stack, small = [unit], expm(matrix * WIDTH)
        for _ in range(SUBSTEPS):
            stack.append(small @ stack[-1])
        self._flows[key] = Flow(matrix, np.array(stack), rows.torques, pull, guards, noise)
        return self._flows[key]

    def margins(self, mode: Mode, flow: Flow, z: Array) -> Array:
        """Return by how much (N m) each clutch, taken to be without slip, keeps to its mode."""
        holds = z[self.size + 1 : -1] - np.abs(flow.clutch @ z)
        return np.where(np.array(mode) == 0, holds, mode * (flow.pull @ z))

    def lasts(self, mode: Mode, flow: Flow, z: Array, resting: list[int]) -> bool:
        """Tell whether the resting clutches keep to their modes from z on."""
        for delay, tolerance in LOOKS:
            margins = self.margins(mode, flow, expm(flow.matrix * delay) @ z if delay else z)
            if any(margins[c] < -tolerance for c in resting):
                return False
            resting = [c for c in resting if margins[c] <= tolerance]
            if not resting:
                break
        return True

    def decide(self, z: Array, old: Mode | None, on: tuple[bool, bool]) -> tuple[Mode, Array]:
        """Return the mode from z on, and z with the slips at rest exactly zero."""
        slips, z = self.slip @ z, z.copy()
        choices: list[tuple[int, ...]] = [(int(np.sign(slip)),) for slip in slips]
        resting = [c for c, s in enumerate(slips) if abs(s) <= AT_REST or (old and old[c] == 0)]
        for c in resting:
            choices[c] = (0, 1, -1) if on[1] and self.demands[1 + c] > 0 else (1, -1)
        own = self.brake[np.ix_(resting, resting)]
        z[: self.size] += self.push[:, resting] @ np.linalg.solve(own, slips[resting])
        modes = sorted(product(*choices), key=np.count_nonzero)
        for mode in modes:
            if self.lasts(mode, self.flow(mode, on), z, resting):
                return mode, z
        tried = {mode: self.margins(mode, self.flow(mode, on), z) for mode in modes}
        raise RuntimeError(f"no consistent mode: slips {slips}, margins {tried}, z {z}")


def root(flow: Flow, guard: int, z: Array) -> float | None:
    """Return the delay within a substep from z after which a guard turns negative, if it does."""
    row, noise = flow.guards[guard], flow.noise[guard]

    def value(delay: float) -> float:
        return float(row @ expm(flow.matrix * delay) @ z)

    def slope(delay: float) -> float:
        return float(row @ flow.matrix @ expm(flow.matrix * delay) @ z)

    first, last, start = value(0.0), value(WIDTH), slope(0.0)
    if first > noise and last < 0:
        return float(brentq(value, 0.0, WIDTH, xtol=1e-16))
    if start * slope(WIDTH) >= 0:
        return 0.0 if last < -noise else None
    turn = float(brentq(slope, 0.0, WIDTH, xtol=1e-16))
    if start > 0:  # from zero up, and down again
        falls = last < -noise and value(turn) > 0
        return float(brentq(value, turn, WIDTH, xtol=1e-16)) if falls else None
    if value(turn) >= -noise:
        return None
    return float(brentq(value, 0.0, turn, xtol=1e-16)) if first > 0 else 0.0  # a dip


def first_event(flow: Flow, path: Array) -> tuple[int, float] | None:
    """Return the substep and the delay in it at which a guard first fails along a path."""
    values, slopes = path @ flow.guards.T, path @ (flow.guards @ flow.matrix).T
    low, high = values[:-1], values[1:]
    reach = np.maximum(np.abs(slopes[:-1]), np.abs(slopes[1:])) * WIDTH
    dips = (slopes[:-1] < 0) & (slopes[1:] > 0) & (np.minimum(low, high) < reach)
    suspects = ((low > flow.noise) & (high < 0)) | (high < -flow.noise) | dips
    for sub in np.flatnonzero(suspects.any(axis=1)):
        roots = [root(flow, int(g), path[sub]) for g in np.flatnonzero(suspects[sub])]
        if found := [r for r in roots if r is not None]:
            return int(sub), min(found)
    return None


def march(flow: Flow, z: Array, length: float) -> tuple[float | None, Array, Array]:
    """Return when within length the mode ends (None: it lasts), z then, and z every 1 ms."""
    states, done = [z], 0
    while True:
        rest, path = length - done * STEP, flow.stack @ z
        states.append(path[-1])
        if event := first_event(flow, path):
            sub, delay = event
            if sub * WIDTH + delay <= rest:
                end = expm(flow.matrix * delay) @ path[sub]
                return done * STEP + sub * WIDTH + delay, end, np.array(states)
        if rest <= STEP:
            return None, expm(flow.matrix * rest) @ z, np.array(states)
        z, done = path[-1], done + 1


def trace(scenario: Scenario, steps: tuple[float, float], duration: float) -> list[Segment]:
    """Return the stretches of constant mode and demands from the start on."""
    z = np.append(np.zeros(scenario.slip.shape[1] - 1), 1.0)
    time, mode, segments = 0.0, None, list[Segment]()
    while time < duration:
        on = (time >= steps[0], time >= steps[1])
        mode, z = scenario.decide(z, mode, on)
        until = min(t for t in (*steps, duration) if t > time)
        flow = scenario.flow(mode, on)
        delay, z, states = march(flow, z, until - time)
        end = until if delay is None else time + delay
        segments.append(Segment(time, end, mode, flow, states))
        if len(segments) > 10000:
            raise RuntimeError(f"the mode keeps changing at {time} s: {mode}, z {z}")
        time = end
    return segments


def changes(segments: list[Segment], steps: tuple[float, float]) -> list[tuple[float, int, str]]:
    """Return the events; a slip at rest that turns with a demand's step has not crossed."""
    events = []
    for before, after in pairwise(segments):
        for clutch, (old, new) in enumerate(zip(before.mode, after.mode, strict=True), start=1):
            kind = "stick" if new == 0 else "cross" if old else "slip"
            if old != new and not (kind == "cross" and after.begin in steps):
                events.append((after.begin, clutch, kind))
    return events


def run(
    name: str, parameters: Parameters, wheel_speed: float, speed_difference: float,
    engine_torque: float, clutch_torques: Sequence[float],
    engine_step: float, clutch_step: float, duration: float, lag: float = 0.04,
) -> Reference:  # fmt: skip
    """Return the response of a model; parameters go over the printed ones (paper_models)."""
    steps = (engine_step, clutch_step)
    if min(steps) < 0 or duration <= 0:
        raise ValueError(f"steps {steps} before the start, or no duration: {duration}")
    others = [wheel_speed - speed_difference] * (outputs_of(name) - 1)
    model = full_model(name, parameters, [wheel_speed, *others])
    scenario = Scenario(model, [engine_torque, *clutch_torques], lag)
    segments = trace(scenario, steps, duration)
    time = np.arange(int(duration / STEP + 1e-9) + 1, dtype=np.float64) * STEP
    owner = np.searchsorted([s.begin for s in segments], time, side="right") - 1
    z = np.zeros((len(time), scenario.slip.shape[1]))
    tau_f = z @ scenario.slip.T
    for number, (begin, _, _, flow, states) in enumerate(segments):
        if (inside := np.flatnonzero(owner == number)).size:
            z[inside] = states[: inside.size] @ expm(flow.matrix * (time[inside[0]] - begin)).T
            tau_f[inside] = z[inside] @ flow.clutch.T
    n, events = scenario.size, tuple(changes(segments, steps))
    states, omega_f = z[:, :n] + model.start, z @ scenario.slip.T
    return Reference(time, states, tau_f, omega_f, z[:, n], z[:, n + 1 : -1], events)

"""A clutch that an agent presses: a stepper as an environment of gymnasium.

An engine with a constant torque is to be coupled to a load at rest. The agent tells the torque that the
clutch may take, anew every 20 ms. It is paid for a small slip, and pays for jerks of the load. The clutch
sticks where it can: its slip then is zero, not small.
"""

from typing import Any

import gymnasium
import numpy as np

import bondgraph as bg
from codegen import Stepper, simulator

STEP = 0.02
"""So long [s] an action holds."""

LEVEL = 60.0
"""What the clutch may take at the most [N m]."""

NUMBERS = {"J_e": 0.2, "J_l": 0.8, "b": 0.1}
"""Inertias of engine and load [kg m^2], and what the load loses [N m s/rad]."""

ENGINE, SPEED = 10.0, 100.0
"""The engine's torque [N m], and its speed at first [rad/s]."""


def driveline() -> bg.StateEquations:
    """Engine and load with a clutch between, whose level is an input."""
    return bg.derive(
        bg.graph(
            [
                bg.Se("engine", "T"), bg.One("shaft"), bg.I("J_e", "J_e", flow="w_e"),
                bg.Zero("gap"), bg.R("clutch", law=bg.DryFriction("L"), effort="tau", flow="slip"),
                bg.One("wheel"), bg.I("J_l", "J_l", flow="w_l"), bg.R("loss", "b"),
            ],
            "engine > shaft > J_e", "shaft > gap > clutch", "gap > wheel > J_l", "wheel > loss",
        )
    )  # fmt: skip


class ClutchEnvironment(gymnasium.Env):
    """Observed are both speeds [rad/s] and the clutch's torque [N m]; an action is its level, 0 to 1."""

    observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (3,), np.float64)
    action_space = gymnasium.spaces.Box(0.0, 1.0, (1,), np.float64)

    def __init__(self, backend: str = "numpy", longest: float = 2.0) -> None:
        ready = simulator(driveline(), NUMBERS, backend=backend)
        self._stepper: Stepper = ready.stepper({"w_e": SPEED}, {"T": ENGINE, "L": 0.0})
        self._begin, self._longest, self._torque = self._stepper.state, longest, 0.0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """The engine turns, the load rests."""
        super().reset(seed=seed)
        self._stepper.restore(self._begin)
        self._torque = 0.0
        return self._seen(), {}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Hold a level for `STEP`; done once the clutch sticks, cut off after `longest`."""
        now = self._stepper.advance(STEP, L=LEVEL * float(np.clip(action, 0.0, 1.0)[0]))
        events = self._stepper.events
        stuck = now["slip"] == 0.0
        jerk = (now["tau"] - self._torque) / LEVEL
        self._torque = now["tau"]
        paid = -STEP * abs(now["slip"]) / SPEED - 0.1 * jerk**2 + (1.0 if stuck else 0.0)
        late = self._stepper.time >= self._longest
        return self._seen(), paid, stuck, late and not stuck, {"events": events}

    def _seen(self) -> np.ndarray:
        now = self._stepper.signals
        return np.array([now["w_e"], now["w_l"], now["tau"]])


def episode(environment: ClutchEnvironment, level: float) -> tuple[float, float]:
    """What a constant level is paid, and when [s] it ends."""
    environment.reset()
    total, steps, over = 0.0, 0, False
    while not over:
        _, paid, done, cut, _ = environment.step(np.array([level]))
        total, steps, over = total + paid, steps + 1, done or cut
    return total, steps * STEP


if __name__ == "__main__":
    made = ClutchEnvironment()
    for part in (0.1, 0.3, 0.5, 1.0):
        reward, time = episode(made, part)
        print(f"{LEVEL * part:5.1f} N m: paid {reward:7.3f} in {time:.2f} s")

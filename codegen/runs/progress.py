"""Whether an integrator still advances, told by its work: steps far shorter than anything in the model
asks for, in front of rates that jump. ``located_progress.c`` decides the same way with the same numbers."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bondgraph.errors import SimulationError
from codegen.modes.pace import longest_step
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

Rates = Callable[[float, Array], Array]


@dataclass
class Progress:
    """Counts the steps of a stretch; ``origin`` [s]: where the run began; ``driven`` [1/s]: the fastest
    rate of its inputs."""

    rates: Rates
    origin: float
    driven: float
    rtol: float
    atol: float
    begin: float
    steps: int = 0
    idle: bool = False

    def check(self, t: float, s: Array) -> None:
        """Take a step that ended here into account.

        Raises `SimulationError` where two lots of `TUNING.lot` steps in a row went nowhere, at a jump.
        """
        self.steps += 1
        if self.steps % TUNING.lot:
            return
        mean, self.begin = (t - self.begin) / TUNING.lot, t
        part = mean / longest_step(t - self.origin)
        if part < TUNING.short:
            part = max(part, mean * self._fastest(t, s))
        idle = part < TUNING.short
        if idle and self.idle and self._jumps(mean, t, s, slides=part >= TUNING.shorter):
            raise no_progress(t)
        self.idle = idle

    def _fastest(self, t: float, s: Array) -> float:
        """The largest rate [1/s] of the model and its inputs at s, a jump beside it left aside."""
        base, past = self.rates(t, s), longest_step(t - self.origin)
        ahead, behind = (
            np.column_stack([
                difference(self.rates, t, s, j, base, side * past) for j in range(len(s))
            ])
            for side in (1.0, -1.0)
        )  # fmt: skip
        calm = np.where(np.abs(ahead) < np.abs(behind), ahead, behind)
        return max(float(np.abs(np.linalg.eigvals(calm)).max(initial=0.0)), self.driven)

    def _jumps(self, mean: float, t: float, s: Array, slides: bool) -> bool:
        """Whether the rates jump just ahead, along their own direction; ``slides``: and push back beyond."""
        reach = TUNING.reach * mean
        base = self.rates(t, s)
        size = reach / (self.atol + self.rtol * np.abs(s))

        def changed(one: Array, other: Array) -> float:
            return float(np.nan_to_num(np.abs(one - other) * size).max(initial=0.0))

        def ahead(part: float) -> Array:
            return self.rates(t + part * reach, s + part * reach * base)

        low, high, at_low, at_high = 0.0, 1.0, base, ahead(1.0)
        first = changed(at_low, at_high)
        for _ in range(TUNING.halves):
            middle = 0.5 * (low + high)
            at_middle = ahead(middle)
            if changed(at_low, at_middle) > changed(at_middle, at_high):
                high, at_high = middle, at_middle
            else:
                low, at_low = middle, at_middle
        if not changed(at_low, at_high) > max(TUNING.whole * first, TUNING.felt):
            return False
        beyond = self.rates(
            t + (high + TUNING.back) * reach, s + reach * (high * base + TUNING.back * at_high)
        )
        return not slides or changed(beyond, at_low) < changed(beyond, at_high)


def no_progress(t: float, what: str = "jump there") -> SimulationError:
    """The refusal of a run whose integrator goes nowhere; ``what`` the rates do."""
    return SimulationError(
        f"at t = {t:.9g} the integrator no longer advances: the rates {what}; friction that changes sign "
        "is a DryFriction, a switch a step of an input"
    )


def difference(rates: Rates, t: float, s: Array, j: int, base: Array, past: float) -> Array:
    """How the rates change with one component, by a difference that stays where laws have values.

    ``past`` [s]: a part of what went before; below zero the difference is taken downwards.
    """
    step = np.copysign(
        TUNING.slope * abs(s[j]) + TUNING.slope_floor * abs(base[j] * past) + TUNING.slope_floor,
        past,
    )
    for _ in range(12):
        moved = s.copy()
        moved[j] += step
        slope = (rates(t, moved) - base) / step
        if np.isfinite(slope).all():
            return np.asarray(slope, dtype=float)
        step *= TUNING.slope_shorter
    raise SimulationError(f"at t = {t:g} the rates are not finite beside the state {s.tolist()}")

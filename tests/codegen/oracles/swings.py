"""Swings through a jump of second order by hand: parabolas from one height to the next."""

from dataclasses import dataclass

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class Swings:
    """``x'' = -a sign(x) - b sign(x')`` from x = 1 at rest: each height is (a - b)/(a + b) of the last."""

    a: float
    b: float

    @property
    def shrinks(self) -> float:
        return (self.a - self.b) / (self.a + self.b)

    @property
    def first(self) -> float:
        """The time [s] from the first height to the second."""
        out, back = self.a + self.b, self.a - self.b
        return float(np.sqrt(2 / back) + np.sqrt(2 * back) / out)

    @property
    def rests(self) -> float:
        """When all swings are over: times shrink by the root of what heights do."""
        return self.first / (1 - np.sqrt(self.shrinks))

    def at(self, times: Array) -> Array:
        """x at these times [s]."""
        return np.array([self._at(float(t)) for t in times])

    def _at(self, t: float) -> float:
        out, back = self.a + self.b, self.a - self.b
        top, side, long = 1.0, 1.0, self.first
        while t > long and top > 1e-20:
            t, top, side, long = t - long, top * self.shrinks, -side, long * np.sqrt(self.shrinks)
        if top <= 1e-20:
            return 0.0
        fall = np.sqrt(2 * top / back)
        if t <= fall:
            return side * (top - back * t**2 / 2)
        return -side * (top * self.shrinks - out * (long - t) ** 2 / 2)

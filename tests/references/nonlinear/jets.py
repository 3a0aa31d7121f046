"""Numbers with their slopes and second slopes along a few names: what differentiates the judge's laws."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

Array = np.ndarray
Three = tuple[float, float, float]


class Jet:
    """A value, its slopes ``g`` and its second slopes ``H`` along the names of one law."""

    __array_priority__ = 100
    __slots__ = ("H", "g", "v")

    def __init__(self, v: float, g: Array, H: Array) -> None:
        self.v, self.g, self.H = v, g, H

    def through(self, value: float, first: float, second: float) -> Jet:
        """A function of it, by the function's value and slopes."""
        return Jet(
            value, first * self.g, first * self.H + second * np.outer(self.g, self.g)
        )  # fmt: skip

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.v + other.v, self.g + other.g, self.H + other.H)
        return Jet(self.v + other, self.g, self.H)

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet(-self.v, -self.g, -self.H)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-other)

    def __rsub__(self, other: float) -> Jet:
        return -self + other

    def __mul__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.v * other, self.g * other, self.H * other)
        cross = np.outer(self.g, other.g)
        return Jet(
            self.v * other.v, self.v * other.g + other.v * self.g,
            self.v * other.H + other.v * self.H + cross + cross.T,
        )  # fmt: skip

    __rmul__ = __mul__

    def __truediv__(self, other: Jet | float) -> Jet:
        return self * (1 / other)

    def __rtruediv__(self, other: float) -> Jet:
        return self.through(other / self.v, -other / self.v**2, 2 * other / self.v**3)

    def __pow__(self, n: float) -> Jet:
        v = self.v
        first = n * v ** (n - 1) if n else 0.0
        second = n * (n - 1) * v ** (n - 2) if n not in (0, 1) and (v or n >= 2) else 0.0
        return self.through(v**n, first, second)

    def __lt__(self, other: Jet | float) -> bool:
        return self.v < value(other)

    def __gt__(self, other: Jet | float) -> bool:
        return self.v > value(other)

    def __le__(self, other: Jet | float) -> bool:
        return self.v <= value(other)

    def __ge__(self, other: Jet | float) -> bool:
        return self.v >= value(other)


def value(number: Jet | float) -> float:
    """The number alone."""
    return number.v if isinstance(number, Jet) else number


def function(three: Callable[[float], Three]) -> Callable[[Jet | float], Jet | float]:
    """What text calls, by a function's value and two slopes at a number."""

    def called(x: Jet | float) -> Jet | float:
        return x.through(*three(x.v)) if isinstance(x, Jet) else three(x)[0]

    return called


def _tanh(x: float) -> Three:
    y = math.tanh(x)
    return y, 1 - y * y, -2 * y * (1 - y * y)


def _root(x: float) -> Three:
    y = math.sqrt(x)
    return (y, 0.5 / y, -0.25 / y**3) if y else (0.0, math.inf, -math.inf)


def _sign(x: float) -> float:
    return float((x > 0) - (x < 0))


def _pieces(*pairs: tuple[Jet | float, bool]) -> Jet | float:
    return next(one for one, holds in pairs if holds)


FUNCTIONS: dict[str, Callable[..., Jet | float]] = {
    "sin": function(lambda x: (math.sin(x), math.cos(x), -math.sin(x))),
    "cos": function(lambda x: (math.cos(x), -math.sin(x), -math.cos(x))),
    "exp": function(lambda x: (math.exp(x), math.exp(x), math.exp(x))),
    "log": function(lambda x: (math.log(x), 1 / x, -1 / x**2)),
    "sinh": function(lambda x: (math.sinh(x), math.cosh(x), math.sinh(x))),
    "cosh": function(lambda x: (math.cosh(x), math.sinh(x), math.cosh(x))),
    "tanh": function(_tanh),
    "atan": function(lambda x: (math.atan(x), 1 / (1 + x * x), -2 * x / (1 + x * x) ** 2)),
    "sqrt": function(_root),
    "abs": function(lambda x: (abs(x), _sign(x), 0.0)),
    "sign": function(lambda x: (_sign(x), 0.0, 0.0)),
    "min": lambda *all: min(all, key=value),
    "max": lambda *all: max(all, key=value),
    "hypot": lambda a, b: FUNCTIONS["sqrt"](a * a + b * b),
    "log10": lambda x: FUNCTIONS["log"](x) * (1 / math.log(10)),
    "Piecewise": _pieces,
}
"""The functions that text may call."""

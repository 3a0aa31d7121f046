"""Generated functions as formulas of an instant."""

import math
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.matrices import Numbers, solved

Block = Callable[[Mapping[str, float], Any], Any]
"""A generated function of parameters and of what it reads, by the letters of an instant."""

PARTS = ("x", "z", "y", "u", "w", "dw")


def log_of(value: float) -> float:
    """The natural logarithm, infinite at zero as that of arrays is.

    >>> log_of(1.0), log_of(0.0)
    (0.0, -inf)
    """
    return math.log(value) if value else -math.inf


class Plain:
    """What formulas read, as plain numbers: quicker, and an error where they have no value.

    A part of an instant is one of it when it is first read; most formulas read one or two.
    """

    def __init__(self, now: Instant) -> None:
        self.t, self._now = float(now.t), now

    def __getattr__(self, part: str) -> list[float]:
        found: list[float] = getattr(self._now, part).tolist()
        setattr(self, part, found)
        return found


class BlockFormula(Formula):
    """What a generated function gives: so many numbers; nan where it has no value."""

    def __init__(self, block: Block, parameters: Mapping[str, float], count: int) -> None:
        super().__init__(np.array([*parameters.values()]))
        self.block, self.parameters, self.count = block, parameters, count

    def __call__(self, now: Instant) -> Array:
        """What it gives at an instant."""
        return self._values(self.parameters, Plain(now))

    def of_pool(self, pool: Array, like: Instant) -> Array:
        """What it gives, of a pool laid out like that of an instant."""
        values, parts, begin = pool.tolist(), {}, 1
        for part in PARTS:
            end = begin + len(getattr(like, part))
            parts[part], begin = values[begin:end], end
        told = values[begin : begin + len(self.parameters)]
        parameters = dict(zip(self.parameters, told, strict=True))
        now = SimpleNamespace(t=values[0], **parts)
        return self._values(parameters, now)

    def _values(self, parameters: Mapping[str, float], now: Plain | SimpleNamespace) -> Array:
        try:
            return np.array(self.block(parameters, now), dtype=float).reshape(self.count)
        except (ArithmeticError, TypeError, ValueError):
            return np.full(self.count, np.nan)


def matrix(shape: tuple[int, int], entries: Mapping[tuple[int, int], float]) -> Array:
    """A dense matrix from its nonzero entries by place."""
    result = np.zeros(shape)
    for place, entry in entries.items():
        result[place] = entry
    return result


def matrices(
    coefficients: Block, parameters: Mapping[str, float], varying: bool
) -> Callable[[Instant], Numbers]:
    """The matrices as a function of an instant; found once where they do not vary."""
    if not varying:
        constant = solved(**coefficients(parameters, None))
        return lambda now: constant

    def found(now: Instant) -> Numbers:
        try:
            return solved(**coefficients(parameters, Plain(now)))
        except (ArithmeticError, TypeError, ValueError) as error:
            raise EvaluationError(
                f"at t = {now.t:g} the matrices have no values: {error}"
            ) from None

    return found

"""Where a law that rises, or falls, has a value: Newton's method between two places that hold the answer.

Generated modules hold this text, and C the same in model_search.c: equal steps, equal numbers.
"""

import math
import struct
from collections.abc import Callable, Sequence

Sloped = Callable[[float], Sequence[float]]
"""From a place to a law's value and slope there, then to what is positive in its domain."""

MOST = 200
"""Halving the doubles between two places takes 64 steps, and no two of Newton's go between as many."""

NEWTONS = 8
"""So many of Newton's steps may be as long as they come."""

POWERS = 1000
"""So many powers of two are tried for a place to begin at."""

LEAST = 2.0**-52
"""A relative distance that rounding alone may make."""


OVER = 8.0
"""So many times that far a step goes that is to pass the answer."""


def place_where(law: Sloped, value: float, begin: float = 0.0) -> float:
    """The place where the law has this value; not a number where it has it nowhere.

    The search begins where it is told or, where the law has no value there, at the first power of two that
    it has one at. From there to the end of all numbers, what is outside the law's domain counts as past the
    answer: Newton's steps lead there, and where a step would leave what holds the answer, or after the first
    few is more than a quarter of the last, the doubles in between are halved.

    >>> place_where(lambda x: (x + x**3, 1 + 3*x**2), 10.0)
    2.0
    >>> place_where(lambda x: (math.tanh(x), 1 - math.tanh(x)**2), 2.0)
    nan
    """
    if not math.isfinite(value):
        return math.nan
    near, off, slope = beginning(law, value, begin)
    if not math.isfinite(off):
        return math.nan
    x = near
    below, rises, there = off < 0.0, slope > 0.0, False
    far = math.copysign(math.inf, 1.0 if rises == below else -1.0)
    last = math.inf
    for step in range(MOST):
        if abs(off) <= LEAST * abs(value):
            return x
        move = -off / slope if slope != 0.0 else math.inf
        onto = x + move
        if abs(move) <= LEAST * abs(x):
            if there:
                return onto
            # Close by what holds the answer it has to be shown that the law comes to it.
            onto = x + math.copysign(OVER * LEAST * x, move)
        if not min(near, far) < onto < max(near, far) or (
            step > NEWTONS and 4.0 * abs(move) > last
        ):
            onto = middle(near, far)
            if onto in (near, far):
                return onto if there else math.nan
        x, last = onto, abs(onto - x)
        off, slope = off_at(law, x, value)
        if not math.isnan(off) and (off < 0.0) == below:
            near = x
        else:
            far, there = x, there or not math.isnan(off)
    return math.nan


def beginning(law: Sloped, value: float, begin: float) -> tuple[float, float, float]:
    """A place at which the law has a value, how far it is beyond the one that is sought, and its slope."""
    off, slope = off_at(law, begin, value)
    if not math.isnan(off):
        return begin, off, slope
    for power in range(POWERS):
        for place in (2.0**-power, 2.0**power, -(2.0**-power), -(2.0**power)):
            off, slope = off_at(law, place, value)
            if not math.isnan(off):
                return place, off, slope
    return math.nan, math.nan, math.nan


def off_at(law: Sloped, x: float, value: float) -> tuple[float, float]:
    """How far the law is beyond the value, and its slope; no numbers where it has none."""
    try:
        found, slope, *above = law(x)
        if math.isfinite(found) and all(one > 0.0 for one in above):
            return found - value, slope
    except (ArithmeticError, ValueError, TypeError):
        # What is complex is not to be compared.
        pass
    return math.nan, math.nan


def middle(a: float, b: float) -> float:
    """The double with as many doubles between it and either; one of both where there is none."""
    return from_order(half(order_of(a)) + half(order_of(b)))


def half(order: int) -> int:
    """Of an integer, towards zero."""
    return -(-order // 2) if order < 0 else order // 2


def order_of(x: float) -> int:
    """The number of a double among all, zero having 0."""
    (bits,) = struct.unpack("<q", struct.pack("<d", abs(x)))
    return -int(bits) if x < 0.0 else int(bits)


def from_order(order: int) -> float:
    """The double of this number."""
    (size,) = struct.unpack("<d", struct.pack("<q", abs(order)))
    return -float(size) if order < 0 else float(size)

"""Which rates are stable under a step of Runge's and Kutta's classical method of fourth order.

A rate l is stable under a step h while ``|R(h l)| <= 1``, ``R(z) = 1 + z + z^2/2 + z^3/6 +
z^4/24``: up to ``h l = -2.7853`` on the real axis and ``2.8284i`` on the imaginary one (Hairer
and Wanner, Solving Ordinary Differential Equations II, section IV.2).
"""

import math

from codegen.tuning import TUNING

REAL_LIMIT, IMAGINARY_LIMIT = 2.785293563405282, 2.0 * math.sqrt(2.0)
"""How far the stable part of the negative real axis and of the imaginary one reaches."""

NEAREST, FARTHEST = 2.6156, 2.9603
"""The least and the largest distance of the boundary in the left half plane."""


def stable_step(rate: complex) -> float:
    """The longest stable step [s] for one rate of the linearised model [1/s].

    What grows by itself, at a rate of positive real part, is no fault of the step; it must not turn
    too far.

    >>> round(stable_step(-10), 5), round(stable_step(10j), 5), stable_step(3)
    (0.27853, 0.28284, inf)
    """
    if rate.real >= 0:
        return IMAGINARY_LIMIT / abs(rate.imag) if rate.imag else math.inf
    ray = rate / abs(rate)
    low, high = NEAREST - TUNING.bracket, FARTHEST + TUNING.bracket
    for _ in range(50):
        middle = (low + high) / 2
        z = middle * ray
        if abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) > 1:
            high = middle
        else:
            low = middle
    return low / abs(rate)

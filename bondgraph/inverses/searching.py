"""Where a law that rises, or falls, has a value: Newton's method between two places that hold the answer.

Generated modules hold this text, and C the same in model_search.c: equal steps, equal numbers.
"""

import math
from collections.abc import Callable, Sequence

Sloped = Callable[[float], Sequence[float]]
"""From a place to a law's value and slope there, then to what is positive in its domain."""

MOST = 1200
"""A double is found between any two others by fewer halvings."""

LEAST = 2.0**-52
"""A relative distance that rounding alone may make."""


def searched(law: Sloped, value: float) -> float:
    """The place where the law has this value; not a number where it has it nowhere.

    The search begins at zero or, where the law has no value there, at the first power of two that it has
    one at. It goes on by doubled steps, halved where the law ends, until two places hold the answer; then by
    Newton's steps, halving the distance between these wherever a step would leave them or hardly shorten it.

    >>> searched(lambda x: (x + x**3, 1 + 3*x**2), 10.0)
    2.0
    >>> searched(lambda x: (math.tanh(x), 1 - math.tanh(x)**2), 2.0)
    nan
    """
    near = _begun(law)
    off, slope = _off(law, near, value)
    if off == 0.0 or math.isnan(off):
        return near if off == 0.0 else math.nan
    way = math.copysign(1.0, slope) * math.copysign(1.0, -off)
    step, beyond = abs(off / slope) if slope else math.inf, math.nan
    if not 0.0 < step < math.inf:
        step = 1.0
    for _ in range(MOST):
        far = near + way * step
        if far == near or math.isinf(far):
            return math.nan
        there, slope = _off(law, far, value)
        if math.isnan(there):
            beyond = far
        elif (there > 0.0) != (off > 0.0):
            return _between(law, value, near, far) if there else far
        else:
            near, off, step = far, there, 2.0 * step
        if not math.isnan(beyond):
            step = min(step, 0.5 * abs(beyond - near))
    return math.nan


def _between(law: Sloped, value: float, near: float, far: float) -> float:
    """The answer between a place where the law is not there yet and one where it is past."""
    x, last = far, abs(far - near)
    before = _off(law, near, value)[0] > 0.0
    for _ in range(MOST):
        off, slope = _off(law, x, value)
        if abs(off) <= LEAST * abs(value):
            return x
        if (off > 0.0) == before:
            near = x
        else:
            far = x
        step = -off / slope if slope else math.inf
        x_new = x + step
        if not min(near, far) < x_new < max(near, far) or 2.0 * abs(step) > last:
            x_new = near + 0.5 * (far - near)
            step = x_new - x
        if abs(step) <= LEAST * abs(x_new) or x_new in (near, far):
            return x_new
        x, last = x_new, abs(step)
    return x


def _begun(law: Sloped) -> float:
    """Where the law has a value."""
    if math.isfinite(_off(law, 0.0, 0.0)[0]):
        return 0.0
    for power in range(1000):
        for place in (2.0**-power, 2.0**power, -(2.0**-power), -(2.0**power)):
            if math.isfinite(_off(law, place, 0.0)[0]):
                return place
    return math.nan


def _off(law: Sloped, x: float, value: float) -> tuple[float, float]:
    """How far the law is beyond the value, and its slope; no numbers where it has none."""
    try:
        found, slope, *above = law(x)
        if math.isfinite(found) and all(one > 0.0 for one in above):
            return found - value, slope
    except (ArithmeticError, ValueError, TypeError):
        # What is complex is not to be compared.
        pass
    return math.nan, math.nan

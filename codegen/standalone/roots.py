"""A root of a function between two points of different sign, however flat the function is
there."""

import sys
from collections.abc import Callable

from codegen.tuning import TUNING

EPSILON = sys.float_info.epsilon

SLOW = 3
"""After so many steps in which the interval was not halved, it is."""


def root(f: Callable[[float], float], a: float, b: float) -> float:
    """Where f changes its sign between a and b, to two units in the last place.

    Inverse quadratic interpolation where three points promise it, else halves: T. R. Chandrupatla,
    A new hybrid quadratic/bisection algorithm, Advances in Engineering Software 28 (1997) 145-149.
    Halving is enforced where interpolation crawls, as along a root of many folds: it always ends.
    ``bg_root`` in ``model_roots.c`` takes the same steps. f must not have the same sign at a and b;
    what is no number counts as below zero.

    >>> found = root(lambda x: x**2 - 2, 0.0, 2.0), root(lambda x: (x - 1) ** 9, -1.0, 2.0)
    >>> [round(place, 15) for place in found]
    [1.414213562373095, 1.0]
    """
    at_a, at_b, share, slow = f(a), f(b), 0.5, 0
    if at_a == 0:
        return a
    floor = TUNING.least_interval * abs(b - a) + sys.float_info.min
    while at_b != 0:
        width = abs(b - a)
        t = a + share * (b - a)
        at_t = f(t)
        if (at_t > 0) == (at_a > 0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = t, at_t
        best = a if abs(at_a) <= abs(at_b) else b
        least = (EPSILON * abs(best) + floor) / abs(b - a) if a != b else 1.0
        if at_a == 0 or least > 0.5:
            return best
        slow = slow + 1 if abs(b - a) > 0.5 * width else 0
        share = 0.5 if slow >= SLOW else _share((a, b, c), (at_a, at_b, at_c))
        slow = slow if slow < SLOW else 0
        share = min(max(share, least), 1 - least)
    return b


def _share(x: tuple[float, float, float], y: tuple[float, float, float]) -> float:
    """How far from a to b inverse quadratic interpolation leads, where it surely does; or half."""
    (a, b, c), (at_a, at_b, at_c) = x, y
    if at_c in (at_a, at_b) or at_a == at_b:
        return 0.5
    xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
    if not (phi**2 < xi and (1 - phi) ** 2 < 1 - xi):
        return 0.5
    first = at_a / (at_b - at_a) * at_c / (at_b - at_c)
    return first + (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)

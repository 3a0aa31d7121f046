"""Where a polynomial on the unit interval first falls to zero, decided by Bernstein coefficients."""

from functools import cache
from math import comb

import numpy as np

from codegen.numbers.arrays import Array
from codegen.standalone.roots import root
from codegen.tuning import TUNING


@cache
def to_bernstein(degree: int) -> Array:
    """The matrix that takes coefficients of powers to those of Bernstein polynomials on [0, 1]."""
    rows = [[comb(i, k) / comb(degree, k) if k <= i else 0.0 for k in range(degree + 1)]
            for i in range(degree + 1)]  # fmt: skip
    matrix = np.array(rows)
    matrix.flags.writeable = False
    return matrix


def first_fall(powers: Array, begin: float = 0.0) -> float | None:
    """The least tau in (begin, 1] at which ``sum powers[k] tau^k`` is zero or less, if there is one.

    The polynomial is not below its least Bernstein coefficient, so no root is missed, nor a pair of them.
    A value of zero or less at ``begin`` itself does not count where the polynomial rises from there.

    >>> first_fall(np.array([1.0, -4.0, 3.0])), first_fall(np.array([1.0, -2.0, 1.1]))  # doctest: +ELLIPSIS
    (0.3333333333333..., None)
    """
    pending = [(begin, 1.0)]
    while pending:
        low, high = pending.pop()
        shape = to_bernstein(len(powers) - 1) @ _restricted(powers, low, high)
        if shape.min() > 0:
            continue
        if (np.diff(shape) < 0).all():
            if shape[-1] <= 0:
                return _crossing(powers, low, high)
            continue
        if (np.diff(shape) >= 0).all():
            # It rises all the way: it was not above zero at the left end, where a fall would have ended.
            continue
        if high - low <= TUNING.narrow:
            if shape[-1] <= 0:
                return high
            continue
        middle = 0.5 * (low + high)
        pending += [(middle, high), (low, middle)]
    return None


def value(powers: Array, tau: float) -> float:
    """``sum powers[k] tau^k``."""
    result = 0.0
    for coefficient in powers[::-1].tolist():
        result = result * tau + coefficient
    return result


def _crossing(powers: Array, low: float, high: float) -> float:
    if value(powers, low) <= 0:
        return low
    if value(powers, high) > 0:
        return high
    return root(lambda tau: value(powers, tau), low, high)


def _restricted(powers: Array, low: float, high: float) -> Array:
    """The coefficients over [low, high] brought to [0, 1]: a shift by Horner's scheme, then a scaling."""
    shifted = powers.copy()
    if low:
        for k in range(len(powers) - 1):
            for j in range(len(powers) - 2, k - 1, -1):
                shifted[j] += low * shifted[j + 1]
    return np.asarray(shifted * (high - low) ** np.arange(len(powers)))

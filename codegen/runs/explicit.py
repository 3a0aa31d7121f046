"""Explicit steps of order 8, which after a step that failed take no estimate of its error at its best."""

from functools import cache
from typing import Any

import numpy as np
import scipy

from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


@cache
def explicit() -> Any:
    """scipy's `DOP853`, which is loaded when first asked for, with a second look at steps over corners.

    The method's own estimate is that of order 5, squared, over one of order 3: small where the rates are
    smooth, but by chance as well where they have a corner inside the step, since the estimate of order 5
    is zero for some places of it. Over a corner a step is tried too long and fails, or the estimate
    of order 3 rises at once. The `TUNING.wary` steps from there on are judged by both estimates added,
    which are not zero for the same place. ``located_explicit.c`` does the same.
    """

    class Wary(scipy.integrate.DOP853):
        _doubts, _before = 0, np.inf
        #: That of the latest step, in tolerances.
        error = np.inf

        def _estimate_error_norm(self, K: Array, h: float, scale: Array) -> float:
            fifth, third = (
                float(np.linalg.norm(K.T @ weights / scale)) for weights in (self.E5, self.E3)
            )
            length = abs(h)
            if third > TUNING.risen * self._before * max(length, self.step_size or length) ** 3:
                self._doubts = TUNING.wary
            error = error_of(fifth, 0.1 * third, self._doubts > 0) * length / np.sqrt(len(scale))
            if error < 1:
                self._doubts = max(0, self._doubts - 1)
                self._before = third / length**3
            else:
                self._doubts = TUNING.wary
            self.error = float(error)
            return self.error

    return Wary


def error_of(fifth: float, third: float, wary: bool) -> float:
    """A step's error from the estimates of order 5 and 3 (Hairer, Norsett, Wanner I, section II.10).

    >>> error_of(3.0, 4.0, wary=False), error_of(3.0, 4.0, wary=True)
    (1.8, 5.0)
    """
    both = float(np.hypot(fifth, third))
    return both if wary or both == 0 else fifth**2 / both

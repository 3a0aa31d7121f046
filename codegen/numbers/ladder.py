"""Solutions of ``z' = M z`` after any time, by a ladder of exponentials over times that double.

In double precision each doubling doubles what a slow motion has lost beside a fast one: after a step
of ``|M| h`` it has lost ``|M| h`` units in the last place. So rungs are pairs, of 32 digits.
"""

import math

import numpy as np

from bondgraph.errors import SimulationError
from codegen.numbers.arrays import Array
from codegen.numbers.pairs import Pair, matmul, pair, plus, stacked, times
from codegen.tuning import TUNING


class Ladder:
    """``exp(M u)``, ``exp(M 2u)``, ``exp(M 4u)``, ... for a time u in which little happens.

    ``norm`` [1/s]: a bound on |M|, in a norm in which M is balanced.
    """

    def __init__(self, M: Pair, norm: float) -> None:
        self._M, self._norm = M, norm
        # A power of two, so that dividing by it is exact.
        exponent = -2 - math.frexp(norm)[1] if norm > 0 else 0
        self.unit = math.ldexp(1.0, max(exponent, -1000))
        self._rungs: list[Pair] = []

    def check(self, t: float, span: float) -> None:
        """Refuse a stretch over which even pairs would lose digits."""
        if not span / self.unit < 2.0**TUNING.rungs:
            raise SimulationError(
                f"at t = {t:.9g} the rates of the model or of its inputs reach {self._norm:.3g} 1/s: over "
                f"{span:.3g} s they leave no digit of the slow ones; leave the fastest out of the model"
            )

    def after(self, z: Pair, lengths: Array) -> Pair:
        """Each row of z after its length [s]."""
        units = lengths / self.unit
        whole = np.floor(units)
        z = self._series(z, (units - whole) * self.unit)
        count = whole.astype(np.int64)
        for level in range(int(count.max(initial=0)).bit_length()):
            rows = (count >> level & 1).astype(bool)
            if rows.any():
                moved = matmul(z[rows], self._rung(level).T)
                z.hi[rows], z.lo[rows] = moved
        return z

    def leap(self, length: float) -> Pair:
        """``exp(M length)``."""
        size = len(self._M.hi)
        return self.after(pair(np.eye(size)), np.full(size, length)).T

    def _series(self, z: Pair, lengths: Array) -> Pair:
        """Each row of z after a length of at most the unit."""
        moving = np.flatnonzero(lengths)
        z = Pair(z.hi.copy(), z.lo.copy())
        if not len(moving):
            return z
        start, over = z[moving], lengths[moving, None]
        total = start
        for k in range(TUNING.pair_degree, 0, -1):
            # total = z + M h/k total (Horner's scheme)
            step = times(matmul(total, self._M.T), _ratio(over, k))
            total = plus(start, step)
        z.hi[moving], z.lo[moving] = total
        return z

    def _rung(self, level: int) -> Pair:
        while len(self._rungs) <= level:
            if self._rungs:
                self._rungs.append(matmul(self._rungs[-1], self._rungs[-1]))
            else:
                size = len(self._M.hi)
                self._rungs.append(self._series(pair(np.eye(size)), np.full(size, self.unit)).T)
        return self._rungs[level]


def _ratio(values: Array, k: int) -> Pair:
    """``values / k`` as pairs."""
    quotient = values / k
    whole = times(pair(quotient), pair(np.array(float(k))))
    rest = (values - whole.hi) - whole.lo
    return Pair(quotient, np.asarray(rest / k))


def rows_by_doubling(leap: Pair, z: Pair, count: int) -> Pair:
    """z, P z, P^2 z, ... up to P^count z, as rows."""
    rows, power = z, leap.T
    while len(rows.hi) <= count:
        more = matmul(rows[: count + 1 - len(rows.hi)], power)
        rows = stacked([rows, more])
        if len(rows.hi) <= count:
            power = matmul(power, power)
    return rows

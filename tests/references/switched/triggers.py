"""When a mode ends: the first root of triggers that matrix exponentials propagate exactly."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from references.switched.modes import Motion
from references.switched.pencil import Array

RISEN = 1e-10
"""Of the state: a trigger that begins at zero has risen once it is above."""


def first_left(motion: Motion, c: Array, span: float, longest: float) -> float | None:
    """The first time from now at which a trigger falls through zero; None where none does in time.

    Steps begin at a tenth of the fastest rate and grow to a twentieth of the fastest swing.
    """
    T = motion.watched
    rate = T @ motion.M
    if not len(T):
        return None
    swing, fast = np.abs(motion.rates.imag).max(), np.abs(motion.rates).max()
    longest = min(longest, 0.3 / max(swing, 1e-300))
    halvings = max(0, int(np.ceil(np.log2(max(longest * 10 * fast, 1.0)))))
    zero = RISEN * np.linalg.norm(T, axis=1) * max(float(np.linalg.norm(c)), 1.0)
    at, taken, armed = 0.0, 0, T @ c > zero
    while at < span:
        h = longest / 2.0 ** max(halvings - taken // 4, 0)
        whole = h <= span - at
        h = h if whole else span - at
        after = (motion.leap(h) if whole else motion.after(h)) @ c
        falls = armed & (T @ after <= 0) | ~armed & (T @ after < -zero)
        # Less of a turn than this leads no farther than rounding does.
        dips = ~falls & (h * rate @ c < -zero) & (h * rate @ after > zero)
        looked = zip(T, armed, zero, falls | dips, strict=True)
        roots = [_root(row, motion, c, h, risen, low) for row, risen, low, look in looked if look]
        if found := [s for s in roots if s is not None]:
            return at + min(found)
        at, c, taken, armed = at + h, after, taken + 1, armed | (T @ after > zero)
    return None


def _root(row: Array, motion: Motion, c: Array, h: float, risen: bool, low: float) -> float | None:
    """Where a trigger falls through zero within a step."""

    def value(s: float) -> float:
        return float(row @ motion.after(s) @ c)

    def rate(s: float) -> float:
        return float(row @ motion.M @ motion.after(s) @ c)

    end, last = h, value(h)
    if last > 0:
        if not rate(0.0) < 0 < rate(h):
            return None
        # It turned round between: is its least value below zero?
        end = float(brentq(rate, 0.0, h, xtol=1e-15))
        last = value(end)
    if last >= (0.0 if risen else -low):
        return end if risen and last == 0 else None
    # One that begins at zero rises first, if not by more than rounding.
    before = (0.0,) if risen else (h / 2.0**k for k in range(1, 40) if h / 2.0**k < end)
    begin = next((s for s in before if value(s) > 0), None)
    return 0.0 if begin is None else float(brentq(value, begin, end, xtol=1e-15))

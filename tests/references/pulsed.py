"""A coil and a resistance on pulses of a voltage, in many digits: the periodic current, and the instants."""

from fractions import Fraction

import mpmath

DIGITS = 40


def current(
    t: float, V: float, R: float, L: float, frequency: float, duty: float, phase: float
) -> float:
    """The current that repeats: two exponentials a period, the first towards V/R, the second towards 0."""
    with mpmath.workdps(DIGITS):
        place = Fraction(t) * Fraction(frequency) - Fraction(phase)
        place -= place.numerator // place.denominator
        rate, d = mpmath.mpf(R) / L / frequency, mpmath.mpf(duty)
        full, x = mpmath.mpf(V) / R, mpmath.mpf(place.numerator) / place.denominator
        # Fed for the duty, then let down to where it began.
        fed = -mpmath.expm1(-rate * d)
        begin = full * fed * mpmath.exp(-rate * (1 - d)) / -mpmath.expm1(-rate)
        if place <= Fraction(duty):
            return float(full + (begin - full) * mpmath.exp(-rate * x))
        top = full + (begin - full) * mpmath.exp(-rate * d)
        return float(top * mpmath.exp(-rate * (x - d)))


def switchings(begin: float, end: float, frequency: float, duty: float, phase: float) -> int:
    """How many times the voltage changes after ``begin`` and up to ``end``, by rational numbers."""
    total = 0
    for offset in (Fraction(phase), Fraction(phase) + Fraction(duty)):
        last, first = (Fraction(t) * Fraction(frequency) - offset for t in (end, begin))
        total += last.numerator // last.denominator - first.numerator // first.denominator
    return total

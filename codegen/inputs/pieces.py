"""Smooth pieces of signals: sums of polynomials times exponentials, and what a lag makes of them."""

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import is_

import numpy as np

from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

Term = tuple[complex, tuple[complex, ...]]
"""A rate [1/s] and a polynomial's coefficients, lowest power first."""

SERIES = 9
"""Terms of that series: rounding takes over from the quotient where the series leaves off."""


@dataclass(frozen=True)
class Piece:
    """The real part of ``sum_j p_j(tau) exp(rate_j tau)``, ``tau = t - start``.

    ``pace`` [1/s]: how fast a polynomial is that stands for something else.
    """

    start: float
    terms: tuple[Term, ...]
    pace: float = 0.0

    def __call__(self, t: float) -> float:
        """The value at one time."""
        if self.level is not None:
            return self.level
        tau = t - self.start
        total = 0.0
        for rate, polynomial in self.terms:
            value: complex = 0.0
            for coefficient in reversed(polynomial):
                value = value * tau + coefficient
            if rate:
                value *= cmath.exp(rate * tau) if rate.imag else math.exp(rate.real * tau)
            total += value.real
        if total and abs(total) <= self._suspect and abs(total) <= self._rounding_at(t):
            return 0.0
        return total

    def values(self, times: Array) -> Array:
        """The values at many times."""
        tau = times - self.start
        total = np.zeros(len(tau))
        for rate, polynomial in self.terms:
            value = np.zeros(len(tau), dtype=complex)
            for coefficient in reversed(polynomial):
                value = value * tau + coefficient
            if rate:
                value = value * np.exp(rate * tau if rate.imag else rate.real * tau)
            total += value.real
        near = np.flatnonzero(np.abs(total) <= self._suspect)
        if len(near):
            total[near[np.abs(total[near]) <= self._rounding(times[near])]] = 0.0
        return total

    @cached_property
    def level(self) -> float | None:
        """What it is at all times, where it is a constant."""
        if len(self.terms) == 1 and not self.terms[0][0] and len(self.terms[0][1]) == 1:
            return 0.0 + complex(self.terms[0][1][0]).real
        return None

    @cached_property
    def _suspect(self) -> float:
        """Below this a value may be rounding; never where no terms can cancel, which saves the look."""
        alone = len(self.terms) == 1 and len(self.terms[0][1]) == 1
        if alone and not complex(self.terms[0][0]).imag:
            return -1.0
        sizes = [abs(c) for _, polynomial in self.terms for c in polynomial]
        return TUNING.cancelled * max(sizes, default=0.0)

    def _rounding_at(self, t: float) -> float:
        """What rounding leaves of terms that cancel, at one time."""
        tau, size, slope = abs(t - self.start), 0.0, 0.0
        for rate, polynomial in self.terms:
            own = rising = 0.0
            for coefficient in reversed(polynomial):
                rising = rising * tau + own
                own = own * tau + abs(coefficient)
            real = complex(rate).real
            grown = math.exp(real * (t - self.start)) if real else 1.0
            size, slope = size + own * grown, slope + (rising + abs(rate) * own) * grown
        late = (abs(t) + abs(self.start)) / 8
        return TUNING.zero_value * (size + late * slope)

    def _rounding(self, times: Array) -> Array:
        """What rounding leaves of terms that cancel, at their times."""
        tau = np.abs(times - self.start)
        size, slope = np.zeros_like(tau), np.zeros_like(tau)
        for rate, polynomial in self.terms:
            own, rising = np.zeros_like(tau), np.zeros_like(tau)
            for coefficient in reversed(polynomial):
                rising = rising * tau + own
                own = own * tau + abs(coefficient)
            grown = np.exp(complex(rate).real * (times - self.start))
            size, slope = size + own * grown, slope + (rising + abs(rate) * own) * grown
        late = (np.abs(times) + abs(self.start)) / 8
        return np.asarray(TUNING.zero_value * (size + late * slope), dtype=float)

    @cached_property
    def derivative(self) -> "Piece":
        """The rate of change in time, as a piece."""
        slopes = tuple((rate, _slope(rate, poly)) for rate, poly in self.terms)
        return Piece(self.start, slopes, self.pace)

    @cached_property
    def fastest(self) -> float:
        """The largest magnitude of a rate [1/s]."""
        return max(self.pace, *(abs(rate) for rate, _ in self.terms), 0.0)


def are_same(ours: Sequence[Piece], others: Sequence[Piece]) -> bool:
    """Whether these are the very same pieces, one by one: told without a look at their terms."""
    if ours is others:
        return True
    return len(ours) == len(others) and all(map(is_, ours, others))


def constant_piece(start: float, value: float) -> Piece:
    """One value for ever."""
    return Piece(float(start), ((0, (float(value),)),))


def _slope(rate: complex, polynomial: Sequence[complex]) -> tuple[complex, ...]:
    """The polynomial of the derivative of ``p(tau) exp(rate tau)``: ``p' + rate p``."""
    raised = [(k + 1) * c for k, c in enumerate(polynomial[1:])] + [0.0]
    return tuple(rate * c + up for c, up in zip(polynomial, raised, strict=True))


def lagged_terms(piece: Piece, T: float) -> tuple[Term, ...]:
    """The forced answer of ``T y' + y = piece``: no decaying part of its own."""
    terms: list[Term] = []
    for rate, polynomial in piece.terms:
        gain = 1 + rate * T
        if abs(gain) <= TUNING.resonance:
            terms.append((complex(-1 / T), _resonant(polynomial, gain / T, T)))
            continue
        solved: list[complex] = []
        above: complex = 0.0
        for k in reversed(range(len(polynomial))):
            above = (polynomial[k] - T * (k + 1) * above) / gain
            solved.append(above)
        terms.append((rate, tuple(reversed(solved))))
    return tuple(terms)


def _resonant(polynomial: Sequence[complex], off: complex, T: float) -> tuple[complex, ...]:
    """The answer to ``p(tau) exp((off - 1/T) tau)``, over ``exp(-tau/T)``, by a series."""
    driven: list[complex] = [0.0] * (len(polynomial) + SERIES)
    factor: complex = 1.0
    for k in range(SERIES + 1):
        for j, c in enumerate(polynomial):
            driven[j + k] += c * factor
        factor *= off / (k + 1)
    return (0.0, *(c / (T * (n + 1)) for n, c in enumerate(driven)))


def moved(piece: Piece, start: float) -> Piece:
    """The same piece written from another start."""
    shift = start - piece.start
    if shift == 0:
        return piece
    terms: list[Term] = []
    for rate, polynomial in piece.terms:
        shifted = [
            sum(math.comb(n, k) * c * shift ** (n - k) for n, c in enumerate(polynomial) if n >= k)
            for k in range(len(polynomial))
        ]
        factor = cmath.exp(rate * shift)
        terms.append((rate, tuple(factor * c for c in shifted)))
    return Piece(start, tuple(terms), piece.pace)


def collected(terms: Sequence[Term]) -> tuple[Term, ...]:
    """Terms of one rate added up."""
    result: dict[complex, list[complex]] = {}
    for rate, polynomial in terms:
        total = result.setdefault(complex(rate), [])
        total += [0.0] * (len(polynomial) - len(total))
        for k, c in enumerate(polynomial):
            total[k] += c
    return tuple((rate, tuple(polynomial)) for rate, polynomial in result.items())

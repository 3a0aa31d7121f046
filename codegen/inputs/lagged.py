"""Lags of signals that repeat: a wave again, or a chase after one whose duty moves."""

import cmath
import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from codegen.inputs.pieces import Piece, Term, collected, lagged_terms, moved
from codegen.inputs.signal import Endless, Signal
from codegen.inputs.waves import Wave
from codegen.numbers.arrays import Array

LATEST = 64
"""Pieces that a chase remembers; before them it begins again."""


def lagged_wave(wave: Wave, T: float) -> Signal:
    """The answer of ``T y' + y = wave``; as the wave has been for ever it repeats, too.

    A period that begins at y ends at ``gained + y exp(-period/T)``; the periodic answer begins where the two
    are equal, at the sum of a geometric series.
    """
    if wave.duty is not None:
        period = wave.period(0.0)
        share = wave.share(period)
        still = replace(wave, fractions=(0.0, share), duty=None)
        if not 0 < share < 1:
            still = replace(still, fractions=(0.0,), forms=(wave.forms[0 if share else 1],))
        return Chase(wave, T, lagged_wave(still, T), wave.instant(period, wave.phase))
    forced = [lagged_terms(Piece(0.0, terms), T) for terms in wave.forms]
    ends = [*wave.fractions[1:], 1.0]
    lasts = [(b - a) / wave.frequency for a, b in zip(wave.fractions, ends, strict=True)]
    gained = 0.0
    for terms, last in zip(forced, lasts, strict=True):
        gained = _end(terms, last, T, gained)
    y, forms = gained / -math.expm1(-sum(lasts) / T), []
    for terms, last in zip(forced, lasts, strict=True):
        decay = (complex(-1 / T), (complex(y - _begin(terms)),))
        forms.append(collected([*terms, decay]))
        y = _end(terms, last, T, y)
    return replace(wave, forms=tuple(forms))


def _begin(terms: Sequence[Term]) -> float:
    return sum(complex(poly[0]).real for _, poly in terms)


def _end(terms: Sequence[Term], last: float, T: float, y: float) -> float:
    """Where an answer is that began at y, after so long: without a difference of what is nearly equal."""
    rise: complex = 0.0
    for rate, poly in terms:
        higher = sum(c * last**k for k, c in enumerate(poly) if k)
        rise += higher * cmath.exp(rate * last) + poly[0] * _expm1(complex(rate) * last)
    return y + rise.real + (y - _begin(terms)) * math.expm1(-last / T)


def _expm1(z: complex) -> complex:
    return cmath.exp(z) - 1 if z.imag else math.expm1(z.real)


@dataclass(frozen=True)
class Chase(Endless):
    """The answer of ``T y' + y = driven`` from ``origin`` [s] on, piece by piece; until then ``before``.

    ``before`` is the lag of what the signal would be if its duty had for ever been what it is at the
    origin, where the period that holds t = 0 begins. Times are best asked for in turn: going back far
    begins again at the origin.
    """

    driven: Signal
    T: float
    before: Signal
    origin: float

    def piece(self, t: float) -> Piece:
        """The piece that holds at t and just after."""
        return self.before.piece(t) if t < self.origin else self._reached(t)

    def following(self, t: float) -> float:
        """That of the signal it follows, or of what was before."""
        return (
            self.driven.following(t)
            if t >= self.origin
            else min(self.before.following(t), self.origin)
        )

    def preceding(self, t: float) -> float:
        """As `following`."""
        return self.driven.preceding(t) if t >= self.origin else self.before.preceding(t)

    def first_jump(self, begin: float, end: float) -> float | None:
        """None: a lag goes on where it was."""
        return None

    def scaled(self, factor: float) -> Signal:
        """The chase after the signal times a number."""
        return Chase(self.driven.scaled(factor), self.T, self.before.scaled(factor), self.origin)

    def sampled(self, times: Array, rates: bool = False) -> Array:
        """As of all signals."""
        pieces = map(self.piece, times.tolist())
        told = [
            (one.derivative if rates else one)(t)
            for one, t in zip(pieces, times.tolist(), strict=True)
        ]
        return np.array(told, dtype=float)

    @cached_property
    def _latest(self) -> deque[tuple[float, Piece]]:
        return deque(maxlen=LATEST)

    def _reached(self, t: float) -> Piece:
        """The piece at t, by way of all since the latest that is known."""
        known = self._latest
        if not known or known[0][0] > t:
            known.clear()
            known.append((self.origin, self._answer(self.origin, self.before(self.origin))))
        while (after := self.driven.following(known[-1][0])) <= t:
            known.append((after, self._answer(after, known[-1][1](after))))
        return next(piece for begin, piece in reversed(known) if begin <= t)

    def _answer(self, begin: float, y: float) -> Piece:
        """The piece that is y where it begins."""
        forced = lagged_terms(moved(self.driven.piece(begin), begin), self.T)
        decay = (complex(-1 / self.T), (complex(y - _begin(forced)),))
        return Piece(begin, collected([*forced, decay]))


def lagged(signal: Signal, T: float) -> Signal | None:
    """The lag of an endless signal that is no sum; None where breakpoints are at hand."""
    if isinstance(signal, Wave):
        return lagged_wave(signal, T)
    if isinstance(signal, Chase):
        before = [lagged(part, T) for part in signal.before.summands]
        first = before[0]
        assert first is not None
        return Chase(signal, T, first, signal.origin)
    return None

"""Numbers in twice double precision: each is a pair, the unevaluated sum of a double and its rest.

Sums and products come with their rounding errors, without any error (Dekker 1971, Knuth 1969).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from typing import Any

import numpy as np

from codegen.numbers.arrays import Array

SPLIT = 134217729.0
"""2^27 + 1: cuts a double into two halves, whose products are exact."""

LONG = 200
"""Digits in which what doubles leave of decimals is found."""

ROOM = 1 << 16
"""So many products are formed at a time."""


@dataclass(frozen=True)
class Pair:
    """``hi + lo``, arrays of one shape; ``lo`` is below half a unit in the last place of ``hi``."""

    hi: Array
    lo: Array

    def __getitem__(self, at: Any) -> "Pair":
        return Pair(self.hi[at], self.lo[at])

    def __iter__(self) -> Iterator[Array]:
        return iter((self.hi, self.lo))

    @property
    def T(self) -> "Pair":
        """Transposed."""
        return Pair(self.hi.T, self.lo.T)


def pair(values: Array) -> Pair:
    """Doubles as pairs."""
    hi = np.array(values, dtype=float)
    return Pair(hi, np.zeros_like(hi))


def from_decimals(rows: list[list[Decimal]]) -> Pair:
    """Long decimals, rounded to pairs."""
    hi = np.array([[float(value) for value in row] for row in rows], dtype=float)
    with localcontext(Context(prec=LONG)):
        rest = [
            [float(value - Decimal(high)) for value, high in zip(row, found, strict=True)]
            for row, found in zip(rows, hi.tolist(), strict=True)
        ]
    return Pair(hi, np.array(rest, dtype=float).reshape(hi.shape))


def stacked(parts: Sequence[Pair], axis: int = 0) -> Pair:
    """Pairs one after the other."""
    return Pair(*(np.concatenate(both, axis=axis) for both in zip(*parts, strict=True)))


def plus(a: Pair, b: Pair) -> Pair:
    """``a + b``."""
    high, rest = _sum(a.hi, b.hi)
    low, least = _sum(a.lo, b.lo)
    high, rest = _settled(high, rest + low)
    return Pair(*_settled(high, rest + least))


def times(a: Pair, b: Pair) -> Pair:
    """``a b``, entry by entry."""
    product = a.hi * b.hi
    rest = _rest(a.hi, b.hi, product) + (a.hi * b.lo + a.lo * b.hi)
    return Pair(*_settled(product, rest))


def matmul(a: Pair, b: Pair) -> Pair:
    """The product of two matrices."""
    rows, (inner, columns) = len(a.hi), b.hi.shape
    block = max(1, ROOM // max(1, inner * columns))
    if rows <= block:
        return _product(a, b)
    return stacked([_product(a[at : at + block], b) for at in range(0, rows, block)])


def _product(a: Pair, b: Pair) -> Pair:
    terms = times(a[:, :, None], b[None])
    while terms.hi.shape[1] > 1:
        half = terms.hi.shape[1] // 2
        added = plus(terms[:, :half], terms[:, half : 2 * half])
        terms = stacked([added, terms[:, 2 * half :]], axis=1)
    if not terms.hi.shape[1]:
        return pair(np.zeros((len(a.hi), b.hi.shape[1])))
    return terms[:, 0]


def _sum(a: Array, b: Array) -> tuple[Array, Array]:
    """The sum, and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _settled(a: Array, b: Array) -> tuple[Array, Array]:
    """The same where b is not larger than a."""
    total = a + b
    return total, b - (total - a)


def _rest(a: Array, b: Array, product: Array) -> Array:
    """The rounding error of a product."""
    a_high, a_low = _halves(a)
    b_high, b_low = _halves(b)
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _halves(a: Array) -> tuple[Array, Array]:
    scaled = SPLIT * a
    high = scaled - (scaled - a)
    return high, a - high

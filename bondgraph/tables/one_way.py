"""Whether a table over one axis goes one way all along: told by its polynomials, exactly."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from bondgraph.tables.pieces import Points, pieces

ROUNDING = Fraction(1, 2**49)
"""Of the terms of a slope, what their rounding may leave where they cancel."""

Ends = tuple[Fraction | None, Fraction | None]
"""Of a stretch; None where it goes on without end."""


class OneWay(NamedTuple):
    """1 where a table rises, -1 where it falls, 0 where it does not go one way, with the reason.

    ``beyond``: whether the polynomials at its ends go on the same way without end.
    """

    way: int
    beyond: bool
    reason: str = ""


def one_way(table: Points) -> OneWay:
    """Whether the slope of a table over one axis has one sign between its ends, and is nowhere zero.

    >>> from bondgraph.tables.record import Sampled
    >>> one_way(Sampled("rest", ((0.0, 1.0, 2.0),), (0.0, 1.0, 3.0), "pchip", "hold")).way
    1
    >>> one_way(Sampled("rest", ((0.0, 1.0, 2.0),), (0.0, 1.0, 5.0), "pchip", "hold")).reason
    'it is level at 0, where its inverse would be infinitely steep'
    """
    (axis,), z = table.axes, table.values
    way = 1 if z[-1] > z[0] else -1
    for (a, b), (y0, y1) in zip(pairwise(axis), pairwise(z), strict=True):
        if way * (y1 - y0) <= 0:
            told = "is level" if y1 == y0 else "turns back"
            return OneWay(0, False, f"it {told} between {a:.9g} and {b:.9g}")
    cells = list(_cells(table))
    for (slope, width), a in zip(cells, axis, strict=False):
        worst, at = _least(slope, (Fraction(0), width), way)
        if worst <= 0:
            place = f"{a + float(at):.9g}"
            told = f"is level at {place}, where its inverse would be infinitely steep"
            return OneWay(0, False, f"it {told if worst == 0 else f'turns back at {place}'}")
    (first, _), (last, width) = cells[0], cells[-1]
    ends = _least(first, (None, Fraction(0)), way)[0], _least(last, (width, None), way)[0]
    return OneWay(way, min(ends) > 0)


def _cells(table: Points) -> Iterator[tuple[list[Fraction], Fraction]]:
    """Of each cell the factors of its slope, highest power first, and its width."""
    (knots,), degree, _, factors = pieces(table)
    for at, (a, b) in enumerate(pairwise(knots)):
        powers = factors[at * (degree + 1) : (at + 1) * (degree + 1) - 1]
        slope = [Fraction(degree - k) * Fraction(one) for k, one in enumerate(powers)]
        yield [Fraction(0)] * (3 - len(slope)) + slope, Fraction(b) - Fraction(a)


def _least(slope: Sequence[Fraction], ends: Ends, way: int) -> tuple[Fraction, Fraction]:
    """The least that a slope times its way comes to between two ends, and where; 0 where rounding tells."""
    a, b, c = (way * one for one in slope)
    low, high = ends
    found = [(_rounded([a * u * u, b * u, c]), u) for u in (low, high) if u is not None]
    if a:
        u = -b / (2 * a)
        if (low is None or u > low) and (high is None or u < high):
            found.append((_rounded([a * u * u, b * u, c]), u))
    if None in ends:
        side = 1 if high is None else -1
        falls = a < 0 or (a == 0 and side * b < 0)
        found += [(Fraction(-1), Fraction(side))] if falls else []
    return min(found)


def _rounded(terms: Sequence[Fraction]) -> Fraction:
    total = sum(terms, Fraction(0))
    return total if abs(total) > ROUNDING * sum(map(abs, terms)) else Fraction(0)

"""Pieces one after the other: where they jump, what they are at many times; pieces side by side."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codegen.inputs.pieces import Piece, collected, moved
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def jumps(one: Piece, other: Piece, t: float) -> bool:
    """Whether two pieces that meet at t differ there by more than rounding."""
    jump = abs(one(t) - other(t))
    return jump > TUNING.together * (abs(one(t)) + abs(other(t)))


def first_jump(
    breaks: Sequence[float], pieces: Sequence[Piece], seams: frozenset[float],
    begin: float, end: float,
) -> float | None:  # fmt: skip
    """The first break after ``begin``, up to ``end``, at which the pieces jump; None if there is none."""
    for b, one, other in zip(breaks, pieces, pieces[1:], strict=False):
        if begin < b <= end and b not in seams and jumps(one, other, b):
            return b
    return None


def sampled(breaks: Sequence[float], pieces: Sequence[Piece], times: Array) -> Array:
    """What pieces between breaks are at many times; at a break that of the piece that begins."""
    if len(pieces) == 1:
        return pieces[0].values(times)
    which = np.searchsorted(np.array(breaks, dtype=float), times, side="right")
    return by_pieces(which, pieces, times)


def by_pieces(which: NDArray[np.intp], pieces: Sequence[Piece], times: Array) -> Array:
    """What each time's own piece is there."""
    result = np.zeros(len(times))
    order = np.argsort(which, kind="stable")
    ends = np.flatnonzero(np.diff(which[order])) + 1
    for here in np.split(order, ends) if len(times) else ():
        result[here] = pieces[which[here[0]]].values(times[here])
    return result


def summed(pieces: Sequence[Piece], start: float) -> Piece:
    """The sum of pieces, told from one start; a single one as it is."""
    if len(pieces) == 1:
        return pieces[0]
    terms = [term for piece in pieces for term in moved(piece, start).terms]
    pace = max(piece.pace for piece in pieces)
    return Piece(start, collected(terms), pace)


def scaled(piece: Piece, factor: float) -> Piece:
    """A piece times a number."""
    terms = tuple((rate, tuple(factor * c for c in poly)) for rate, poly in piece.terms)
    return Piece(piece.start, terms)

"""Known sources: expressions of time as signals, whose pieces hide nothing that the expression does."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import sympy as sp

from codegen.inputs.branches import known, smooth_parts
from codegen.inputs.harmonics import terms_of
from codegen.inputs.pieces import Piece
from codegen.inputs.segments import polynomial_segments
from codegen.inputs.signal import Pieced

__all__ = ["Known", "known", "known_signal"]


@dataclass(frozen=True)
class Known(Pieced):
    """An expression of time over the stretch that it was made for; before and after, its outer pieces."""

    expression: sp.Expr


@lru_cache(maxsize=32)
def known_signal(expr: sp.Expr, begin: float, end: float) -> Known:
    """The signal of an expression of time alone, from ``begin`` to ``end`` [s].

    Between its corners, which are breakpoints, a sum of products of polynomials, exp, sin, cos, sinh and
    cosh of linear time is one exact piece. Any other expression is polynomials, exact to rounding by bounds
    on what it does over each of them.

    Raises `SimulationError` where it has no finite value, or does more than a run can tell.

    >>> t = sp.Symbol("t")
    >>> square = known_signal(sp.sign(sp.sin(sp.pi*t)), 0.0, 2.5)
    >>> square.breakpoints, [square(0.5), square(1.5)]
    ((1.0, 2.0), [1.0, -1.0])
    """
    expr = expr.xreplace({one: sp.Rational(str(one)) for one in expr.atoms(sp.Float)})
    points: list[float] = []
    pieces: list[Piece] = []
    seams: set[float] = set()
    parts = smooth_parts(expr, begin, end)
    ends = [a for a, _ in parts[1:]] + [end]
    for (a, part), b in zip(parts, ends, strict=True):
        for at, (start, piece) in enumerate(_pieces(part, a, b)):
            if pieces:
                points.append(start)
                if at:
                    seams.add(start)
            pieces.append(piece)
    return Known(tuple(points), tuple(pieces), frozenset(seams), expr)


def _pieces(expr: sp.Expr, begin: float, end: float) -> list[tuple[float, Piece]]:
    """A smooth part: one exact piece, or polynomials, each with where it begins."""
    exact = _exact(expr, begin)
    if exact is not None:
        return [(begin, exact)]
    found = polynomial_segments(expr, begin, end)
    scale = found.halves[:, None] ** -np.arange(found.powers.shape[1])
    rows = (found.powers * scale).tolist()
    made: list[tuple[float, Piece]] = []
    for centre, half, row in zip(found.centres.tolist(), found.halves.tolist(), rows, strict=True):
        piece = Piece(centre, ((0.0, tuple(row)),), 0.5 / half)
        made.append((max(centre - half, begin) if made else begin, piece))
    return made


def _exact(expr: sp.Expr, begin: float) -> Piece | None:
    """Told from zero where that loses nothing, so that pieces of one expression are alike."""
    terms = _terms(expr)
    if terms is None:
        return None
    if all(len(poly) <= 2 and complex(rate).real == 0 for rate, poly in terms):
        return Piece(0.0, terms)
    local = terms_of(expr, sp.Rational(begin))
    return None if local is None else Piece(begin, local)


_terms = lru_cache(maxsize=256)(terms_of)

"""Where what is above zero at three points dips to zero between them: by chords, ever closer.

A function that bends upwards lies, between two points, above the chords beside them drawn on. Where the least
that these leave is above zero it is no dip; else that place is looked at next. A chord beside which it bends
downwards tells nothing.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from codegen.tuning import TUNING

Above = Callable[[float], float]


def dip(above: Above, times: Sequence[float], values: Sequence[float]) -> float | None:
    """A time at which a function is not above zero; None where it stays above as far as chords tell.

    ``times``, ``values``: three points at equal distances. The parabola through them tells whether there
    is a dip worth a closer look.
    """
    if not _promising(*values):
        return None
    width = TUNING.dip * (times[2] - times[0])
    points = list(zip(times, values, strict=True))
    for _ in range(TUNING.dip_looks):
        least, k, t = min(_bounds(points))
        if least > 0 or points[k + 1][0] - points[k][0] <= width:
            return None
        value = above(t)
        if value <= 0:
            return t
        points.insert(k + 1, (t, value))
    return None


def _promising(a: float, b: float, c: float) -> bool:
    """Whether the parabola through three points falls to half of the lowest of them, or below."""
    curve, slope, least = a - 2 * b + c, (c - a) / 2, min(a, b, c)
    if least <= 0 or curve <= 0 or abs(slope) > 1.25 * curve:
        return False
    return b - slope**2 / (2 * curve) <= 0.5 * least


def _bounds(points: Sequence[tuple[float, float]]) -> Iterator[tuple[float, int, float]]:
    """The least that chords leave between two points, which two, and where to look between them."""
    chords = [(f_b - f_a) / (t_b - t_a) for (t_a, f_a), (t_b, f_b) in pairwise(points)]
    for k, chord in enumerate(chords):
        (t, a), (end, b) = points[k], points[k + 1]
        h, least = end - t, min(a, b)
        left = chords[k - 1] if k > 0 and chords[k - 1] < chord else None
        right = chords[k + 1] if k + 1 < len(chords) and chord < chords[k + 1] else None
        if left is None or right is None:
            # Of one chord only: what it leaves at its far end.
            if left is not None:
                least = min(least, a + left * h)
            if right is not None:
                least = min(least, b - right * h)
            yield least, k, t + h / 2
            continue
        meet = (b - a - right * h) / (left - right)
        if left < 0 < right:
            least = a + left * meet
        yield least, k, t + min(max(meet, TUNING.dip_inside * h), (1 - TUNING.dip_inside) * h)

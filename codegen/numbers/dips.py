"""Where what is above zero at several points dips to zero between two of them: by chords, ever closer.

A function that bends upwards lies, between two points, above the chords beside them drawn on. A corner
between the two points changes nothing of that; where its sides bend downwards, chords drawn on bend as much.
Where the least that these leave is above zero it is no dip; else that place is looked at next.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

from codegen.tuning import TUNING

Above = Callable[[float], float]
Points = Sequence[tuple[float, float]]


def dip(above: Above, times: Sequence[float], values: Sequence[float], k: int) -> float | None:
    """A time between points k and k + 1 at which a function is not above zero.

    None where it stays above as far as chords tell, and in a stretch of so few roundings of the time that
    points fall together. ``times``, ``values``: points of a stretch in their order, those beside the two
    among them; the two themselves are above zero.
    """
    if any(before == after for before, after in pairwise(times)):
        return None
    width = TUNING.dip * (times[-1] - times[0])
    points, end = list(zip(times, values, strict=True)), k + 1
    for _ in range(TUNING.dip_looks):
        least, j, t = min(_place(points, j) for j in range(k, end))
        if not least <= 0 or points[j + 1][0] - points[j][0] <= width:
            return None
        value = above(t)
        if value <= 0:
            return t
        points.insert(j + 1, (t, value))
        end += 1
    return None


def may_dip(values: Sequence[float]) -> bool:
    """Whether chords could leave zero or less anywhere between points at equal distances.

    A chord drawn on falls by no more than the largest change between two points, and twice that as it bends.
    """
    return min(values) <= 3 * max(abs(b - a) for a, b in pairwise(values))


def _place(points: Points, k: int) -> tuple[float, int, float]:
    """The least that chords leave between points k and k + 1, k, and where to look between them."""
    (t, a), (end, b) = points[k], points[k + 1]
    h, chord, least = end - t, _chord(points, k), min(a, b)
    left, right = _drawn_on(points, k)
    if left < chord < right:
        meet = (b - a - right * h) / (left - right)
        if left < 0 < right:
            least = a + left * meet
        inside = TUNING.dip_inside * h
        return least, k, t + min(max(meet, inside), h - inside)
    # Of one chord only: what it leaves at its far end.
    if left < chord:
        least = min(least, a + left * h)
    elif chord < right:
        least = min(least, b - right * h)
    return least, k, t + h / 2


def _drawn_on(points: Points, k: int) -> tuple[float, float]:
    """The slopes with which the chords before and after points k and k + 1 go on between them at the most.

    Where there is no chord, or none beyond it to tell how it bends, that is as on the other side.
    """
    chord, before, after = _chord(points, k), k > 0, k + 2 < len(points)
    h = points[k + 1][0] - points[k][0]
    bends = (
        _bend(points, k - 1) if k > 1 else None,
        _bend(points, k + 2) if k + 3 < len(points) else None,
    )
    left, right = chord, chord
    if before:
        reach = (h + points[k][0] - points[k - 1][0]) / 2
        left = _chord(points, k - 1) - reach * _downwards(*bends)
    if after:
        reach = (h + points[k + 2][0] - points[k + 1][0]) / 2
        right = _chord(points, k + 1) + reach * _downwards(*bends[::-1])
    return left, right


def _downwards(own: float | None, other: float | None) -> float:
    """How much a function bends downwards, told on its own side or by the size on the other."""
    if own is None:
        return 0.0 if other is None else abs(other)
    return max(0.0, -own)


def _chord(points: Points, k: int) -> float:
    (t, a), (end, b) = points[k], points[k + 1]
    return (b - a) / (end - t)


def _bend(points: Points, k: int) -> float:
    """The change of slope at point k, over the distance in which it changes."""
    return 2 * (_chord(points, k) - _chord(points, k - 1)) / (points[k + 1][0] - points[k - 1][0])

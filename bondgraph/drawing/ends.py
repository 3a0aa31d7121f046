"""Where bonds end: at the sides of labels, and round junctions at angles that keep strokes apart."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from bondgraph.drawing.places import CLEAR, Places
from bondgraph.drawing.subject import Link, Subject
from bondgraph.layout.boxes import Box, Point

RADIUS, HALF_STROKE = 13.0, 6.0
"""Where bonds end from the centre of a junction; half the length of a causal stroke."""

_FAN = (40.0, 140.0)
_APART = 42.0

_BESIDE = 15.0
"""Bonds at one side of a field end so far from each other, so that their strokes do."""


@dataclass(frozen=True)
class _Way:
    """A bond of the layers: its lower and upper node, and the bends it keeps, from the top."""

    link: Link
    upper: int
    lower: int
    bends: tuple[Point, ...]


def bond_paths(subject: Subject, places: Places, boxes: Sequence[Box]) -> list[tuple[Point, ...]]:
    """Every bond's points from tail to head; ``boxes``: what nodes fill, by their places."""
    ways = [_way(link, places, boxes) for link in subject.links]
    ends: dict[tuple[int, int], Point] = {}
    for node in range(len(subject.items)):
        for upper in (True, False):
            own = [(at, way) for at, way in enumerate(ways) if way and _at(way, upper) == node]
            aims = [(_aim(way, places, upper), at) for at, way in own]
            ends.update(_ends(subject, places, boxes, node, aims, below=upper))
    return [
        _path(link, way, at, ends, places, boxes)
        for at, (link, way) in enumerate(zip(subject.links, ways, strict=True))
    ]


def _at(way: _Way, upper: bool) -> int:
    return way.upper if upper else way.lower


def _way(link: Link, places: Places, boxes: Sequence[Box]) -> _Way | None:
    """The bond's way through the layers, without the bends it can do without; None for one to the side."""
    for upper, lower in ((link.tail, link.head), (link.head, link.tail)):
        if (upper, lower) in places.bends:
            bends = places.bends[upper, lower]
            first, last = places.at[upper], places.at[lower]
            others = (box for at, box in enumerate(boxes) if at not in (upper, lower))
            if not any(box.grown(CLEAR).crossed(first, last) for box in others):
                bends = ()
            return _Way(link, upper, lower, bends)
    return None


def _aim(way: _Way, places: Places, upper: bool) -> Point:
    """What the bond runs to from its upper, or its lower, node."""
    if way.bends:
        return way.bends[0] if upper else way.bends[-1]
    return places.at[way.lower if upper else way.upper]


def _ends(
    subject: Subject, places: Places, boxes: Sequence[Box], node: int,
    aims: list[tuple[Point, int]], below: bool,
) -> dict[tuple[int, int], Point]:  # fmt: skip
    """Where the bonds above or below a node end, by bond and node, in the order of what they aim at."""
    aims.sort()
    x, y = places.at[node]
    found: dict[tuple[int, int], Point] = {}
    if not subject.items[node].junction:
        box = boxes[node]
        edge = box.bottom + CLEAR - 2 if below else box.top - CLEAR
        wide = max(box.right - box.left, _BESIDE * (len(aims) + 1))
        for at, (_, bond) in enumerate(aims):
            share = (at + 1) / (len(aims) + 1) - 0.5
            found[bond, node] = (x + share * wide, edge)
            if len(aims) == 1:
                found[bond, node] = (x, edge)
        return found
    wanted = [math.degrees(math.atan2(abs(aim[1] - y), aim[0] - x)) for aim, _ in aims]
    angles, apart = _fanned(wanted)
    radius = RADIUS
    if len(aims) > 1:
        radius = min(max(RADIUS, HALF_STROKE / math.sin(math.radians(apart / 2))), 2 * RADIUS)
    for angle, (_, bond) in zip(angles, aims, strict=True):
        turn = math.radians(angle)
        down = radius * math.sin(turn)
        found[bond, node] = (x + radius * math.cos(turn), y + (down if below else -down))
    return found


def _fanned(wanted: list[float]) -> tuple[list[float], float]:
    """Angles [degrees] in falling order, near the wanted ones but apart from each other, and how far.

    One that is upright stays so.
    """
    low, high = _FAN
    upright = next((at for at, one in enumerate(wanted) if abs(one - 90) < 2), None)
    if upright is None:
        step = min(_APART, (high - low) / max(len(wanted) - 1, 1))
        return _spread(wanted, low, high, step), step
    left, right = wanted[:upright][::-1], wanted[upright + 1 :]
    step = min(_APART, (high - 90) / max(len(left), len(right), 1))
    over = _spread([180 - one for one in left], low, 90 - step, step) if left else []
    under = _spread(right, low, 90 - step, step) if right else []
    return [180 - one for one in over][::-1] + [90.0] + under, step


def _spread(wanted: list[float], low: float, high: float, step: float) -> list[float]:
    """The angles in falling order between the limits, each at least a step from the next."""
    found = [min(max(one, low), high) for one in wanted]
    if any(one - two < step for one, two in pairwise(found)):
        reach = step * (len(found) - 1) / 2
        middle = min(max(sum(found) / len(found), low + reach), high - reach)
        found = [middle + reach - step * at for at in range(len(found))]
    return found


def _path(
    link: Link, way: _Way | None, bond: int, ends: dict[tuple[int, int], Point], places: Places,
    boxes: Sequence[Box],
) -> tuple[Point, ...]:  # fmt: skip
    """The points from tail to head."""
    if way is not None:
        path = (ends[bond, way.upper], *way.bends, ends[bond, way.lower])
        return path if way.upper == link.tail else path[::-1]
    side = link.tail if places.sides[link.tail] != "middle" else link.head
    node = link.head if side == link.tail else link.tail
    y = places.at[node][1]
    outer, inner = boxes[side], boxes[node]
    if places.sides[side] == "right":
        path = ((inner.right + CLEAR, y), (outer.left - CLEAR, y))
    else:
        path = ((inner.left - CLEAR, y), (outer.right + CLEAR, y))
    return path if node == link.tail else path[::-1]

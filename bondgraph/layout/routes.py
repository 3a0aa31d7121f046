"""Lines of level and upright pieces from one rectangle to another: short, with few bends and crossings.

They enter no wall, touch no post, run along no line and cross as few of them as they can. Lines of one
key may run as one and branch off. The same request gives the same lines.
"""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from bondgraph.layout.boxes import Box, Point, around
from bondgraph.layout.cheapest import Route, cheapest, stem
from bondgraph.layout.grid import Grid, Line, grid
from bondgraph.layout.stubs import ALONG, Stub, Surroundings, stubs

WALL, POST, HEAD = 6.0, 2.5, 8.0
"""How far a line keeps off from walls, from posts, and from the arrows of other lines."""

CROSS, TOUCH = 60.0, 40.0
"""What crossing a given line, and crossing another of these lines, cost, in points."""

_WINDOW = 120.0
"""Lines are looked for so far round what they join, at first."""

_NEAR = 2.0
"""Channels nearer to each other than this are one."""


@dataclass(frozen=True)
class Wanted:
    """A line from one of some rectangles to one of others; lines of one ``key`` may share a stem."""

    sources: tuple[Box, ...]
    targets: tuple[Box, ...]
    key: Hashable


def routes(wanted: Sequence[Wanted], around_them: Surroundings) -> list[Route | None]:
    """A line for each that is wanted, the short ones first; None where there is no way."""
    order = sorted(range(len(wanted)), key=lambda at: (_apart(wanted[at]), at))
    done: dict[int, Route | None] = {}
    for at in order:
        others = [
            (wanted[one].key, route) for one, route in sorted(done.items()) if route is not None
        ]
        done[at] = None
        for window in (_WINDOW, 4 * _WINDOW):
            done[at] = done[at] or _route(wanted[at], around_them, others, window)
    return [done[at] for at in range(len(wanted))]


def _apart(one: Wanted) -> float:
    first, last = around(list(one.sources)), around(list(one.targets))
    return abs(first.left + first.right - last.left - last.right) + abs(
        first.top + first.bottom - last.top - last.bottom
    )


def _route(
    one: Wanted, near: Surroundings, others: list[tuple[Hashable, Route]], window: float
) -> Route | None:
    own = [route for key, route in others if key == one.key]
    foreign = [line for key, route in others if key != one.key for line in pairwise(route.path)]
    heads = [route.path[-1] for _, route in others]
    lines = [*near.lines, *(line for _, route in others for line in pairwise(route.path))]
    starts = list(stubs(one.sources, one.targets, near, lines))
    if not (starts or own):
        starts = list(stubs(one.sources, one.targets, near, lines, close=True))
    goals = list(stubs(one.targets, one.sources, near, lines))
    if not goals or not (starts or own):
        return None
    frame = around([*one.sources, *one.targets]).grown(window)
    stems = [piece for route in own for piece in stem(route.path)]
    channels = _channels(frame, near, [*starts, *goals], foreign, stems)
    _wall_in(channels, frame, near, foreign, heads)
    for line in (piece for route in own for piece in pairwise(route.path)):
        channels.keep_off(line, ALONG, 0.0)
    return cheapest(channels, starts, goals, stems)


def _channels(
    frame: Box, near: Surroundings, ends_of: Iterable[Stub], foreign: Iterable[Line],
    stems: Iterable[Line],
) -> Grid:  # fmt: skip
    """The grid of the places where a line may want to run: beside walls, stubs and other lines."""
    xs, ys = {frame.left, frame.right}, {frame.top, frame.bottom}
    for wall in near.walls:
        xs |= {wall.left - WALL - 1, wall.right + WALL + 1}
        ys |= {wall.top - WALL - 1, wall.bottom + WALL + 1}
    for first, last in foreign:
        xs |= {x + by for x, _ in (first, last) for by in (-ALONG - 1, ALONG + 1)}
        ys |= {y + by for _, y in (first, last) for by in (-ALONG - 1, ALONG + 1)}
    ends = [stub.outer for stub in ends_of] + [point for line in stems for point in line]
    return grid(
        [*_thinned(xs, frame.left, frame.right), *(x for x, _ in ends)],
        [*_thinned(ys, frame.top, frame.bottom), *(y for _, y in ends)],
    )


def _thinned(values: Iterable[float], low: float, high: float) -> list[float]:
    """Those between the bounds, none close behind the one before."""
    found: list[float] = []
    for value in sorted(values):
        if low <= value <= high and (not found or value - found[-1] >= _NEAR):
            found.append(value)
    return found


def _wall_in(
    channels: Grid, frame: Box, near: Surroundings, foreign: Iterable[Line], heads: Iterable[Point]
) -> None:
    for wall in near.walls:
        if wall.overlaps(frame):
            channels.block(wall.grown(WALL))
    for (x0, y0), (x1, y1) in near.posts:
        channels.block(Box(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)).grown(POST))
    for x, y in heads:
        channels.block(Box(x, y, x, y).grown(HEAD))
    for line in near.lines:
        channels.keep_off(line, ALONG, CROSS)
    for line in foreign:
        channels.keep_off(line, ALONG, TOUCH)

"""Lines of level and upright pieces from one rectangle to another: short, with few bends and crossings.

They enter no wall, touch no post, run along no line and cross as few of them as they can. Lines of one
key may run as one and branch off. The same request gives the same lines.
"""

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import pairwise
from math import inf

from bondgraph.layout.boxes import Box, Point, around
from bondgraph.layout.grid import Grid, Line, grid

STUB, FREE = 12.0, 3.0
"""A line leaves and reaches a rectangle straight from so far on; so much is left free before it."""

WALL, POST, ALONG = 6.0, 2.5, 5.0
"""How far a line keeps off from walls, from posts, and from lines that it runs along."""

BEND, CROSS, TOUCH, BRANCH = 25.0, 60.0, 40.0, 15.0
"""What a bend, crossing a given line, crossing another of these lines and branching off cost, in points."""

_WINDOW = 120.0
_SIDES: tuple[tuple[int, int], ...] = ((1, 0), (0, 1), (-1, 0), (0, -1))
_SPACING, _MOST, _HEAD = 14.0, 7, 8.0


_RANK = 0.01
"""What a later place round a rectangle counts more, so that of equals the first is taken."""

_State = tuple[int, int, int]
"""Row and column of the grid, and the way that leads there."""


@dataclass(frozen=True)
class Wanted:
    """A line from one of some rectangles to one of others; lines of one ``key`` may share a stem."""

    sources: tuple[Box, ...]
    targets: tuple[Box, ...]
    key: Hashable


@dataclass(frozen=True)
class Route:
    """The points of a line; ``branch``: whether it begins on another of its key."""

    path: tuple[Point, ...]
    branch: bool = False


@dataclass(frozen=True)
class Surroundings:
    """What lines have to mind: walls, lines that they may cross, posts that they must not touch."""

    walls: Sequence[Box]
    lines: Sequence[Line]
    posts: Sequence[Line]


@dataclass(frozen=True)
class _Stub:
    """Where a line can leave or reach a rectangle: near the edge, farther out, and the way out."""

    edge: Point
    outer: Point
    way: int


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
    starts = list(_stubs(one.sources, one.targets, near, lines))
    goals = list(_stubs(one.targets, one.sources, near, lines))
    if not goals or not (starts or own):
        return None
    frame = around([*one.sources, *one.targets]).grown(window)
    stems = [piece for route in own for piece in _stem(route.path)]
    channels = _channels(frame, near, [*starts, *goals], foreign, stems)
    _wall_in(channels, frame, near, foreign, heads)
    for line in (piece for route in own for piece in pairwise(route.path)):
        channels.keep_off(line, ALONG, 0.0)
    return _search(channels, starts, goals, stems)


def _stubs(
    boxes: Sequence[Box], others: Sequence[Box], near: Surroundings, lines: Sequence[Line]
) -> Iterator[_Stub]:
    """The places round the rectangles where a line can leave, or reach, them."""
    for box in boxes:
        for edge, way in _edges(box, others):
            inner, outer = _off(edge, way, FREE), _off(edge, way, STUB)
            own = around([Box(*inner, *inner), Box(*outer, *outer)]).grown(FREE)
            wide = own.grown(ALONG - FREE)
            if any(wall != box and own.overlaps(wall) for wall in near.walls):
                continue
            if any(wide.crossed(*line) for line in (*lines, *near.posts)):
                continue
            yield _Stub(inner, outer, way)


def _off(point: Point, way: int, by: float) -> Point:
    """The point so far off a side, to a hundredth as the grid has it."""
    dx, dy = _SIDES[way]
    return round(point[0] + by * dx, 2), round(point[1] + by * dy, 2)


def _edges(box: Box, others: Sequence[Box]) -> Iterator[tuple[Point, int]]:
    """Points on the sides of a rectangle, from the middle of each outwards, and the way out.

    Those first from which a straight line goes to the middle of another rectangle.
    """
    x, y = (box.left + box.right) / 2, (box.top + box.bottom) / 2
    aims = [(other.left + other.right) / 2 for other in others]
    for level in (aim for aim in aims if box.left + FREE < aim < box.right - FREE):
        yield (level, box.bottom), 1
        yield (level, box.top), 3
    yield (box.right, y), 0
    yield (box.left, y), 2
    most = min(int((box.right - box.left) / 2 / _SPACING - 0.25), _MOST)
    for at in sorted(range(-most, most + 1), key=abs):
        yield (x + at * _SPACING, box.bottom), 1
        yield (x + at * _SPACING, box.top), 3


def _channels(
    frame: Box, near: Surroundings, stubs: Iterable[_Stub], foreign: Iterable[Line],
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
    for first, last in stems:
        xs |= {first[0], last[0]}
        ys |= {first[1], last[1]}
    xs = {x for x in xs if frame.left <= x <= frame.right}
    ys = {y for y in ys if frame.top <= y <= frame.bottom}
    for stub in stubs:
        xs.add(stub.outer[0])
        ys.add(stub.outer[1])
    return grid(xs, ys)


def _wall_in(
    channels: Grid, frame: Box, near: Surroundings, foreign: Iterable[Line], heads: Iterable[Point]
) -> None:
    for wall in near.walls:
        if wall.overlaps(frame):
            channels.block(wall.grown(WALL))
    for (x0, y0), (x1, y1) in near.posts:
        channels.block(Box(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)).grown(POST))
    for x, y in heads:
        channels.block(Box(x, y, x, y).grown(_HEAD))
    for line in near.lines:
        channels.keep_off(line, ALONG, CROSS)
    for line in foreign:
        channels.keep_off(line, ALONG, TOUCH)


@dataclass
class _Search:
    """The cheapest way over places of a grid, those nearest to the goals first (Hart, Nilsson, Raphael)."""

    channels: Grid
    towards: Box
    heap: list[tuple[float, float, _State]] = field(default_factory=list)
    least: dict[_State, float] = field(default_factory=dict)
    came: "dict[_State, _State | _Stub]" = field(default_factory=dict)

    def offer(self, cost: float, state: _State, by: "_State | _Stub") -> None:
        """A way to a state, taken up if it is cheaper than what is known."""
        if cost < self.least.get(state, inf):
            self.least[state], self.came[state] = cost, by
            x, y = self.channels.xs[state[1]], self.channels.ys[state[0]]
            heappush(self.heap, (cost + _distance((x, y), self.towards), cost, state))

    def taken(self) -> Iterator[tuple[float, float, _State]]:
        """States in the order of what lines through them cost at least: that, the cost so far, the state."""
        while self.heap:
            least, cost, state = heappop(self.heap)
            if cost <= self.least[state]:
                yield least, cost, state

    def go_on(self, cost: float, state: _State) -> None:
        """Offer the neighbours of a state, all but the one that it came from."""
        channels, (row, column, way) = self.channels, state
        for turn, (dx, dy) in enumerate(_SIDES):
            to_row, to_column = row + dy, column + dx
            inside = 0 <= to_row < len(channels.ys) and 0 <= to_column < len(channels.xs)
            if turn == (way + 2) % 4 or not inside:
                continue
            edge = min(row, to_row), min(column, to_column)
            if (channels.level if dx else channels.upright)[edge]:
                continue
            long = abs(channels.xs[to_column] - channels.xs[column])
            long += abs(channels.ys[to_row] - channels.ys[row])
            long += float((channels.over if dx else channels.down)[edge])
            bend = BEND if turn != way else 0.0
            self.offer(cost + long + bend, (to_row, to_column, turn), state)


def _search(
    channels: Grid, starts: Sequence[_Stub], goals: Sequence[_Stub], stems: Sequence[Line]
) -> Route | None:
    """The cheapest line from a stub, or from a stem, to a stub."""
    ends: dict[tuple[int, int], tuple[int, _Stub]] = {}
    for rank, stub in enumerate(goals):
        ends.setdefault(channels.at(stub.outer), (rank, stub))
    search = _Search(channels, around([Box(*stub.outer, *stub.outer) for stub in goals]))
    for rank, stub in enumerate(starts):
        search.offer(STUB + _RANK * rank, (*channels.at(stub.outer), stub.way), stub)
    for point, way in _branches(stems, channels):
        search.offer(BRANCH, (*channels.at(point), way), _Stub(point, point, -1))
    best: tuple[float, _State, _Stub] | None = None
    for least, cost, state in search.taken():
        if best is not None and least >= best[0]:
            break
        if state[:2] in ends:
            rank, stub = ends[state[:2]]
            total = cost + _RANK * rank + (0 if state[2] == (stub.way + 2) % 4 else BEND)
            if state[2] != stub.way and (best is None or total < best[0]):
                best = (total, state, stub)
        search.go_on(cost, state)
    return None if best is None else _traced(search, best[1], best[2])


def _distance(point: Point, box: Box) -> float:
    """From a point to a rectangle, along level and upright lines."""
    across = max(box.left - point[0], 0.0, point[0] - box.right)
    return across + max(box.top - point[1], 0.0, point[1] - box.bottom)


def _stem(path: Sequence[Point]) -> list[Line]:
    """The pieces of a line from which others may branch off: not at its ends, nor at its arrow."""
    begin = _towards(path[0], path[1], STUB)
    end = _towards(path[-1], path[-2], 2 * STUB)
    return list(pairwise((begin, *path[1:-1], end)))


def _towards(point: Point, other: Point, by: float) -> Point:
    """The point moved so far towards another, at most to there."""
    (x, y), (to_x, to_y) = point, other
    return (
        x + max(-by, min(by, to_x - x)),
        y + max(-by, min(by, to_y - y)),
    )


def _branches(stems: Sequence[Line], channels: Grid) -> Iterator[tuple[Point, int]]:
    """Every place of the grid on a stem, and the ways off it."""
    for (x0, y0), (x1, y1) in stems:
        if y0 == y1 and y0 in channels.ys:
            inside = [x for x in channels.xs if min(x0, x1) < x < max(x0, x1)]
            yield from (((x, y0), way) for x in inside for way in (1, 3))
        elif x0 == x1 and x0 in channels.xs:
            inside = [y for y in channels.ys if min(y0, y1) < y < max(y0, y1)]
            yield from (((x0, y), way) for y in inside for way in (0, 2))


def _traced(search: _Search, state: _State, goal: _Stub) -> Route:
    """The points back from the goal, those alone at which the line bends."""
    channels, points = search.channels, [goal.edge]
    at: _State | _Stub = state
    while not isinstance(at, _Stub):
        points.append((channels.xs[at[1]], channels.ys[at[0]]))
        at = search.came[at]
    if at.way >= 0:
        points.append(at.edge)
    points = points[::-1]
    kept = [points[0]]
    for before, point, after in zip(points, points[1:], points[2:], strict=False):
        if not (before[0] == point[0] == after[0] or before[1] == point[1] == after[1]):
            kept.append(point)
    return Route((*kept, points[-1]), branch=at.way < 0)

"""The cheapest line over the crossings of a grid, by length, bends and what it crosses."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import pairwise
from math import inf

from bondgraph.layout.boxes import Box, Point, around
from bondgraph.layout.grid import Grid, Line
from bondgraph.layout.stubs import SIDES, STUB, Stub

BEND, BRANCH = 25.0, 15.0
"""What a bend, and branching off from another line, cost, in points."""

_RANK = 0.01
"""What a later place round a rectangle counts more, so that of equals the first is taken."""

_State = tuple[int, int, int]
"""Row and column of the grid, and the way that leads there."""


@dataclass(frozen=True)
class Route:
    """The points of a line; ``branch``: whether it begins on another of its key."""

    path: tuple[Point, ...]
    branch: bool = False


@dataclass
class _Search:
    """The cheapest way over places of a grid, those nearest to the goals first (Hart, Nilsson, Raphael)."""

    channels: Grid
    towards: Box
    walls: "tuple[list[list[bool]], list[list[bool]]]"
    costs: "tuple[list[list[float]], list[list[float]]]"
    heap: list[tuple[float, float, _State]] = field(default_factory=list)
    least: dict[_State, float] = field(default_factory=dict)
    came: "dict[_State, _State | Stub]" = field(default_factory=dict)

    def offer(self, cost: float, state: _State, by: "_State | Stub") -> None:
        """A way to a state, taken up if it is cheaper than what is known."""
        if cost < self.least.get(state, inf):
            self.least[state], self.came[state] = cost, by
            heappush(self.heap, (cost + self._to_come(state), cost, state))

    def _to_come(self, state: _State) -> float:
        """What the rest of the line costs at least: the distance, and a bend if its way leads past."""
        row, column, way = state
        x, y, goal = self.channels.xs[column], self.channels.ys[row], self.towards
        across = max(goal.left - x, 0.0, x - goal.right)
        down = max(goal.top - y, 0.0, y - goal.bottom)
        return across + down + (BEND if (across if way % 2 else down) else 0.0)

    def taken(self) -> Iterator[tuple[float, float, _State]]:
        """States in the order of what lines through them cost at least: that, the cost so far, the state."""
        while self.heap:
            least, cost, state = heappop(self.heap)
            if cost <= self.least[state]:
                yield least, cost, state

    def go_on(self, cost: float, state: _State) -> None:
        """Offer the neighbours of a state, all but the one that it came from."""
        (row, column, way), xs, ys = state, self.channels.xs, self.channels.ys
        for turn, (dx, dy) in enumerate(SIDES):
            to_row, to_column = row + dy, column + dx
            inside = 0 <= to_row < len(ys) and 0 <= to_column < len(xs)
            if turn == (way + 2) % 4 or not inside:
                continue
            kind, above, before = turn % 2, min(row, to_row), min(column, to_column)
            if self.walls[kind][above][before]:
                continue
            long = abs(xs[to_column] - xs[column]) + abs(ys[to_row] - ys[row])
            long += self.costs[kind][above][before] + (BEND if turn != way else 0.0)
            self.offer(cost + long, (to_row, to_column, turn), state)


def cheapest(
    channels: Grid, starts: Sequence[Stub], goals: Sequence[Stub], stems: Sequence[Line]
) -> Route | None:
    """The cheapest line from a stub, or from a stem, to a stub."""
    ends: dict[tuple[int, int], tuple[int, Stub]] = {}
    for rank, stub in enumerate(goals):
        ends.setdefault(channels.at(stub.outer), (rank, stub))
    search = _Search(
        channels,
        around([Box(*stub.outer, *stub.outer) for stub in goals]),
        (channels.level.tolist(), channels.upright.tolist()),
        (channels.over.tolist(), channels.down.tolist()),
    )
    for rank, stub in enumerate(starts):
        search.offer(STUB + _RANK * rank, (*channels.at(stub.outer), stub.way), stub)
    for point, way in _branches(stems, channels):
        search.offer(BRANCH, (*channels.at(point), way), Stub(point, point, -1))
    best: tuple[float, _State, Stub] | None = None
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


def stem(path: Sequence[Point]) -> list[Line]:
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


def _traced(search: _Search, state: _State, goal: Stub) -> Route:
    """The points back from the goal, those alone at which the line bends."""
    channels, points = search.channels, [goal.edge]
    at: _State | Stub = state
    while not isinstance(at, Stub):
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

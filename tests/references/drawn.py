"""What must not touch in a picture, by its lines and rectangles alone."""

from collections.abc import Iterator
from itertools import combinations, pairwise
from typing import Any

from bondgraph.drawing.shapes import BondShape, Scene, SignalShape
from bondgraph.layout.boxes import Box, Point


def boxes(scene: Scene) -> list[tuple[str, Box]]:
    """Every label of a picture: what it says and what it fills."""
    labels = [label for node in scene.nodes for label in node.labels]
    labels += [label for bond in scene.bonds for label in bond.labels] + list(scene.notes)
    labels += [label for signal in scene.signals for label in signal.labels]
    return [("".join(run.text for run in label.rich), label.box) for label in labels]


def lines(scene: Scene) -> Iterator[tuple[Any, Point, Point]]:
    """Every straight line of every bond."""
    for bond in scene.bonds:
        for first, last in zip(bond.path, bond.path[1:], strict=False):
            yield bond.ends, first, last
        yield from ((bond.ends, *mark) for mark in marks(bond))
    for signal in scene.signals:
        for first, last in [*pairwise(signal.path), *arrow(signal)]:
            yield (signal.source, signal.reader), first, last


def marks(bond: BondShape) -> list[tuple[Point, Point]]:
    """The barbs and the stroke of a bond."""
    found = [(bond.path[-1], one) for one in (bond.barb, bond.other) if one]
    return [*found, *([bond.stroke] if bond.stroke else [])]


def arrow(signal: SignalShape) -> list[tuple[Point, Point]]:
    """The three sides of a signal's arrow."""
    return [*((signal.path[-1], one) for one in signal.barbs), signal.barbs]


def meet(one: tuple[Point, Point], two: tuple[Point, Point]) -> bool:
    """Whether two lines cross inside both (each has its ends on both sides of the other)."""
    (a, b), (c, d) = one, two

    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def along(one: tuple[Point, Point], two: tuple[Point, Point]) -> bool:
    """Whether two level, or two upright, lines run beside each other nearer than two points."""
    for way in (0, 1):
        flat = all(abs(line[0][1 - way] - line[1][1 - way]) < 1e-6 for line in (one, two))
        if flat and abs(one[0][1 - way] - two[0][1 - way]) < 2:
            (a, b), (c, d) = (sorted(end[way] for end in line) for line in (one, two))
            return min(b, d) - max(a, c) > 1e-6
    return False


def in_the_way(scene: Scene) -> list[tuple[object, object]]:
    """Signals through strokes and half arrows, arrows on bonds, signals along bonds or each other."""
    found: list[tuple[object, object]] = []
    for at, signal in enumerate(scene.signals):
        name = (signal.source, signal.reader)
        own = list(pairwise(signal.path))
        for bond in scene.bonds:
            path = list(pairwise(bond.path))
            found += [(name, bond.ends) for a in own for b in marks(bond) if meet(a, b)]
            found += [
                (name, bond.ends)
                for a in arrow(signal)
                for b in [*path, *marks(bond)]
                if meet(a, b)
            ]
            found += [(name, bond.ends) for a in own for b in path if along(a, b)]
        for other in scene.signals[at + 1 :]:
            theirs = list(pairwise(other.path))
            found += [(name, other.reader) for a in own for b in theirs if along(a, b)]
            found += [(name, other.reader) for a in arrow(signal) for b in theirs if meet(a, b)]
            found += [(name, other.reader) for a in arrow(other) for b in own if meet(a, b)]
    return found


def touching(scene: Scene) -> list[tuple[object, object]]:
    """Labels that overlap, lines through labels, lines through frames, frames on others' labels."""
    texts = boxes(scene)
    found: list[tuple[object, object]] = [
        (one, two) for (one, a), (two, b) in combinations(texts, 2) if a.overlaps(b)
    ]
    for ends, first, last in lines(scene):
        found += [(ends, text) for text, box in texts if box.crossed(first, last)]
    for node in scene.nodes:
        if node.frame is not None:
            own = {label.box for label in node.labels}
            found += [
                (node.name, text)
                for text, box in texts
                if box not in own and box.overlaps(node.frame)
            ]
            found += [(node.name, e) for e, a, b in lines(scene) if node.frame.crossed(a, b)]
    return found

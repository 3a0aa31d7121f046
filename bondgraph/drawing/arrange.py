"""Where nodes lie and bonds run in the whole picture: each connected part laid out, parts side by side."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import sqrt

import networkx as nx

from bondgraph.drawing.blocks import placed_blocks
from bondgraph.drawing.ends import bond_paths
from bondgraph.drawing.marks import corners, moved
from bondgraph.drawing.places import Room, as_reckoned, places
from bondgraph.drawing.shapes import NodeShape
from bondgraph.drawing.subject import Subject
from bondgraph.layout.boxes import Box, Point, around, turned

PART_GAP = 40.0
"""Between parts that no bond joins."""

PAGE, ASPECT = 900.0, 3.0
"""Parts fill a row up to a page's width, or until the picture is so many times as wide as high."""

CHAIN = 5
"""So many layers of one node each are a chain, which is drawn from left to right."""

TALL = 2.0
"""What is more than so many times as high as wide is drawn from left to right, too."""


_BESIDE = 1.5
"""The name of a junction is at least so far from bonds."""


@dataclass(frozen=True)
class Arranged:
    """Nodes by their places in the subject, the points of every bond, and nodes in reading order."""

    nodes: tuple[NodeShape, ...]
    paths: tuple[tuple[Point, ...], ...]
    order: tuple[int, ...]
    chain: bool

    @property
    def box(self) -> Box:
        """What all of it fills."""
        points = [point for path in self.paths for point in path]
        return around([node.box for node in self.nodes] + [Box(x, y, x, y) for x, y in points])


def arranged(subject: Subject, room: Room) -> Arranged:
    """The whole graph: blocks of signals, then every part by itself, in rows in the order of first nodes."""
    parts = _parts(subject)
    done = [_part(subject, part, room) for part in parts]
    if blocks := [at for at, item in enumerate(subject.items) if item.block]:
        parts.insert(0, blocks)
        done.insert(0, _blocks(subject, blocks, room))
    if len(done) == 1:
        return done[0]
    boxes = [one.box for one in done]
    gap = PART_GAP * room.wide
    area = sum((box.right - box.left + gap) * (box.bottom - box.top + gap) for box in boxes)
    limit = max(PAGE, sqrt(ASPECT * area))
    low = _level(subject, parts, done)
    if boxes[0].right - boxes[0].left + gap + boxes[1].right - boxes[1].left > limit:
        low = {}
    nodes: dict[int, NodeShape] = {}
    paths: dict[int, tuple[Point, ...]] = {}
    order: list[int] = []
    x = y = high = 0.0
    for at, (part, one, box) in enumerate(zip(parts, done, boxes, strict=True)):
        wide = box.right - box.left
        if x and x + wide > limit:
            x, y, high = 0.0, y + high + gap, 0.0
        by = (x - box.left, y - box.top + low.get(at, 0.0))
        nodes.update(zip(part, (moved(node, by) for node in one.nodes), strict=True))
        own = [at for at, link in enumerate(subject.links) if link.tail in set(part)]
        for link, path in zip(own, one.paths, strict=True):
            paths[link] = tuple((px + by[0], py + by[1]) for px, py in path)
        order += [part[at] for at in one.order]
        x, high = x + wide + gap, max(high, box.bottom - box.top + low.get(at, 0.0))
    return Arranged(
        tuple(nodes[at] for at in range(len(nodes))),
        tuple(paths[at] for at in range(len(paths))),
        tuple(order),
        any(one.chain for one in done),
    )


def _level(
    subject: Subject, parts: Sequence[Sequence[int]], done: Sequence[Arranged]
) -> dict[int, float]:
    """How much lower the blocks, or the part beside them, lie for the first signal to it to run straight."""
    for one in subject.signals:
        if subject.items[one.source].block and one.source in parts[0] and one.reader in parts[1]:
            downs = []
            for part, found, item in zip(parts, done, (one.source, one.reader), strict=False):
                box = found.nodes[part.index(item)].box
                downs.append((box.top + box.bottom) / 2 - found.box.top)
            down = round(downs[1] - downs[0], 2)
            return {0: max(down, 0.0), 1: max(-down, 0.0)}
    return {}


def lies_across(found: Arranged) -> bool:
    """Whether what was laid out downwards is better drawn from left to right: chains, and what is tall."""
    box = found.box
    return found.chain or box.bottom - box.top > TALL * max(box.right - box.left, PAGE / TALL)


def _parts(subject: Subject) -> list[list[int]]:
    """The items of every part that bonds connect, in order."""
    joined: nx.Graph[int] = nx.Graph()
    joined.add_nodes_from(at for at, item in enumerate(subject.items) if not item.block)
    joined.add_edges_from((link.tail, link.head) for link in subject.links)
    return sorted(sorted(part) for part in nx.connected_components(joined))


def _part(whole: Subject, part: Sequence[int], room: Room) -> Arranged:
    number = {item: at for at, item in enumerate(part)}
    own = _within(whole, number)
    beside = {number[item]: long for item, long in room.beside.items() if item in number}
    placed = places(own, replace(room, beside=beside))
    items = range(len(own.items))
    to = turned if room.across else _same
    nodes = [moved(placed.shapes[at], to(placed.at[at])) for at in items]
    boxes = [as_reckoned(nodes[at], room.across, own.items[at].junction) for at in items]
    paths = tuple(tuple(map(to, path)) for path in bond_paths(own, placed, boxes))
    if room.across:
        nodes = _named_aside(own, nodes, paths)
    return Arranged(
        tuple(nodes),
        paths,
        tuple(sorted(items, key=lambda at: placed.at[at][::-1])),
        len(placed.layers) >= CHAIN and all(len(layer) == 1 for layer in placed.layers),
    )


def _blocks(whole: Subject, blocks: Sequence[int], room: Room) -> Arranged:
    """The blocks of signals, which no bond joins."""
    shapes = placed_blocks(whole, blocks, room)
    order = sorted(range(len(blocks)), key=lambda at: (shapes[at].box.left, shapes[at].box.top))
    return Arranged(tuple(shapes), (), tuple(order), chain=False)


def _named_aside(
    subject: Subject, nodes: Sequence[NodeShape], paths: Sequence[tuple[Point, ...]]
) -> list[NodeShape]:
    """The nodes with the names of junctions in corners where no bond runs and no label stands."""
    lines = [line for path in paths for line in pairwise(path)]
    found = list(nodes)
    for at, item in enumerate(subject.items):
        if item.junction and item.beside:
            others = [label.box for to, one in enumerate(found) if to != at for label in one.labels]
            tried = list(corners(found[at]))
            free = (one for one in tried if _free(one.labels[1].box.grown(_BESIDE), lines, others))
            found[at] = next(free, tried[0])
    return found


def _free(box: Box, lines: Sequence[tuple[Point, Point]], others: Sequence[Box]) -> bool:
    crossed = any(box.crossed(*line) for line in lines)
    return not crossed and not any(box.overlaps(other) for other in others)


def _within(whole: Subject, number: Mapping[int, int]) -> Subject:
    """The part of the graph that has these items."""
    links = [
        replace(
            link,
            tail=number[link.tail],
            head=number[link.head],
            receiver=None if link.receiver is None else number[link.receiver],
        )
        for link in whole.links
        if link.tail in number
    ]
    return Subject(tuple(whole.items[item] for item in number), tuple(links))


def _same(point: Point) -> Point:
    return point

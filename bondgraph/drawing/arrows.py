"""Signals as they are drawn: thin lines with full arrows that touch no label, stroke or half arrow."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from bondgraph.drawing.bonds import barbs
from bondgraph.drawing.powers import Crowd, Wish
from bondgraph.drawing.shapes import BondShape, Label, NodeShape, SignalShape
from bondgraph.drawing.subject import Signal, Subject
from bondgraph.layout.boxes import Box
from bondgraph.layout.cheapest import Route
from bondgraph.layout.routes import Wanted, routes
from bondgraph.layout.stubs import Surroundings

HEAD_BACK, HEAD_OUT = 7.0, 2.6
"""Length and half the width of a signal's arrow."""


def signal_shapes(
    subject: Subject, nodes: Sequence[NodeShape], bonds: Sequence[BondShape], names: bool
) -> tuple[tuple[SignalShape, ...], bool]:
    """Every signal that finds a way, and whether all did, with a free place for their ``names``."""
    wanted = [
        Wanted(_boxes(nodes[one.source]), _boxes(nodes[one.reader]), (one.source, one.names))
        for one in subject.signals
    ]
    found = routes(wanted, _surroundings(nodes, bonds)) if wanted else []
    made = [
        _shape(nodes, one, route)
        for one, route in zip(subject.signals, found, strict=True)
        if route is not None
    ]
    crowd = Crowd(nodes, bonds, made)
    if names:
        texts = [one.names for one, way in zip(subject.signals, found, strict=True) if way]
        made = [
            one
            if one.branch
            else replace(one, labels=crowd.put(one.path, [Wish(rich, (-1.0, 1.0))]))
            for one, rich in zip(made, texts, strict=True)
        ]
    return tuple(made), crowd.clean and None not in found


def _boxes(node: NodeShape) -> tuple[Box, ...]:
    """What a line may begin and end at."""
    if node.frame is not None:
        return (node.frame,)
    return tuple(label.box for label in node.labels if label.rich)


def _surroundings(nodes: Sequence[NodeShape], bonds: Sequence[BondShape]) -> Surroundings:
    walls = [box for node in nodes for box in _boxes(node)]
    labels: list[Label] = [label for bond in bonds for label in bond.labels]
    lines = [line for bond in bonds for line in pairwise(bond.path)]
    posts = [(bond.path[-1], one) for bond in bonds for one in (bond.barb, bond.other) if one]
    posts += [bond.stroke for bond in bonds if bond.stroke]
    return Surroundings([*walls, *(label.box for label in labels)], lines, posts)


def _shape(nodes: Sequence[NodeShape], signal: Signal, route: Route) -> SignalShape:
    path = route.path
    return SignalShape(
        nodes[signal.source].name,
        nodes[signal.reader].name,
        path,
        barbs(path[-1], path[-2], HEAD_BACK, HEAD_OUT),
        route.branch,
    )

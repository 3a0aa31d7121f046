"""Layers: which nodes lie beside a junction, and in which layer each of the others lies."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import networkx as nx

from bondgraph.drawing.subject import Subject
from bondgraph.layout.tight import extremes


@dataclass(frozen=True)
class Layers:
    """``beside``: junction to the one-ports right and left of it. ``graph``: the rest, every edge from
    one layer to the next; vertices from the number of items on are bends of long bonds.

    ``paths``: tail and head of a bond to the vertices on its way, from top to bottom.
    """

    beside: Mapping[int, tuple[int, ...]]
    graph: "nx.DiGraph[int]"
    layers: tuple[tuple[int, ...], ...]
    paths: Mapping[tuple[int, int], tuple[int, ...]]


def layered(subject: Subject) -> Layers:
    """Every node in its layer, sources above, so that bonds are short and go down where they can."""
    down = _downwards(subject)
    beside = _beside(subject, down)
    down.remove_nodes_from([item for own in beside.values() for item in own])
    ranks = _ranks(down)
    graph: nx.DiGraph[int] = nx.DiGraph()
    graph.add_nodes_from(down)
    layers: list[list[int]] = [[] for _ in range(max(ranks.values()) + 1)]
    for node in nx.dfs_preorder_nodes(down):
        layers[ranks[node]].append(node)
    paths: dict[tuple[int, int], tuple[int, ...]] = {}
    new = len(subject.items)
    for upper, lower in down.edges:
        bends = range(new, new + ranks[lower] - ranks[upper] - 1)
        new += len(bends)
        paths[upper, lower] = (upper, *bends, lower)
        nx.add_path(graph, paths[upper, lower])
        for at, bend in enumerate(bends, ranks[upper] + 1):
            layers[at].append(bend)
    return Layers(
        MappingProxyType(beside),
        nx.freeze(graph),
        tuple(map(tuple, layers)),
        MappingProxyType(paths),
    )


def _downwards(subject: Subject) -> "nx.DiGraph[int]":
    """The bonds away from the first source, and as they point where that does not tell; without cycles."""
    places = range(len(subject.items))
    first = next((at for at in places if subject.items[at].kind.supplies), None)
    bonds: nx.Graph[int] = nx.Graph()
    bonds.add_edges_from((link.tail, link.head) for link in subject.links)
    far = {} if first is None else nx.single_source_shortest_path_length(bonds, first)
    graph: nx.DiGraph[int] = nx.DiGraph()
    graph.add_nodes_from([] if first is None else [first])
    graph.add_nodes_from(places)
    for link in subject.links:
        up = far.get(link.tail, 0) > far.get(link.head, 0)
        graph.add_edge(*((link.head, link.tail) if up else (link.tail, link.head)))
    place = {node: at for at, node in enumerate(_preorder(graph))}
    turned = [(tail, head) for tail, head in graph.edges if place[tail] > place[head]]
    graph.remove_edges_from(turned)
    graph.add_edges_from((head, tail) for tail, head in turned)
    return graph


def _preorder(graph: "nx.DiGraph[int]") -> list[int]:
    """The nodes in an order in which bonds lead on, those that close a cycle excepted."""
    return list(nx.dfs_postorder_nodes(graph))[::-1]


def _beside(subject: Subject, down: "nx.DiGraph[int]") -> dict[int, tuple[int, ...]]:
    """The one-ports that lie left and right of their junctions."""
    found: dict[int, tuple[int, ...]] = {}
    for node, item in enumerate(subject.items):
        if not item.junction:
            continue
        above, below = list(down.predecessors(node)), list(down.successors(node))
        ports = [port for port in above + below if subject.items[port].one_port]
        sources = [port for port in ports if port in above]
        if sources and len(sources) == len(above):
            ports.remove(sources[0])  # the first source stays on top
        ports.sort(key=lambda port: subject.items[port].kind.nature.place)
        others = len(above) + len(below) - len(ports)
        if not others and ports:
            ports = ports[:-1]
        hangs = len(ports) == 2 and not set(below) - set(ports)
        found[node] = tuple(ports[: 1 if hangs else 2])
    return {node: ports for node, ports in found.items() if ports}


def _ranks(down: "nx.DiGraph[int]") -> dict[int, int]:
    """The layer of every node, the least sum of bond lengths, each as far up as that allows."""
    number = {node: at for at, node in enumerate(down)}
    gaps = [(number[upper], number[lower], 1.0) for upper, lower in down.edges]
    low, _ = extremes(len(number), gaps, [(*gap, 0.0) for gap in gaps])
    return {node: low[at] - min(low) for node, at in number.items()}

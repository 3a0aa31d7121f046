"""Graphs in short form, and the same graph written in another way."""

from __future__ import annotations

import random
import re
from collections.abc import Collection, Hashable, Iterable, Mapping
from typing import Any

import networkx as nx

Graph = nx.DiGraph
Node = tuple[Hashable, dict[str, object]]


def bond_graph(nodes: Iterable[Node], bonds: str) -> Graph:
    """The graph of these nodes and of bonds in the form ``"a>b>c a>d"``."""
    graph: Graph = nx.DiGraph()
    graph.add_nodes_from(nodes)
    declared = set(graph)
    for path in bonds.split():
        nx.add_path(graph, path.split(">"))
    if unknown := set(graph) - declared:
        raise ValueError(f"bonds name nodes that are not declared: {sorted(map(str, unknown))}")
    return graph


def shuffled(graph: Graph, rng: random.Random) -> Graph:
    """The same graph, nodes and bonds declared in random order."""
    nodes, edges = list(graph.nodes(data=True)), list(graph.edges)
    rng.shuffle(nodes)
    rng.shuffle(edges)
    return _graph(nodes, edges)


def turned(graph: Graph, bonds: Collection[tuple[Hashable, Hashable]]) -> Graph:
    """The same graph with these bonds drawn in the opposite direction."""
    edges = [(head, tail) if (tail, head) in bonds else (tail, head) for tail, head in graph.edges]
    return _graph(list(graph.nodes(data=True)), edges)


def renamed(graph: Graph, nodes: Mapping[Hashable, str], symbols: Mapping[str, str]) -> Graph:
    """The same graph under other node names, and other symbols in its text attributes."""

    def text(key: str, value: Any) -> Any:
        if key == "kind" or not isinstance(value, str):
            return value
        return re.sub(r"[A-Za-z_]\w*", lambda word: symbols.get(word[0], word[0]), value)

    new = [
        (nodes[name], {key: text(key, value) for key, value in attributes.items()})
        for name, attributes in graph.nodes(data=True)
    ]
    return _graph(new, [(nodes[tail], nodes[head]) for tail, head in graph.edges])


def _graph(nodes: list[Any], edges: list[Any]) -> Graph:
    graph: Graph = nx.DiGraph()
    graph.add_nodes_from((name, dict(attributes)) for name, attributes in nodes)
    graph.add_edges_from(edges)
    return graph

"""Arrows that most likely point the wrong way: out of storages, into every source, sums for differences."""

from collections.abc import Hashable, Iterator

import networkx as nx

from bondgraph.checking.records import Finding
from bondgraph.nodes.elements import Element


def arrows_doubted(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    """What is to be asked about the arrows of a validated graph."""
    yield from _out_of_what_absorbs(graph)
    yield from _into_all_sources(graph)
    yield from _from_nowhere(graph)


def _out_of_what_absorbs(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    """Bonds drawn out of storages, resistances, switches or detectors."""
    for tail, head, attributes in graph.edges(data=True):
        first, last = attributes["declared"]
        turned = (_element(graph, tail).owner or tail) != first
        element, other = (_element(graph, n) for n in ((head, tail) if turned else (tail, head)))
        # Between two that absorb the arrow has to point into one of them.
        if not element.absorbs or (not turned and other.absorbs):
            continue
        way_out = f"draw the bond as {last!r} -> {first!r}"
        if other.kind.two_port:
            way_out = (
                f"put a junction between, or turn both bonds of {last!r} and invert its modulus"
            )
        yield Finding(
            "doubt", "arrow",
            f"the arrow {first!r} -> {last!r} points out of {_told(element)}, "
            "as if it supplied power; power counts into it all the same",
            way_out, bond=(first, last),
        )  # fmt: skip


def _told(element: Element) -> str:
    """A one-port as its declaration calls it."""
    kind = element.declared or element.kind
    return f"{kind} {(element.owner or element.whole or element.name)!r}"


def _into_all_sources(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    sources = _sources(graph)
    if sources and all(graph.in_degree(name) for name in sources):
        name = sources[0]
        kind = _element(graph, name).kind
        yield Finding(
            "doubt", "source",
            f"no source supplies power: all arrows point into them, so that a positive {kind} {name!r} "
            "pulls where it was meant to push",
            "turn the bonds of the sources that drive", node=name,
        )  # fmt: skip


def _sources(graph: "nx.DiGraph[Hashable]") -> list[Hashable]:
    """The sources of power; what gives a signal is none."""
    elements = [_element(graph, name) for name in graph]
    return [one.name for one in elements if one.kind.supplies and not one.of_signals]


def _from_nowhere(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    """Junctions between two of the other kind whose arrows make a sum of what should be a difference.

    Only where one of the two is the supply: along the arrows no power of a source comes to the other's
    storages. Sums through transformers are kinematics and may be meant so.
    """
    sources = [name for name in _sources(graph) if graph.out_degree(name)]
    reached: set[Hashable] = set(sources)
    for name in sources:
        reached |= nx.descendants(graph, name)
    for tail, head in graph.edges:
        if head not in reached or tail in reached:
            continue
        middle = next((n for n in (head, tail) if _adds(graph, n)), None)
        stored = [n for n in _behind(graph, reached, tail) if _element(graph, n).kind.stores]
        if middle is None or not stored:
            continue
        first, last = graph.edges[tail, head]["declared"]
        named = ", ".join(repr(_element(graph, n).owner or n) for n in stored)
        kind = _element(graph, middle).kind
        what = "flows" if kind.common == "effort" else "efforts"
        yield Finding(
            "doubt", "supply",
            f"by the arrow {first!r} -> {last!r} power comes from {named}, which no source supplies, and "
            f"{kind.word} {middle!r} takes the sum of two {what} in place of their difference",
            f"draw the bond as {last!r} -> {first!r}", bond=(first, last),
        )  # fmt: skip


def _adds(graph: "nx.DiGraph[Hashable]", name: Hashable) -> bool:
    """Whether a junction joins two of the other kind, and arrows of both point into it, or out of it."""
    kind = _element(graph, name).kind
    if not kind.joins:
        return False
    others = [n for n in nx.all_neighbors(graph, name) if not _element(graph, n).absorbs]
    inward = sum(graph.has_edge(n, name) for n in others)
    kinds = [_element(graph, n).kind for n in others]
    opposite = all(one.joins and one.common != kind.common for one in kinds)
    return len(others) == 2 and opposite and inward in (0, 2)


def _behind(
    graph: "nx.DiGraph[Hashable]", reached: set[Hashable], start: Hashable
) -> list[Hashable]:
    """All nodes that hang together with one, without those that are reached."""
    rest = graph.subgraph(name for name in graph if name not in reached).to_undirected(as_view=True)
    found = nx.node_connected_component(rest, start)
    return [name for name in graph if name in found]


def _element(graph: "nx.DiGraph[Hashable]", name: Hashable) -> Element:
    found: Element = graph.nodes[name]["element"]
    return found

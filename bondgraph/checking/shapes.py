"""Junctions that say nothing: of one bond, of two that only hand on, and beside others of their kind."""

from collections.abc import Hashable, Iterator
from typing import Any

import networkx as nx

from bondgraph.checking.merging import Merger
from bondgraph.checking.records import Finding


def junctions_doubted(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    """Junctions of one bond; of a validated graph."""
    for name in graph:
        kind = graph.nodes[name]["element"].kind
        if not kind.joins:
            continue
        zero = kind.common == "effort"
        if graph.degree(name) == 1:
            yield Finding(
                "doubt", "one bond",
                f"{kind.word} {name!r} has one bond only, whose {'flow' if zero else 'effort'} is zero",
                "bond what is missing to it, or remove it with its bond", node=name,
            )  # fmt: skip


def junctions_simpler(graph: Any) -> Iterator[Finding]:
    """Junctions that `merged` would take out; of a declared graph."""
    merger = Merger(graph)
    for name in graph:
        kind = merger.kind(name)
        if not kind.joins:
            continue
        if merger.passes(name):
            first, second = merger.neighbours(name)
            yield Finding(
                "hint", "pass-through",
                f"{kind.word} {name!r} has two bonds and only hands on, from {first!r} to {second!r}",
                f"bond {first!r} to {second!r}, as bondgraph.merged does", node=name,
            )  # fmt: skip
        for other in merger.same_kind_after(name):
            yield Finding(
                "hint", "same kind",
                f"{kind.word}s {name!r} and {other!r} are bonded: they share one {kind.common}",
                "make them one junction, as bondgraph.merged does", bond=merger.declared(name, other),
            )  # fmt: skip

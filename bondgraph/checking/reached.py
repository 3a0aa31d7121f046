"""Modes of state machines that no transition leads to."""

from collections.abc import Hashable, Iterator

import networkx as nx

from bondgraph.checking.records import Finding
from bondgraph.nodes.elements import Element


def modes_doubted(graph: "nx.DiGraph[Hashable]") -> Iterator[Finding]:
    """Modes that a run comes to only where it begins in them; of a validated graph."""
    elements: list[Element] = [graph.nodes[name]["element"] for name in graph]
    taken = [one.switch.transition for one in elements if one.switch is not None]
    for machine in (one.machine for one in elements if one.machine is not None):
        ways: nx.DiGraph[str] = nx.DiGraph()
        ways.add_nodes_from(machine.modes)
        ways.add_edges_from(
            (one.source, one.target) for one in taken if one is not None and one.machine == machine
        )
        reached = {machine.start, *nx.descendants(ways, machine.start)}
        for mode in machine.modes:
            if mode not in reached:
                yield Finding(
                    "doubt", "mode",
                    f"no transition leads from {machine.start!r} to the mode {mode!r} of {machine.name!r}",
                    "write one, or remove the mode", node=machine.name,
                )  # fmt: skip

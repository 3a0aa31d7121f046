"""Networks with diodes as bond graphs, and how a run of one differs from what the judge finds."""

from collections.abc import Hashable, Sequence

import networkx as nx
import numpy as np
from references.diode_networks import Branch, Network, Oracle

import bondgraph as bg
from codegen import Result

MOMENT = 1e-5
"""From complete rest a diode turns on only after a moment, 1e-6 of the run [s]."""


def as_graph(network: Network) -> "nx.DiGraph[Hashable]":
    """A 0-junction a node, a 1-junction a branch."""
    graph: nx.DiGraph[Hashable] = nx.DiGraph()
    graph.add_nodes_from(bg.Zero(f"n{k}") for k in range(1, network.nodes + 1))
    for b in network.branches:
        graph.add_nodes_from([bg.One(f"{b.name}_way"), _element(b)])
        # A diode's bond points into it, a source's out of it: from ground by way of it to its head.
        ends = (b.name, f"{b.name}_way")
        graph.add_edge(*(ends if b.kind == "S" else ends[::-1]))
        if b.more:
            graph.add_nodes_from([bg.R(f"{b.name}_r", b.more)])
            graph.add_edge(f"{b.name}_way", f"{b.name}_r")
        if b.tail:
            graph.add_edge(f"n{b.tail}", f"{b.name}_way")
        if b.head:
            graph.add_edge(f"{b.name}_way", f"n{b.head}")
    return graph


def _element(b: Branch) -> bg.declare.elements.Node:
    if b.kind == "S":
        return bg.Se(b.name, f"u_{b.name}")
    if b.kind == "D":
        return bg.Sw(b.name, on=f"e_{b.name}", off=f"-f_{b.name}")
    if b.kind == "C":
        return bg.C(b.name, b.value, effort=f"u_{b.name}")
    return bg.I(b.name, b.value, flow=f"i_{b.name}") if b.kind == "L" else bg.R(b.name, b.value)


Found = tuple[dict[str, np.ndarray], Sequence[tuple[float, str, str]]]
"""Voltages and currents by name, and events, as `Oracle.run` gives them."""


def complaints(found: Found, result: Result) -> list[str]:
    """What in a run is not as the judge finds it: events, voltages of capacitors, currents of coils."""
    expected, right = found
    events = sorted((e.time, str(e.port), e.kind) for e in result.events if e.time > MOMENT)
    wrong = []
    told = sorted(event[1:] for event in events)
    if told != sorted(tuple(event[1:]) for event in right):
        wrong.append(f"events {events} for {right}")
    elif far := [
        t for (t, *_), (s, *_) in zip(events, sorted(right), strict=True) if abs(t - s) > 1e-6
    ]:
        wrong.append(f"events at {far}")
    size = max((np.abs(column).max() for column in expected.values()), default=0.0)
    for name, values in expected.items():
        if (off := np.abs(result[name] - values).max()) > 1e-6 * size:
            wrong.append(f"{name}: off by {off:.3g}")
    return wrong


def judged(network: Network, times: np.ndarray) -> Found:
    """What the judge finds."""
    return Oracle(network).run(times)

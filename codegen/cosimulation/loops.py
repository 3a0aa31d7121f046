"""In which order signals are exchanged at one instant; loops in which each would have to be first."""

from collections.abc import Iterable, Mapping, Sequence

import networkx as nx

from bondgraph.errors import AlgebraicLoopError
from codegen.cosimulation.ends import End
from codegen.cosimulation.part import Part
from codegen.cosimulation.wires import Wire


def exchange_order(
    parts: Mapping[str, Part], wires: Sequence[Wire], first: bool
) -> tuple[Part, ...]:
    """Participants such that those whose signals others pass on at once come first.

    Raises `AlgebraicLoopError` where signals of models tell one another at one instant.
    """
    web = _web(parts, wires, first)
    # What a unit of others does not tell of itself may be no loop: the exchange itself shows.
    sure = [node for node in web if parts[node[0]].certain(first)]
    for loop in nx.strongly_connected_components(web.subgraph(sure)):
        if len(loop) > 1:
            raise AlgebraicLoopError(_told(loop, web))
    place = dict.fromkeys(parts, 0)
    for at, level in enumerate(nx.strongly_connected_components(web)):
        for name, _ in level:
            place[name] = max(place[name], at)
    return tuple(sorted(parts.values(), key=lambda part: place[part.name]))


def _web(parts: Mapping[str, Part], wires: Iterable[Wire], first: bool) -> "nx.DiGraph[End]":
    """An edge from each signal to those that it tells of at once."""
    web: nx.DiGraph[End] = nx.DiGraph()
    for wire in wires:
        # Strongly connected components come with what is told before what tells.
        web.add_edge(wire.target, wire.source)
        for name in parts[wire.source.part].fed(wire.source.signal, first):
            web.add_edge(wire.source, End(wire.source.part, name))
    return web


def _told(loop: Iterable[End], web: "nx.DiGraph[End]") -> str:
    round_trip = [edge[0] for edge in nx.find_cycle(web.subgraph(loop))]
    names = " -> ".join(map(str, [*reversed(round_trip), round_trip[-1]]))
    return (
        f"at one instant these signals tell one another: {names}; put a state or a sampled controller on "
        "the way, or make one graph of the models"
    )

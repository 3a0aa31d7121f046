"""Wires: edges with a signal's node at an end. They say what reads what, and fill in what was not told.

An edge into a `Function`, a `State` or a `Controller` says that it reads a signal of the node at the tail:
what a detector reads, what a storage gives, what the bonds of a junction have in common, what a node of
signals is or gives; of other nodes, or where there are several, the one that the reader reads, or that the
edge names, ``signal="tau"``. An edge from such a node to any other says that the other's value, law or
condition reads it.

A reader need not know the name of what it reads. A node of signals with ``ports=["plus", "minus"]`` has these
names in its expressions, as a function has arguments, and nobody else knows them. A wire that names a port,
``port="plus"`` on the edge or ``"ref > error.plus"`` in a path, stands for it; one that names none stands for
the one port that is left. So a block whose input is not told is a node with a port:
``("gain", {"kind": "Function", "value": "K*u", "ports": ["u"]})``. A source, transformer or gyrator without a
value has the signal of its one wire as value.

`unwired` fills all of this in: what returns is a graph of bonds alone that reads signals by their names, and
the wires, for those that draw them.
"""

from collections.abc import Hashable, Iterable
from typing import Any

import networkx as nx

from bondgraph.declare.renaming import with_names
from bondgraph.declare.wiring import VALUE, Wire, has_ports, ports_of, wires_into
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Bond
from bondgraph.nodes.kinds import SIGNALS

WIRES = "wires"
"""The attribute of a validated graph that holds them."""


def is_wire(graph: Any, tail: Hashable, head: Hashable) -> bool:
    """Whether an edge of a declared graph has a node of signals at an end."""
    return any(str(graph.nodes[end].get("kind")) in SIGNALS for end in (tail, head))


def unwired(graph: Any) -> tuple[Any, tuple[Wire, ...]]:
    """A declared graph without its wires, in which all that wires bring is read by its name; and the wires.

    A graph without wires and without ports of signals is returned as it is.

    Raises `StructureError`, naming the wire or the node, for a wire whose signal the reader does not read,
    for one that may stand for several, and for ports that no wire or more than one stands for.
    """
    edges = [edge for edge in graph.edges if is_wire(graph, *edge)]
    ported = [name for name, told in graph.nodes(data=True) if has_ports(told)]
    if not edges and not ported:
        return graph, ()
    bonds: nx.DiGraph[Hashable] = nx.DiGraph()
    bonds.graph.update(graph.graph)
    bonds.add_nodes_from((name, dict(told)) for name, told in graph.nodes(data=True))
    bonds.add_edges_from(edge for edge in graph.edges(data=True) if edge[:2] not in set(edges))
    into: dict[Hashable, list[Bond]] = {name: [] for name in ported}
    for tail, head in edges:
        into.setdefault(head, []).append((tail, head))
    found: dict[Bond, Wire] = {}
    told = {}
    for reader, own in into.items():
        wires = wires_into(graph, bonds, reader, own)
        told[reader] = _filled(graph, reader, wires)
        found |= {(wire.source, wire.reader): wire for wire in wires}
    for reader, attributes in told.items():
        bonds.nodes[reader].clear()
        bonds.nodes[reader].update(attributes)
    return bonds, tuple(found[edge] for edge in edges)


def _filled(graph: Any, reader: Hashable, wires: Iterable[Wire]) -> dict[str, Any]:
    """A reader's attributes with signals in the places of its ports."""
    names: dict[str, str] = {}
    for wire in wires:
        if wire.port is not None and names.setdefault(wire.port, wire.names[0]) != wire.names[0]:
            raise StructureError(
                f"{wire}: port {wire.port!r} of {reader!r} stands for {names[wire.port]} already; name "
                "another port, or let a Function put signals together"
            )
    attributes = dict(graph.nodes[reader])
    if VALUE in names and not has_ports(attributes):
        return {**attributes, VALUE: f"1*{names[VALUE]}"}
    if not has_ports(attributes):
        return attributes
    for port in ports_of(graph, reader):
        if port not in names:
            raise StructureError(
                f"node {reader!r}: nothing comes in at its port {port!r}; wire a signal to it, "
                f"'... > {reader}.{port}' in a path, or write the signal's name in place of the port"
            )
    del attributes["ports"]
    return with_names(reader, attributes, names)

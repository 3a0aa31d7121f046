"""`merged`: the same equations from fewer junctions."""

from collections.abc import Hashable, Iterator
from typing import Any

import networkx as nx

from bondgraph.checking.names import signals_named, validated
from bondgraph.declare.renaming import names_read
from bondgraph.declare.tables import with_tables
from bondgraph.declare.wires import unwired
from bondgraph.nodes.attributes import kind_of
from bondgraph.nodes.elements import Bond
from bondgraph.nodes.kinds import Kind

_CONTROLS = ("on", "off", "reset")


def merged(graph: Any) -> "nx.DiGraph[Hashable]":
    """A declared graph with the same equations and fewer junctions.

    Bonded junctions of one kind become one; a junction of two bonds, one in and one out, gives way to a
    bond. A junction stays that is controlled, that names its variable or whose variable a value or law
    reads, unless its partner can take over the name, and one without which two nodes would have two
    bonds, or that a wire leads on from. Drawn strokes are left out; what wires bring is read by its name. The
    graph itself is not changed.

    Raises `StructureError` for what `validate` refuses.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("a"), bg.R("R", "R"), bg.One("b"), bg.I("L", "L"),
    ...                   bg.Zero("n"), bg.TF("t", "m"), bg.One("c"), bg.I("J", "J")])
    >>> nx.add_path(g, ["u", "a", "b", "n", "t", "c", "J"])
    >>> g.add_edges_from([("a", "R"), ("b", "L")])
    >>> list(merged(g).edges)
    [('u', 'a'), ('a', 'R'), ('a', 'L'), ('a', 't'), ('t', 'J')]
    """
    merger = Merger(graph)
    waiting = [name for name in merger.graph if merger.kind(name).joins]
    while waiting:
        name = waiting.pop(0)
        if name not in merger.graph:
            continue
        if other := next(merger.same_kind(name), None):
            waiting += [one for one in merger.neighbours(other) if merger.kind(one).joins]
            merger.unite(name, other)
        elif merger.passes(name):
            waiting += [one for one in merger.neighbours(name) if merger.kind(one).joins]
            merger.bridge(name)
    return merger.result()


class Merger:
    """A copy of a declared graph, its bonds as they count, whose junctions can be taken out.

    Each bond keeps where it was declared, and the ports of fields at its ends.
    """

    def __init__(self, graph: Any) -> None:
        validated(graph)
        told, self._wires = unwired(with_tables(graph))
        self.given = told if self._wires else graph
        self._sources = {wire.source: wire.source for wire in self._wires}
        self.graph: nx.DiGraph[Hashable] = nx.DiGraph()
        self.graph.graph.update(self.given.graph)
        for name, attributes in self.given.nodes(data=True):
            self.graph.add_node(name, **attributes)
        for tail, head, attributes in self.given.edges(data=True):
            ports = {tail: attributes.get("tail_port"), head: attributes.get("head_port")}
            if attributes.get("port") is not None:
                ports[tail if self.graph.nodes[tail].get("ports") else head] = attributes["port"]
            first, last = (head, tail) if self._turns(tail, head) else (tail, head)
            self.graph.add_edge(first, last, tail_port=ports[first], head_port=ports[last])
        self._place = {name: at for at, name in enumerate(self.graph)}
        self._read = names_read(with_tables(self.given))
        self._shared = _named_twice(self.given)

    def kind(self, name: Hashable) -> Kind:
        """The kind of a node."""
        return kind_of(self.graph.nodes[name], f"node {name!r}")

    def _turns(self, tail: Hashable, head: Hashable) -> bool:
        """Whether a bond counts against its arrow: out of what absorbs, into a junction or a source."""
        first, last = self.kind(tail), self.kind(head)
        return first.absorbs and not last.absorbs and not last.two_port

    def neighbours(self, name: Hashable) -> list[Hashable]:
        """The nodes bonded to one, those whose power it receives first."""
        return [*self.graph.predecessors(name), *self.graph.successors(name)]

    def declared(self, one: Hashable, other: Hashable) -> Bond:
        """The bond between two nodes, as it was declared."""
        return (one, other) if self.given.has_edge(one, other) else (other, one)

    def passes(self, name: Hashable) -> bool:
        """Whether a junction only hands on, from one bond in to one bond out, and nobody asks for it."""
        graph = self.graph
        if self._controlled(name) or self._asked_for(name) or self._named(name) is not None:
            return False
        if name in self._sources.values():
            return False
        if (graph.in_degree(name), graph.out_degree(name)) != (1, 1):
            return False
        first, last = self.neighbours(name)
        return not graph.has_edge(first, last) and not graph.has_edge(last, first)

    def same_kind(self, name: Hashable) -> Iterator[Hashable]:
        """The bonded junctions of the same kind that can become one with this one."""
        for other in self.neighbours(name):
            if self.kind(other) is self.kind(name) and self._unites(name, other):
                yield other

    def same_kind_after(self, name: Hashable) -> Iterator[Hashable]:
        """Those of them that come later in the graph, so that each pair is told once."""
        return (other for other in self.same_kind(name) if self._place[other] > self._place[name])

    def _unites(self, name: Hashable, other: Hashable) -> bool:
        if self._controlled(name) or self._controlled(other) or self._asked_for(other):
            return False
        if self._named(other) is not None and (
            self._named(name) is not None or self._asked_for(name)
        ):
            return False
        return not set(self.neighbours(name)) & set(self.neighbours(other))

    def _named(self, name: Hashable) -> Any:
        """The name that a junction was given for its variable."""
        return self.graph.nodes[name].get(self.kind(name).common)

    def _asked_for(self, name: Hashable) -> bool:
        """Whether a value, a law or another node uses the name that the junction has by default."""
        default = f"{self.kind(name).common[0]}_{name}"
        return self._named(name) is None and (default in self._read or default in self._shared)

    def _controlled(self, name: Hashable) -> bool:
        return any(self.graph.nodes[name].get(key) is not None for key in _CONTROLS)

    def unite(self, name: Hashable, other: Hashable) -> None:
        """Let one junction have the bonds of another, and its name if it has none."""
        common = self.kind(name).common
        if self._named(other) is not None:
            self.graph.nodes[name][common] = self._named(other)
        edges = [*self.graph.in_edges(other, data=True), *self.graph.out_edges(other, data=True)]
        self.graph.remove_node(other)
        self._sources |= {one: name for one, now in self._sources.items() if now == other}
        for tail, head, ports in edges:
            if name not in (tail, head):
                self.graph.add_edge(
                    *(name if end == other else end for end in (tail, head)), **ports
                )

    def bridge(self, name: Hashable) -> None:
        """Put one bond in the place of a junction and its two."""
        first, last = self.neighbours(name)
        tail_port = self.graph.edges[first, name]["tail_port"]
        head_port = self.graph.edges[name, last]["head_port"]
        self.graph.remove_node(name)
        self.graph.add_edge(first, last, tail_port=tail_port, head_port=head_port)

    def result(self) -> "nx.DiGraph[Hashable]":
        """The graph as a declaration."""
        made: nx.DiGraph[Hashable] = nx.DiGraph()
        made.graph.update(self.graph.graph)
        made.add_nodes_from((name, dict(data)) for name, data in self.graph.nodes(data=True))
        for tail, head, ports in self.graph.edges(data=True):
            given = {key: port for key, port in ports.items() if port is not None}
            made.add_edge(
                tail, head, **({"port": given.popitem()[1]} if len(given) == 1 else given)
            )
        made.add_edges_from((self._sources[one.source], one.reader) for one in self._wires)
        return made


def _named_twice(graph: Any) -> set[str]:
    """The names that nodes give to their variables: what a junction has by default may be one."""
    given = {
        name: {key: value for key, value in data.items() if key in ("effort", "flow", "integrate")}
        for name, data in graph.nodes(data=True)
    }
    found: set[str] = set()
    for names in given.values():
        for value in names.values():
            found |= set(map(str, value.values() if isinstance(value, dict) else [value]))
    return found & signals_named(graph)

"""`validate`: what passes is complete, checked and frozen; no other stage sees what the user wrote."""

from collections.abc import Hashable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import networkx as nx

from bondgraph.declare.declared import elements_of
from bondgraph.declare.names import check_names, check_one_whole
from bondgraph.declare.tables import TABLES, tables_of, with_tables
from bondgraph.declare.wires import WIRES, unwired
from bondgraph.declare.wiring import Wire
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Bond, Element
from bondgraph.nodes.fields import part
from bondgraph.tables.record import Sampled

if TYPE_CHECKING:
    _DiGraph = nx.DiGraph[Hashable]
else:
    _DiGraph = nx.DiGraph


class _Validated(_DiGraph):
    """A graph that has passed; only `validate` makes one."""


def validate(graph: Any) -> "nx.DiGraph[Hashable]":
    """A frozen copy of the graph whose nodes carry one checked `Element` each as ``element``.

    Bonds of I, C or R at junctions and sources point into them; each keeps as ``declared`` the pair
    of nodes it was declared with. Edges with a signal's node at an end are no bonds but wires: what they
    bring is read by its name, and they are the graph's attribute ``wires``. A graph that has passed is
    returned as it is.

    Raises `StructureError`, naming the node or bond, for whatever is not a bond graph.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L"), ("loop", "R")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> checked = validate(g)
    >>> checked.nodes["L"]["element"].value, nx.is_frozen(checked)
    (L, True)
    """
    if not isinstance(graph, nx.DiGraph) or graph.is_multigraph():
        raise StructureError(
            f"a bond graph is a networkx.DiGraph with one edge a bond, not a {type(graph).__name__}"
        )
    if isinstance(graph, _Validated):
        return graph
    if len(graph) == 0:
        raise StructureError("the graph has no nodes; add elements and bonds first")
    result = _Validated()
    result.graph[TABLES] = tables_of(graph)
    graph, result.graph[WIRES] = unwired(with_tables(graph))
    fields, controls = _add_elements(result, graph)
    for tail, head, attributes in graph.edges(data=True):
        _check_bond(graph, tail, head, attributes)
        ends = _ends(result, fields, (tail, head), attributes)
        first, last = _oriented(result, *ends)
        result.add_edge(first, last, declared=(tail, head))
    for bond in controls:
        result.add_edge(*bond, declared=bond)
    for name in result:
        _check_degree(result, name)
    check_names([result.nodes[name]["element"] for name in result])
    check_one_whole(result)
    nx.freeze(result)
    return result


def with_elements(
    graph: "nx.DiGraph[Hashable]", elements: Mapping[Hashable, Element]
) -> "nx.DiGraph[Hashable]":
    """A validated graph with other elements at some of its nodes, of as many ports and the same names."""
    result = _Validated(graph)
    for name, element in elements.items():
        result.nodes[name]["element"] = element
    nx.freeze(result)
    return result


def graph_of(
    elements: Mapping[Hashable, Element],
    bonds: Iterable[tuple[Bond, Bond]],
    tables: tuple[Sampled, ...] = (),
    wires: tuple[Wire, ...] = (),
) -> "nx.DiGraph[Hashable]":
    """The validated graph of these elements and bonds, each by its ends and as it was declared."""
    result = _Validated()
    result.graph[TABLES], result.graph[WIRES] = tables, wires
    for name, element in elements.items():
        result.add_node(name, element=element)
    for ends, declared in bonds:
        result.add_edge(*ends, declared=declared)
    nx.freeze(result)
    return result


def _check_bond(graph: Any, tail: Hashable, head: Hashable, attributes: dict[str, Any]) -> None:
    if tail == head:
        raise StructureError(f"node {tail!r} is bonded to itself; remove that edge")
    if graph.has_edge(head, tail):
        raise StructureError(
            f"nodes {tail!r} and {head!r} are bonded both ways; a bond is one edge, in the "
            "direction of positive power"
        )
    unknown = sorted(map(str, attributes.keys() - {"port", "tail_port", "head_port", "stroke"}))
    if unknown:
        raise StructureError(
            f"bond {tail!r} -> {head!r}: unknown attribute {unknown[0]!r}; a bond may carry port, the name "
            "of a field's port, or tail_port and head_port; and stroke, the end of a stroke that was drawn"
        )
    if attributes.get("stroke") not in (None, "tail", "head"):
        raise StructureError(
            f"bond {tail!r} -> {head!r}: stroke is {attributes['stroke']!r}; it must be 'tail' or 'head', "
            "the end of the bond at which it is drawn"
        )


def _add_elements(result: _Validated, graph: Any) -> tuple[set[Hashable], list[Bond]]:
    """Add every node's elements; the fields among the nodes, and the bonds of controlled junctions."""
    fields: set[Hashable] = set()
    controls: list[Bond] = []
    for name, attributes in graph.nodes(data=True):
        hub = name
        for own, element in elements_of(name, attributes).items():
            _add(result, own, element)
            if element.owner is not None:
                fields.add(name)
            elif element.at is not None:
                if element.at != own:
                    controls.append((element.at, own))
            elif own != name:
                # What sources and what they are at give counts into the rest.
                joins = element.kind.joins
                bond = (own, name if joins else hub)
                controls.append(bond if joins or element.kind.supplies else bond[::-1])
                hub = own if joins else hub
    return fields, controls


def _add(graph: _Validated, name: Hashable, element: Element) -> None:
    if name in graph:
        raise StructureError(
            f"two nodes are called {name!r}: the port of a field or of a controlled junction, and another; "
            "rename one"
        )
    graph.add_node(name, element=element)


def _ends(graph: _Validated, fields: set[Hashable], bond: Bond, attributes: dict[str, Any]) -> Bond:
    """The bond's ends as one-ports: at a field the port that the bond names."""
    given = {
        end: attributes.get(f"{side}_port")
        for end, side in zip(bond, ("tail", "head"), strict=True)
    }
    many = [end for end in bond if end in fields]
    if attributes.get("port") is not None:
        if len(many) != 1 or given[many[0]] is not None:
            raise StructureError(
                f"bond {bond[0]!r} -> {bond[1]!r}: port names the port of the one field at its ends; "
                "between two fields give tail_port and head_port"
            )
        given[many[0]] = attributes["port"]
    ends: list[Hashable] = []
    for end in bond:
        if end not in fields:
            if given[end] is not None:
                raise StructureError(
                    f"bond {bond[0]!r} -> {bond[1]!r}: {end!r} has no ports to name"
                )
            ends.append(end)
            continue
        own = part(end, str(given[end]))
        if given[end] is None or own not in graph:
            elements = (graph.nodes[node]["element"] for node in graph)
            known = [str(e.name).rpartition(".")[2] for e in elements if e.owner == end]
            raise StructureError(
                f"bond {bond[0]!r} -> {bond[1]!r} must name a port of {end!r} as port=...; there are "
                f"{', '.join(known)}"
            )
        ends.append(own)
    return ends[0], ends[1]


def _oriented(graph: "nx.DiGraph[Hashable]", tail: Hashable, head: Hashable) -> Bond:
    """The bond turned so that it points into I, C or R, unless its other end needs its direction."""
    first, last = (graph.nodes[name]["element"] for name in (tail, head))
    if first.absorbs and not last.absorbs and not last.kind.two_port:
        return head, tail
    return tail, head


def _check_degree(graph: "nx.DiGraph[Hashable]", name: Hashable) -> None:
    kind = graph.nodes[name]["element"].kind
    inward, outward = graph.in_degree(name), graph.out_degree(name)
    count = inward + outward
    if kind.two_port and (inward, outward) != (1, 1):
        raise StructureError(
            f"{kind} {name!r} has {inward} bond(s) in and {outward} out; it needs one in and one out"
        )
    if kind.joins and count == 0:
        raise StructureError(f"junction {name!r} has no bonds; bond it or remove it")
    if not kind.joins and not kind.two_port and count != 1:
        raise StructureError(
            f"{kind} {name!r} has {count} bonds; it needs exactly one"
            + ("; put a junction between" if count else "; bond it or remove it")
        )

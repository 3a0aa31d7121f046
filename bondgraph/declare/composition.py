"""Sub-models: plain functions that return graphs, copied under a prefix and joined at shared terminals."""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import networkx as nx

from bondgraph.algebra.atoms import normal, symbol
from bondgraph.algebra.expressions import TIME
from bondgraph.declare.drawn import BondGraph
from bondgraph.declare.quantities import name_text
from bondgraph.declare.renaming import Names, Part, names_read, renamed
from bondgraph.declare.signal_names import signal_names
from bondgraph.declare.tables import TABLES, tables_of, with_tables
from bondgraph.errors import StructureError
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import SLIP


def assemble(*parts: Part) -> Part:
    """One graph of all parts. Nodes of one name are one terminal, declared by at least one part.

    The order of the parts is the order of states and inputs.

    Tables of one name must be equal.

    Raises `StructureError` if two parts declare one node or table differently, or one bond twice.

    >>> import bondgraph as bg
    >>> wheel = nx.DiGraph()
    >>> wheel.add_nodes_from([bg.One("hub"), bg.I("J", "J", flow="omega")])
    >>> wheel.add_edge("hub", "J")
    >>> road = nx.DiGraph()
    >>> road.add_nodes_from([bg.R("tire", effort="tau", flow="omega_t")])
    >>> road.add_edge("hub", "tire")
    >>> list(assemble(wheel, road))
    ['hub', 'J', 'tire']
    """
    tables = tables_of(nx.DiGraph(tables=[one for part in parts for one in tables_of(part)]))
    whole = BondGraph()
    whole.graph.update({TABLES: list(tables)} if tables else {})
    for part in parts:
        for name, attributes in part.nodes(data=True):
            known = whole.nodes[name] if name in whole else {}
            if attributes and known and _told(known) != _told(attributes):
                raise StructureError(f"two parts declare node {name!r}: {known} and {attributes}")
            whole.add_node(name, **attributes)
        for tail, head, attributes in part.edges(data=True):
            if whole.has_edge(tail, head) or whole.has_edge(head, tail):
                raise StructureError(f"two parts declare the bond {tail!r} -> {head!r}")
            whole.add_edge(tail, head, **attributes)
    return whole


def _told(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes, with one name for one kind."""
    kind = attributes.get("kind")
    return {**attributes, "kind": Kind(kind) if kind in ("0", "1") else kind}


def prefixed(
    graph: Part,
    prefix: str,
    keep: Mapping[Hashable, Hashable] | Iterable[Hashable] = (),
    parameters: bool | Iterable[str] = False,
) -> Part:
    """A copy of a part in which every node, and every signal that a node names, carries the prefix.

    A name given to an effort, a flow, an integral or an input is prefixed as it stands, ``v`` to
    ``left_v``; names by default follow the node, ``f_mass`` to ``f_left_mass``, ``q_tire`` to
    ``q_left_tire``. Values, laws and energies read the new names.

    ``keep``: terminals, as names that stay or as a mapping of inner to outer names; what they name
    stays too. A terminal without attributes has the default names. ``parameters``: the names read
    that are no signals of the part, signals of elsewhere among them, are shared by all copies; True
    prefixes them all, a list those in it. Tables keep their names.

    Raises `StructureError` for a prefix that makes no identifiers, for names in ``keep`` and
    ``parameters`` that the part does not have, and where two names would become one.

    >>> import bondgraph as bg
    >>> cell = nx.DiGraph()
    >>> cell.add_nodes_from([bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("drag", "c*abs(v)")])
    >>> cell.add_edges_from([("rail", "mass"), ("mass", "m"), ("mass", "drag")])
    >>> left = prefixed(cell, "left_", keep=["rail"])
    >>> list(left.edges)
    [('left_mass', 'left_m'), ('left_mass', 'left_drag'), ('rail', 'left_mass')]
    >>> left.nodes["left_m"], left.nodes["left_drag"]["value"]
    ({'kind': 'I', 'value': 'm', 'flow': 'left_v'}, c*Abs(left_v))
    """
    if not isinstance(graph, nx.DiGraph) or graph.is_multigraph():
        raise StructureError(f"a part is a networkx.DiGraph, not a {type(graph).__name__}")
    prefix, graph = _checked_prefix(prefix), with_tables(graph)
    kept = _kept(graph, keep)
    nodes = _nodes(graph, prefix, kept)
    signals = signal_names(graph, prefix, nodes, kept)
    read = names_read(graph)
    names = signals | _parameter_names(read - signals.keys(), prefix, parameters)
    _check_names(names, read, prefix)
    result = BondGraph()
    result.graph.update({TABLES: graph.graph[TABLES]} if TABLES in graph.graph else {})
    for inner, attributes in graph.nodes(data=True):
        result.add_node(nodes[inner], **renamed(inner, attributes, names))
    for tail, head, attributes in graph.edges(data=True):
        told = attributes
        if attributes.get("signal") is not None:
            name = str(name_text(attributes["signal"]))
            told = {**attributes, "signal": names.get(name, name)}
        result.add_edge(nodes[tail], nodes[head], **told)
    return result


def _checked_prefix(prefix: object) -> str:
    text = normal(prefix)
    if not isinstance(text, str) or not text.isidentifier():
        raise StructureError(
            f"prefix {prefix!r} makes no identifiers; use letters, digits and underscores, not "
            "starting with a digit, like 'left_'"
        )
    return text


def _kept(graph: Part, keep: Any) -> dict[Hashable, Hashable]:
    """The terminals that stay, with their outer names."""
    if isinstance(keep, str) or not isinstance(keep, Iterable):
        raise StructureError(f"keep must be a list of nodes, or map nodes to names, not {keep!r}")
    kept = dict(keep) if isinstance(keep, Mapping) else {name: name for name in keep}
    for name in kept:
        if name not in graph:
            raise StructureError(f"keep: {name!r} is not a node of the part")
    return kept


def _nodes(graph: Part, prefix: str, kept: Mapping[Hashable, Hashable]) -> dict[Hashable, Hashable]:
    """Every node's new name; `StructureError` where two nodes would become one."""
    nodes: dict[Hashable, Hashable] = {}
    owners: dict[Hashable, Hashable] = {}
    for inner in graph:
        if isinstance(inner, bool) or not isinstance(inner, str | int):
            raise StructureError(f"node {inner!r}: a node's name must be a text or an integer")
        nodes[inner] = kept.get(inner, f"{prefix}{inner}")
        other = owners.setdefault(nodes[inner], inner)
        if other != inner:
            raise StructureError(
                f"nodes {other!r} and {inner!r} would both be called {nodes[inner]!r}; "
                "take another prefix, or another name in keep"
            )
    return nodes


def _parameter_names(known: set[str], prefix: str, chosen: Any) -> dict[str, str]:
    """The parameters that carry the prefix too."""
    known = known - {TIME.name}
    if isinstance(chosen, bool):
        chosen = sorted(known) if chosen else ()
    if isinstance(chosen, str) or not isinstance(chosen, Iterable):
        raise StructureError(f"parameters must be True, False or a list of names, not {chosen!r}")
    names = [str(name_text(name)) for name in chosen]
    for name in names:
        if name not in known:
            raise StructureError(
                f"parameters: {name!r} is not a parameter of the part; there are "
                f"{', '.join(sorted(known)) or 'none'}"
            )
    return {name: symbol(prefix + name, f"parameter {name!r}").name for name in names}


def _check_names(names: Names, read: set[str], prefix: str) -> None:
    """Refuse two names that would become one."""
    owners = {name: name for name in (read - names.keys()) | {TIME.name, SLIP.name}}
    for old, new in names.items():
        other = owners.setdefault(new, old)
        if other != old:
            raise StructureError(
                f"prefix {prefix!r}: {other!r} and {old!r} would both be called {new!r}; "
                "take another prefix"
            )

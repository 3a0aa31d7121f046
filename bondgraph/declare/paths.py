"""`graph`: a bond graph from nodes, and from bonds written as paths, ``"engine > shaft > J"``."""

import re
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from bondgraph.declare.drawn import BondGraph
from bondgraph.declare.tables import TABLES, tables_of
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.attributes import check_node_name
from bondgraph.nodes.elements import Node
from bondgraph.tables.record import Sampled

ARROWS = re.compile(r"[-<=–—→⇀⇁|;]+")
"""Signs of other notations; they stay letters of names that were declared so."""


def graph(
    nodes: Iterable[Node | str | int | list[Node]],
    *paths: str | Sequence[Hashable],
    tables: Iterable[Sampled] = (),
) -> BondGraph:
    """A declared graph: nodes, and the bonds along each path, positive power pointing along ``>``.

    A path is a text of names, ``"a > b > c"``, with commas between several paths; or a list or tuple of
    names, for names with such signs in them. ``"3"`` is the node 3 where none is called so, and
    ``"field.a"`` the port a of a node with ports. A node that another part declares is its bare name; a list
    among the nodes is nodes as well, those of a block.
    ``tables``: `LookupTable` objects that values and laws call.

    What returns is a `networkx.DiGraph`, to which nodes and bonds can be added; notebooks draw it.

    Raises `StructureError`, naming node and path, for two nodes of one name, names that are not among
    the nodes, paths without a bond, other arrows, and bonds that are there already; `TableError` for
    what is no table.

    >>> import bondgraph as bg
    >>> made = graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m"), bg.R("drag", "b")],
    ...              "force > mass > m", "mass > drag")
    >>> list(made.edges)
    [('force', 'mass'), ('mass', 'm'), ('mass', 'drag')]
    >>> bg.derive(made).J
    Matrix([[-b]])
    >>> graph([bg.Se("force", "F"), bg.I("mass", "m")], "force > mas")
    Traceback (most recent call last):
    bondgraph.errors.StructureError: path 'force > mas': there is no node 'mas' (did you mean 'mass'?); \
put it among the nodes, there are force, mass
    """
    result = BondGraph()
    _add_nodes(result, nodes)
    if tables := list(tables):
        result.graph[TABLES] = tables
        tables_of(result)
    for path in paths:
        for where, names in _paths(result, path):
            ends = [_end(result, name, where) for name in names]
            for tail, head in pairwise(ends):
                _add_bond(result, tail, head, where)
    return result


def _add_nodes(result: BondGraph, nodes: Iterable[Any]) -> None:
    if isinstance(nodes, str) or not isinstance(nodes, Iterable):
        raise StructureError(
            f"the nodes are a list, as [Se('force', 'F'), I('m', 'm')], not {nodes!r}"
        )
    for node in nodes.items() if isinstance(nodes, Mapping) else _flat(nodes):
        name, attributes = (node, {}) if isinstance(node, str | int) else _parts(node)
        check_node_name(name)
        if name in result:
            raise StructureError(
                f"two nodes are called {name!r}; rename one, and its bonds with it"
            )
        result.add_node(name)
        result.nodes[name].update(attributes)


def _flat(nodes: Iterable[Any]) -> Iterator[Any]:
    """The nodes, lists among them one by one."""
    for node in nodes:
        yield from _flat(node) if isinstance(node, list) else (node,)


def _parts(node: Any) -> tuple[Hashable, Mapping[str, Any]]:
    if isinstance(node, tuple) and len(node) == 2 and isinstance(node[1], Mapping):
        return node
    raise StructureError(
        f"{node!r} is no node; nodes are made by Se(name, ...), One(name) and so on, or are pairs of "
        "a name and its attributes"
    )


def _paths(result: BondGraph, path: Any) -> list[tuple[str, list[Hashable]]]:
    """Every path of a text or a list: what a message calls it, and its names."""
    if isinstance(path, str):
        found = [(f"path {part.strip()!r}", _names(part)) for part in path.split(",")]
    elif isinstance(path, Sequence):
        if path and all(isinstance(one, tuple | list) and len(one) > 1 for one in path):
            raise StructureError(
                f"path {path!r} is a list of paths; give them one by one, graph(nodes, *paths)"
            )
        found = [(f"path {path!r}", list(path))]
    else:
        raise StructureError(
            f"{path!r} is no path; write 'a > b > c', or a list of the nodes' names"
        )
    for where, names in found:
        if len(names) < 2:
            _check_arrow(result, str(*names), where)
            raise StructureError(f"{where} has no bond; write at least two nodes, as 'a > b'")
    return found


def _names(text: str) -> list[Hashable]:
    names = [name.strip() for name in text.split(">")]
    if "" in names and len(names) > 1:
        raise StructureError(
            f"path {text.strip()!r}: there is a > without a node before or behind it; write 'a > b > c'"
        )
    return [*names]


def _end(result: BondGraph, name: Any, where: str) -> tuple[Hashable, str | None]:
    """The node that a path names, and its port if the path names one."""
    if isinstance(name, str | int) and not isinstance(name, bool) and name in result:
        return name, None
    if isinstance(name, str):
        if name.isdecimal() and int(name) in result:
            return int(name), None
        owner, _, port = name.rpartition(".")
        if owner in result and port in (result.nodes[owner].get("ports") or ()):
            return owner, port
        _check_arrow(result, name, where)
    known = [str(node) for node in result]
    listed = ", ".join([*known[:10], *(["..."] if len(known) > 10 else [])]) or "none"
    raise StructureError(
        f"{where}: there is no node {name!r}{nearest(str(name), known)}; put it among the nodes, "
        f"there are {listed}"
    )


def _check_arrow(result: BondGraph, text: str, where: str) -> None:
    """Refuse what is nodes with an arrow of another notation between or behind them."""
    parts = ARROWS.split(text)
    if len(parts) > 1 and any(part.strip() in result for part in parts):
        sign = ARROWS.findall(text)[0]
        sign += ">" if text.endswith(sign) else ""
        raise StructureError(
            f"{where}: {sign!r} is no arrow here; a bond is written 'a > b', towards positive power"
        )


def _add_bond(
    result: BondGraph,
    tail: tuple[Hashable, str | None],
    head: tuple[Hashable, str | None],
    where: str,
) -> None:
    (first, out), (second, into) = tail, head
    if first == second:
        raise StructureError(f"{where}: node {first!r} is bonded to itself; remove that bond")
    for one, other in ((first, second), (second, first)):
        if result.has_edge(one, other):
            raise StructureError(
                f"{where}: the bond {one!r} > {other!r} is there already; write each bond once, in "
                "the direction of positive power"
            )
    if out is not None and into is not None:
        result.add_edge(first, second, tail_port=out, head_port=into)
    elif (port := out if into is None else into) is not None:
        result.add_edge(first, second, port=port)
    else:
        result.add_edge(first, second)

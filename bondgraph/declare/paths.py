"""`graph`: a bond graph from nodes, and from bonds written as paths, ``"engine > shaft > J"``."""

import re
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from bondgraph.declare.drawn import BondGraph
from bondgraph.declare.tables import TABLES, tables_of
from bondgraph.declare.wires import is_wire
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.attributes import check_node_name
from bondgraph.nodes.elements import Node
from bondgraph.nodes.kinds import SIGNALS
from bondgraph.tables.record import Sampled

End = tuple[Hashable, str | None]
"""A node on a path, and its port if the path names one."""

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

    With a `Function`, a `State` or a `Controller` at an end, a ``>`` is a wire: the node behind it reads a
    signal of the one before it, ``"tacho > error > motor"``. ``"error.plus"`` is a port of such a node, and
    ``"pi.tau"`` what a controller gives.

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
            _check_outer(result, ends, where)
            for tail, head in pairwise(ends):
                _add_edge(result, tail, head, where)
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


def _end(result: BondGraph, name: Any, where: str) -> End:
    """The node that a path names, and its port if the path names one."""
    if isinstance(name, str | int) and not isinstance(name, bool) and name in result:
        return name, None
    if isinstance(name, str):
        if name.isdecimal() and int(name) in result:
            return int(name), None
        owner, _, port = name.rpartition(".")
        if owner in result and port in (*_inputs(result, owner), *_outputs(result, owner)):
            return owner, port
        if owner in result and (gives := _outputs(result, owner)):
            raise StructureError(
                f"{where}: {owner!r} gives no {port!r}{nearest(port, map(str, gives))}; it gives "
                f"{', '.join(map(str, gives))}"
            )
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


def _inputs(result: BondGraph, name: Hashable) -> tuple[Hashable, ...]:
    """The ports that a path may name at a node: of a field, and those that wires lead to."""
    return _names_at(result, name, "ports")


def _outputs(result: BondGraph, name: Hashable) -> tuple[Hashable, ...]:
    """What a controller gives, which a path may name where it leads on."""
    return _names_at(result, name, "outputs")


def _names_at(result: BondGraph, name: Hashable, key: str) -> tuple[Hashable, ...]:
    given = result.nodes[name].get(key)
    return tuple(given) if isinstance(given, list | tuple | Mapping) else ()


def _check_outer(result: BondGraph, ends: Sequence[End], where: str) -> None:
    """Refuse what a controller gives as the end of a path, and what it reads as the beginning of one."""
    for (name, port), known, way in (
        (ends[0], _outputs(result, ends[0][0]), "in"),
        (ends[-1], _inputs(result, ends[-1][0]), "out"),
    ):
        if port is not None and _signals(result, name) and port not in known:
            raise StructureError(
                f"{where}: {port!r} is where a signal comes {way} at {name!r}; a path begins with what gives "
                "a signal, and ends with what reads it"
            )


def _signals(result: BondGraph, name: Hashable) -> bool:
    return str(result.nodes[name].get("kind")) in SIGNALS


def _add_edge(result: BondGraph, tail: End, head: End, where: str) -> None:
    """A bond, or a wire where one of its ends is a node of signals."""
    (first, out), (second, into) = tail, head
    if first == second:
        raise StructureError(f"{where}: node {first!r} is bonded to itself; remove that bond")
    wire = is_wire(result, first, second)
    for one, other in ((first, second), (second, first)):
        # Two nodes of signals may read each other.
        if result.has_edge(one, other) and (one == first or not wire):
            raise StructureError(
                f"{where}: the bond {one!r} > {other!r} is there already; write each bond once, in "
                "the direction of positive power"
            )
    ports = {"tail_port": out, "head_port": into}
    if _signals(result, first):
        ports["signal"] = ports.pop("tail_port") if out in _outputs(result, first) else None
        ports.pop("tail_port", None)
    if _signals(result, second) and into not in _inputs(result, second):
        del ports["head_port"]
    told = {key: port for key, port in ports.items() if port is not None}
    if {"tail_port", "head_port"} & told.keys() != {"tail_port", "head_port"}:
        told = {"port" if key.endswith("_port") else key: port for key, port in told.items()}
    result.add_edge(first, second, **told)

"""Old to new names of the signals of a part that is copied under a prefix."""

from collections.abc import Hashable, Mapping
from typing import Any

from bondgraph.algebra.atoms import symbol
from bondgraph.declare.quantities import kept_names, name_text, quantities
from bondgraph.declare.renaming import Names, Part, names_read
from bondgraph.nodes.kinds import SIGNALS


def signal_names(
    graph: Part, prefix: str, nodes: Mapping[Hashable, Hashable], kept: Mapping[Hashable, Hashable]
) -> dict[str, str]:
    """Old to new names of all signals of the part.

    A name that one node has by default and others by declaration becomes the node's new default, so
    that it stays one name; what a kept terminal names goes before both.
    """
    own: dict[str, str] = {}
    default: dict[str, str] = {}
    given: dict[str, str] = {}
    for inner, attributes in graph.nodes(data=True):
        for begin, end, name in quantities(inner, attributes):
            if name is None:
                target = own if inner in kept else default
                now = _ending(attributes, end, own if inner in kept else given)
                target[_named(begin, inner, end)] = _named(begin, nodes[inner], now)
            elif inner in kept:
                own[name] = name
            else:
                given[name] = symbol(prefix + name, f"node {inner!r}, with its prefix").name
    own.update(
        (_named("", one, ""), _named("", nodes[one], "")) for one in _signals_of_elsewhere(graph)
    )
    return given | default | own


def _named(begin: str, name: Hashable, end: str) -> str:
    return str(name_text(f"{begin}{name}{end}"))


def _ending(attributes: Mapping[str, Any], end: str, names: Names) -> str:
    """How a default name ends: that of a part of a controller with the new name of what it keeps."""
    part = end.removeprefix("_")
    return f"_{names[part]}" if part and part in kept_names(attributes) else end


def _signals_of_elsewhere(graph: Part) -> set[Hashable]:
    """Terminals without attributes that are read by their own names, where a wire leads on from them."""
    read = names_read(graph)
    found = {tail for tail, head in graph.edges if str(graph.nodes[head].get("kind")) in SIGNALS}
    return {one for one in found if not graph.nodes[one] and name_text(one) in read}

"""What a node can put on a wire: the signals that it has, and the one that it stands for."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import networkx as nx

from bondgraph.declare.quantities import kept_names, listed, name_text, quantities
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import kind_of
from bondgraph.nodes.elements import OTHER
from bondgraph.nodes.kinds import Kind

Called = tuple[str, bool]
"""A signal's name, and whether it was given one, rather than has it by default."""


@dataclass(frozen=True)
class Carried:
    """Every signal of a node, and its ``own``, which stands for it; None where there is none, or several."""

    names: tuple[str, ...]
    own: str | None


def carried(bonds: "nx.DiGraph[Hashable]", name: Hashable, port: str | None = None) -> Carried:
    """What a wire from a node may bring; ``bonds``: the declared graph without wires; ``port``: of a field.

    What the bonds at a junction have in common may be called what any node there calls it; it stands on the
    wire by a name that was given, where there is one.
    """
    attributes = bonds.nodes[name]
    kind = kind_of(attributes, f"node {name!r}")
    if kind.signals:
        return _of_signals(name, kind, attributes)
    which = _which(kind)
    ending = "" if port is None else f"_{port}"
    named = list(_called(name, attributes, port))
    own = [(text, given) for text, given, what in named if what == f"{which[:1]}_{ending}"]
    if kind.detects and attributes.get("integrate") is not None:
        own = []
    at_junctions = list(_at_junctions(bonds, name, which, port)) if own else []
    stands = [text for text, given in (*own, *at_junctions) if given] or [text for text, _ in own]
    names = dict.fromkeys([*(text for text, *_ in named), *(text for text, _ in at_junctions)])
    return Carried(tuple(names), stands[0] if stands else None)


def _of_signals(name: Hashable, kind: Kind, attributes: Mapping[str, Any]) -> Carried:
    """A function or a state is its own signal; a controller has what it gives, and what it keeps.

    A state machine is the number of its mode, and has the signals of its modes and what it keeps.
    """
    if kind is not Kind.CONTROLLER:
        own = str(name_text(name))
        modes = listed(attributes.get("modes")) if kind is Kind.MACHINE else []
        kept = kept_names(attributes) if kind is Kind.MACHINE else ()
        return Carried((own, *(f"{own}_{mode}" for mode in modes), *kept), own)
    gives = list(kept_names({"outputs": attributes.get("outputs")}))
    if not gives:
        raise StructureError(f"node {name!r} gives nothing; name what it gives, gives={{'u': ...}}")
    names = dict.fromkeys((*gives, *kept_names(attributes)))
    return Carried(tuple(names), gives[0] if len(gives) == 1 else None)


def _which(kind: Kind) -> str:
    """The variable that a node stands for: what it detects, gives as a storage, or has in common."""
    if kind.detects:
        return OTHER[kind.gives]
    return kind.gives if kind.stores else kind.common


def _called(
    name: Hashable, attributes: Mapping[str, Any], port: str | None
) -> Iterator[tuple[str, bool, str]]:
    """What a node names, whether it was given, and which quantity of which port it is; of one port alone."""
    given_ports = {
        (key[0], name_text(one)): at
        for key in ("effort", "flow")
        if isinstance(attributes.get(key), Mapping)
        for at, one in attributes[key].items()
    }
    for begin, end, given in quantities(name, attributes):
        at = given_ports.get((begin[:1], given), end.removeprefix("_")) if given else end[1:]
        if port is None or not begin or at == port:
            ending = f"_{at}" if at else ""
            text = str(name_text(f"{begin}{name}{end}")) if given is None else given
            yield text, given is not None, f"{begin}{ending}"


def _at_junctions(
    bonds: "nx.DiGraph[Hashable]", name: Hashable, which: str, port: str | None
) -> Iterator[Called]:
    """What the nodes at a junction call the variable that it has in common; at its own, or a node's."""
    for junction in (name, *nx.all_neighbors(bonds, name)):
        if kind_of(bonds.nodes[junction], f"node {junction!r}").common != which:
            continue
        if port is not None and port not in _bond(bonds, name, junction).values():
            continue
        for one in (junction, *nx.all_neighbors(bonds, junction)):
            for text, given, what in _called(one, bonds.nodes[one], None):
                if what == f"{which[0]}_" and one != name:
                    yield text, given


def _bond(bonds: "nx.DiGraph[Hashable]", one: Hashable, other: Hashable) -> Mapping[str, Any]:
    """The attributes of the bond between two nodes, the ports that it names among them."""
    return bonds.edges[(one, other) if bonds.has_edge(one, other) else (other, one)]

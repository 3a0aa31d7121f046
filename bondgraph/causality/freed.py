"""Laws that are turned round where they contradict each other, or impose what a storage keeps."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import replace

import networkx as nx
import sympy as sp

from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.vanishing import elements_in
from bondgraph.declare.validate import with_elements
from bondgraph.nodes.elements import Element
from bondgraph.nodes.inverting import flipped, why_unturned, with_inverse

Tried = Callable[["nx.DiGraph[Hashable]"], CausalGraph | None]
"""From a graph to its strokes, None where they contradict each other."""


def storages_freed(checked: "nx.DiGraph[Hashable]") -> dict[Hashable, Element]:
    """The storages whose laws have inverses that nobody declared."""
    found: dict[Hashable, Element] = {}
    for name, element in elements_in(checked).items():
        turned = with_inverse(element) if element.gives is not None else None
        if turned is not None:
            found[name] = turned
    return found


def fewest_turned(
    checked: "nx.DiGraph[Hashable]", tried: Tried, before: CausalGraph | None = None
) -> CausalGraph | None:
    """The strokes with as few laws of resistances turned round as will do, one after the other put back.

    None where that does not help: there are none, or no more storages become independent than ``before``.
    """
    elements = elements_in(checked)
    other = {name: new for name, one in elements.items() if (new := flipped(one)) is not None}
    best = _freely(checked, other, tried)
    if best is None or (before is not None and len(best.derivative) >= len(before.derivative)):
        return None
    turned = {name: new for name, new in other.items() if _gives(best, name) == new.gives}
    for name in tuple(turned):
        less = {one: new for one, new in turned.items() if one != name}
        found = tried(with_elements(checked, less))
        if found is not None and len(found.derivative) <= len(best.derivative):
            turned = less
    return tried(with_elements(checked, turned)) if turned else None


def _freely(
    checked: "nx.DiGraph[Hashable]", other: Mapping[Hashable, Element], tried: Tried
) -> CausalGraph | None:
    """The strokes with linear resistances, which go either way, for laws that do."""
    linear = {
        name: replace(new, law=None, gives=None, value=sp.Symbol(f"any_{at}"))
        for at, (name, new) in enumerate(other.items())
    }
    return tried(with_elements(checked, linear)) if linear else None


def _gives(found: CausalGraph, name: Hashable) -> str:
    """What a one-port gives."""
    return found.assignment.gives(found.assignment.names.index(name))


def wanting(checked: "nx.DiGraph[Hashable]", story: str, turned: Mapping[Hashable, Element]) -> str:
    """The way out where a story names a nonlinear storage whose law was not turned round."""
    for name, element in elements_in(checked).items():
        nonlinear = element.kind.stores and element.law is not None and element.gives is not None
        if nonlinear and name not in turned and repr(name) in story:
            way = f"; or give {name!r} the inverse of its law, with which it goes either way"
            return way + why_unturned(element)
    return ""

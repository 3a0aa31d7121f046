"""Strokes as they were drawn: of a graph's bonds, and those that are told beside it."""

from collections.abc import Hashable, Mapping
from typing import Any

from bondgraph.declare.wires import is_wire
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Bond

Drawn = Mapping[Bond, Hashable]
"""Bonds, as declared, to the node at whose end the stroke was drawn."""


def strokes_drawn(graph: Any, strokes: Drawn | None) -> dict[Bond, Hashable]:
    """The strokes of a declared graph's bonds, ``stroke="tail"`` or ``"head"``, and those told beside it.

    Raises `StructureError` for a bond that is not there, an end that is none of it, and a bond that is
    told twice in different ways.
    """
    found: dict[Bond, Hashable] = {}
    for tail, head, attributes in graph.edges(data=True):
        if attributes.get("stroke") is not None:
            found[tail, head] = tail if attributes["stroke"] == "tail" else head
    for bond, end in (strokes or {}).items():
        if not graph.has_edge(*bond) or is_wire(graph, *bond):
            raise StructureError(f"strokes: there is no bond {bond!r}; name it as it was declared")
        if end not in bond:
            raise StructureError(
                f"strokes: {end!r} is no end of bond {bond!r}; give one of the two"
            )
        if found.setdefault(bond, end) != end:
            raise StructureError(
                f"strokes: bond {bond!r} has a stroke at {found[bond]!r} and is told to have it at {end!r}"
            )
    return found

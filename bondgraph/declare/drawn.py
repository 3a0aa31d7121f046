"""`BondGraph`: a declared graph that notebooks draw."""

from collections.abc import Hashable
from typing import TYPE_CHECKING, Any

import networkx as nx

from bondgraph.declare.wires import is_wire
from bondgraph.errors import BondGraphError

if TYPE_CHECKING:
    _DiGraph = nx.DiGraph[Hashable]
else:
    _DiGraph = nx.DiGraph

MOST = 300
"""Nodes; of larger graphs the sizes are told alone."""


class BondGraph(_DiGraph):
    """A `networkx.DiGraph` as any other, which notebooks draw and ``print`` lists bond by bond.

    What cannot be drawn yet is listed as it was declared, with the reason.

    >>> import bondgraph as bg
    >>> made = bg.graph([bg.Se("push", "F"), bg.I("m", "m")], "push > m")
    >>> made
    <BondGraph: 2 nodes, 1 bond>
    >>> print(made)
    Se: F   ──⇀|  I: m
    """

    def __repr__(self) -> str:
        wires = sum(is_wire(self, *edge) for edge in self.edges)
        counts = {"node": len(self), "bond": self.number_of_edges() - wires, "wire": wires}
        told = [
            f"{count} {word}{'s' * (count != 1)}"
            for word, count in counts.items()
            if count or word != "wire"
        ]
        return f"<{type(self).__name__}: {', '.join(told)}>"

    def __str__(self) -> str:
        """A line a bond, with its stroke; else as declared, and why."""
        from bondgraph.drawing.picture import drawing

        if len(self) > MOST:
            return repr(self)
        try:
            return drawing(self).text()
        except BondGraphError as error:
            return "\n".join((*_declared(self), f"Not drawn: {error}"))

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(str(self))

    def _repr_svg_(self) -> str | None:
        """The drawn graph, for notebooks; None where it cannot be drawn, so that they show the text."""
        from bondgraph.drawing.picture import drawing

        if len(self) > MOST:
            return None
        try:
            return drawing(self).svg()
        except BondGraphError:
            return None


def _declared(graph: BondGraph) -> list[str]:
    """Nodes by kind and name, and bonds, as they were declared."""
    nodes = [f"{data.get('kind', '?')} {name}" for name, data in graph.nodes(data=True)]
    return [*nodes, *(f"{tail} > {head}" for tail, head in graph.edges)]

"""`CausalGraph`: a graph whose bonds have causal strokes."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field

import networkx as nx

from bondgraph.causality.record import Strokes
from bondgraph.causality.stories import stroke_story
from bondgraph.nodes.elements import Bond


@dataclass(frozen=True)
class CausalGraph:
    """A validated graph with a causal stroke on every bond.

    ``strokes``: bond, as declared, to the node that receives its effort. ``integral`` and
    ``derivative``: the storages' names, in declaration order.
    """

    graph: "nx.DiGraph[Hashable]"
    strokes: Mapping[Bond, Hashable]
    integral: tuple[Hashable, ...]
    derivative: tuple[Hashable, ...]
    #: The numbered form that later stages follow.
    assignment: Strokes = field(repr=False, compare=False)

    def why(self, node: Hashable) -> tuple[str, ...]:
        """The story of a one-port's causality, one sentence a line, choices first.

        Raises `KeyError` for a name that is not a node.
        """
        if node not in self.graph:
            raise KeyError(node)
        return stroke_story(self.assignment, self.assignment.names.index(node))

    def _repr_svg_(self) -> str:
        """The drawn graph, for notebooks."""
        from bondgraph.drawing.picture import drawing

        return drawing(self).svg()

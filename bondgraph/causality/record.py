"""Causal strokes as the search leaves them: whole, and not changed any more."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from bondgraph.nodes.elements import Bond, Element


@dataclass(frozen=True)
class Reason:
    """Why a bond has its stroke: the node that decided, in which words, and the bonds it followed from."""

    node: int
    text: str
    causes: tuple[int, ...] = ()


@dataclass(frozen=True)
class Contradiction:
    """A node whose rule two chains of strokes break: the bonds at which they arrive."""

    node: int
    text: str
    bonds: tuple[int, ...]
    attempt: Reason | None = None


class Ends:
    """What strokes tell of bonds and one-ports, while they are searched for and when they are found."""

    bonds: Sequence[tuple[int, int]]
    at: Sequence[Sequence[int]]
    end: Sequence[int | None]

    def other(self, bond: int, node: int) -> int:
        """The node at the bond's other end."""
        tail, head = self.bonds[bond]
        return head if node == tail else tail

    def end_for(self, node: int, gives: str) -> int:
        """Where the stroke lies on a one-port's bond when the one-port gives its effort, or its flow."""
        return node if gives == "flow" else self.other(self.at[node][0], node)

    def gives(self, node: int) -> str:
        """What a one-port gives, "effort" or "flow", once its bond has a stroke."""
        return "flow" if self.end[self.at[node][0]] == node else "effort"


@dataclass(frozen=True)
class Strokes(Ends):
    """The strokes of a graph's bonds; nodes and bonds are numbered in declaration order.

    ``end[b]`` is the number of the node that receives the effort of bond b, None where a search has not
    come to it; ``reason[b]`` is why.
    """

    names: tuple[Hashable, ...]
    elements: tuple[Element, ...]
    #: The nodes at the tail and at the head of each bond.
    bonds: tuple[tuple[int, int], ...]
    declared: tuple[Bond, ...]
    #: The bonds at each node.
    at: tuple[tuple[int, ...], ...]
    end: tuple[int | None, ...]
    reason: tuple[Reason | None, ...]
    #: Bonds in the order in which they got their strokes.
    trail: tuple[int, ...]

"""Causal strokes that spread: what one stroke forces at the nodes it touches, and how to take it back."""

from collections import deque
from collections.abc import Hashable, Sequence

import networkx as nx

from bondgraph.causality.record import Contradiction, Ends, Reason, Strokes
from bondgraph.nodes.elements import Element


class StrokeSearch(Ends):
    """A partial assignment of strokes with a trail, so that trials can be undone.

    Nodes and bonds are numbered in declaration order. ``end[b]`` is the number of the node that
    receives the effort of bond b, or None.
    """

    def __init__(self, graph: "nx.DiGraph[Hashable]") -> None:
        self.names = list(graph)
        number = {name: at for at, name in enumerate(self.names)}
        self.elements: list[Element] = [graph.nodes[name]["element"] for name in self.names]
        self.bonds: list[tuple[int, int]] = [
            (number[tail], number[head]) for tail, head in graph.edges
        ]
        self.declared = [graph.edges[bond]["declared"] for bond in graph.edges]
        self.at: list[list[int]] = [[] for _ in self.names]
        for bond, ends in enumerate(self.bonds):
            for node in ends:
                self.at[node].append(bond)
        self.end: list[int | None] = [None] * len(self.bonds)
        self.reason: list[Reason | None] = [None] * len(self.bonds)
        self.trail: list[int] = []
        self._special = [0] * len(self.names)
        self._assigned = [0] * len(self.names)

    @property
    def found(self) -> Strokes:
        """The strokes as they are now, for good."""
        return Strokes(
            tuple(self.names), tuple(self.elements), tuple(self.bonds), tuple(self.declared),
            tuple(map(tuple, self.at)), tuple(self.end), tuple(self.reason),
            tuple(self.trail),
        )  # fmt: skip

    def assign(self, bond: int, end: int, reason: Reason) -> Contradiction | None:
        """Set one stroke and all that follow from it; stop at the first contradiction."""
        queue = deque([(bond, end, reason)])
        while queue:
            bond, end, reason = queue.popleft()
            if self.end[bond] is not None:
                if self.end[bond] != end:
                    return Contradiction(reason.node, reason.text, (bond, *reason.causes), reason)
                continue
            self._set(bond, end, reason)
            for node in self.bonds[bond]:
                forced = self._forced(node, bond)
                if isinstance(forced, Contradiction):
                    return forced
                queue.extend(forced)
        return None

    def undo(self, length: int) -> None:
        """Take back every stroke set since the trail had this length."""
        while len(self.trail) > length:
            bond = self.trail.pop()
            for node in self.bonds[bond]:
                self._assigned[node] -= 1
                self._special[node] -= self._is_special(node, bond)
            self.end[bond] = self.reason[bond] = None

    def _set(self, bond: int, end: int, reason: Reason) -> None:
        self.end[bond], self.reason[bond] = end, reason
        self.trail.append(bond)
        for node in self.bonds[bond]:
            self._assigned[node] += 1
            self._special[node] += self._is_special(node, bond)

    def _is_special(self, node: int, bond: int) -> bool:
        """Whether the bond brings a junction what it takes from one bond only: effort (0), flow (1)."""
        return (self.end[bond] == node) == (self.elements[node].kind.common != "flow")

    def _forced(self, node: int, bond: int) -> Sequence[tuple[int, int, Reason]] | Contradiction:
        kind = self.elements[node].kind
        if kind.joins:
            return self._forced_at_junction(node, bond)
        if kind.two_port:
            return self._forced_at_two_port(node, bond)
        return self._checked_at_one_port(node, bond)

    def _forced_at_junction(
        self, node: int, bond: int
    ) -> Sequence[tuple[int, int, Reason]] | Contradiction:
        zero = self.elements[node].kind.common == "effort"
        what, bonds = "effort" if zero else "flow", self.at[node]
        if self._special[node] > 1:
            both = tuple(b for b in bonds if self.end[b] is not None and self._is_special(node, b))
            return Contradiction(node, f"only one bond may bring its {what}, not two", both)
        if self._special[node] == 0 and self._assigned[node] == len(bonds):
            return Contradiction(node, f"one bond must bring its {what}, none does", tuple(bonds))
        if self._special[node] == 1 and self._is_special(node, bond):
            reason = Reason(node, f"takes its {what} from one bond only", (bond,))
            free = [b for b in bonds if self.end[b] is None]
            return [(b, self.other(b, node) if zero else node, reason) for b in free]
        if self._special[node] == 0 and self._assigned[node] == len(bonds) - 1:
            last = next(b for b in bonds if self.end[b] is None)
            causes = tuple(b for b in bonds if b != last)
            reason = Reason(node, f"has one bond left to take its {what} from", causes)
            return [(last, node if zero else self.other(last, node), reason)]
        return []

    def _forced_at_two_port(self, node: int, bond: int) -> list[tuple[int, int, Reason]]:
        first, second = self.at[node]
        across = second if bond == first else first
        receives = self.end[bond] == node
        gyrator = self.elements[node].kind.gyrates
        text = "gyrates what it receives" if gyrator else "passes causality through"
        end = node if receives == gyrator else self.other(across, node)
        return [(across, end, Reason(node, text, (bond,)))]

    def _checked_at_one_port(self, node: int, bond: int) -> list[tuple[int, int, Reason]]:
        """A fixed one-port asks for its own stroke again, so that a contradiction names it."""
        gives = self.elements[node].gives
        if gives is None or self.end[bond] == self.end_for(node, gives):
            return []
        return [(bond, self.end_for(node, gives), Reason(node, f"imposes its {gives}"))]

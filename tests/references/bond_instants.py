"""Whether efforts and flows of all bonds satisfy the bond equations: at instants, and between them.

Assumed: constant values, given as numbers; sources and open ports give what is told; dry friction
gives its level against the slip, and at rest at most that. What a storage holds changes by the integral of
what flows into it, taken by Gauss's 12 points in each panel between two edges: between edges everything
must be smooth, so that an event that is not among them shows. Nothing is derived, ordered or solved.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from .bond_equations import Bond, Term, equations, is_input, one_bond

Array = NDArray[np.float64]
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
AT_REST = 1e-9


def instants(edges: Iterable[float], panels: int = 1) -> Array:
    """Edges of panels, ``panels`` in each stretch, each followed by its 12 inner points [s]."""
    ends = sorted(set(edges))
    cut = [np.linspace(a, b, panels + 1)[:-1] for a, b in pairwise(ends)]
    starts = np.append(np.concatenate(cut), ends[-1])
    inner = starts[:-1, None] + np.diff(starts)[:, None] * (POINTS + 1) / 2
    return np.append(np.column_stack([starts[:-1], inner]).ravel(), starts[-1])


@dataclass(frozen=True)
class Told:
    """What a run tells: (effort, flow) of every bond at `instants`.

    ``given``: what each source and open port gives; ``levels``: of ports with dry friction; ``times_value``:
    by how much the value of a one-port is more than the graph has, at all instants.
    """

    times: Array
    bonds: Mapping[Bond, tuple[Array, Array]]
    given: Mapping[str, Array]
    levels: Mapping[str, Array] = field(default_factory=dict)
    times_value: Mapping[str, Array] = field(default_factory=dict)

    def value(self, term: Term, node: str = "") -> Array:
        """A summand without its power of s."""
        factor: float | Array = float(term.factor)
        if node in self.times_value and term.factor != 1:
            factor = factor * self.times_value[node]
        return term.sign * factor * self.bonds[term.bond][term.variable == "flow"]

    def integrals(self, values: Array) -> Array:
        """Over each panel, from the values at all instants."""
        widths = np.diff(self.times[::13])
        panels = values[:-1].reshape(-1, 13)[:, 1:]
        return np.asarray(panels @ WEIGHTS * widths / 2, dtype=float)


def misfits(graph: nx.DiGraph[str], told: Told) -> dict[str, float]:
    """How far each node's equations are from being satisfied, over the largest of their terms."""
    return {node: max(_misfits(graph, node, told)) for node in graph}


def _misfits(graph: nx.DiGraph[str], node: str, told: Told) -> Iterable[float]:
    if node in told.levels:
        yield _friction(graph, node, told)
        return
    for terms in equations(graph, node):
        if is_input(graph, node):
            yield _over([told.value(terms[0]), -told.given[node]])
        elif any(term.order for term in terms):
            yield _storage(terms, told, node)
        else:
            yield _over([told.value(term, node) for term in terms])


def _over(summands: list[Array]) -> float:
    """A sum that ought to vanish, over its largest summand."""
    size = max(float(np.abs(part).max()) for part in summands)
    return float(np.abs(sum(summands)).max()) / size if size else 0.0


def _storage(terms: list[Term], told: Told, node: str) -> float:
    """What flows in over each panel, and how what is held changes."""
    (stored,) = (told.value(term, node) for term in terms if term.order)
    (flowing,) = (told.value(term) for term in terms if not term.order)
    change = np.diff(stored[::13])
    widths = np.diff(told.times[::13])
    size = max(float(np.abs(stored).max()), float((np.abs(flowing).max() * widths).max()))
    return float(np.abs(told.integrals(flowing) + change).max()) / size if size else 0.0


def _friction(graph: nx.DiGraph[str], node: str, told: Told) -> float:
    """At its level where it slips; at rest within it."""
    (effort, slip), level = told.bonds[one_bond(graph, node)], told.levels[node]
    moving = np.abs(slip) > AT_REST * np.abs(slip).max(initial=0.0)
    wrong = np.where(moving, np.abs(effort - level * np.sign(slip)), np.abs(effort) - level)
    return float(wrong.max(initial=0.0) / max(level.max(initial=0.0), 1e-300))

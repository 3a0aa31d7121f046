"""Matrices that change in time as sums of names, solved for the rates block by block of A."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np

from codegen.standalone.arrays import Array
from codegen.standalone.matrices import scaled_solve
from codegen.straight.sums import Lines, Sum

Calls = list[Callable[..., list[float]]]
"""What lines call by their numbers."""


@dataclass(frozen=True)
class Inverse:
    """From the entries of a square matrix, by rows, to those of its inverse; ``size``: how many rows."""

    size: int

    def __call__(self, *entries: float) -> list[float]:
        """The entries; not numbers where there is no inverse."""
        A = np.array(entries, dtype=float).reshape(self.size, self.size)
        try:
            found: list[float] = scaled_solve(A, np.eye(self.size)).ravel().tolist()
        except np.linalg.LinAlgError:
            found = [np.nan] * len(entries)
        return found


def solving(lines: Lines, calls: Calls) -> Callable[[Array, Array], Array]:
    """What gives ``A^-1`` times another matrix, both of sums and numbers."""

    def solve(A: Any, right: Any) -> Any:
        found = np.zeros_like(right)
        for part in _blocks(A):
            own = A[np.ix_(part, part)]
            if len(part) == 1:
                found[part] = right[part] / own[0, 0]
            else:
                found[part] = _inverse(own, lines, calls) @ right[part]
        return found

    return solve


def _inverse(A: Any, lines: Lines, calls: Calls) -> Any:
    entries, size = A.ravel().tolist(), len(A)
    if not any(isinstance(entry, Sum) for entry in entries):
        return scaled_solve(A.astype(float), np.eye(size)).astype(object)
    calls.append(Inverse(size))
    found = np.empty(size * size, dtype=object)
    read = [lines.named(entry if isinstance(entry, Sum) else float(entry)) for entry in entries]
    found[:] = lines.new(len(calls) - 1, read, size * size)
    return found.reshape(size, size)


def _blocks(A: Any) -> list[list[int]]:
    """States that A couples, each with those it is coupled to."""
    coupled: nx.Graph[int] = nx.Graph()
    coupled.add_nodes_from(range(len(A)))
    places = np.argwhere([[isinstance(entry, Sum) or bool(entry) for entry in row] for row in A])
    coupled.add_edges_from((int(i), int(j)) for i, j in places.reshape(-1, 2))
    return sorted(sorted(part) for part in nx.connected_components(coupled))

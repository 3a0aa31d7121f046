"""The rates that ``A x' = r`` tells, block by block: independent storages share no equation."""

from collections.abc import Sequence
from typing import Any

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import FixedRow, SingularError
from bondgraph.algebra.residues import is_zero
from bondgraph.solving.eliminated import eliminated
from bondgraph.solving.inverse import inverse
from bondgraph.solving.steps import Steps


def solved(matrix: Sequence[FixedRow], right: Sequence[sp.Expr], steps: Steps) -> list[sp.Expr]:
    """``matrix x = right`` for x, exactly: each unknown over steps, and of ``right`` itself.

    Unknowns that are told by others come after them (block triangular form). A small block is inverted,
    each row over one denominator; a larger one is eliminated in steps. Raises `SingularError`.

    >>> a, b, u = sp.symbols("a b u")
    >>> solved([{0: a}, {0: b, 1: sp.Integer(1)}], [u, u], Steps())
    [u/a, -_s*b + u]
    """
    found: dict[int, sp.Expr] = {}
    for rows, columns in blocks(matrix):
        own = set(columns)
        place = {j: at for at, j in enumerate(columns)}
        inside = [{place[j]: e for j, e in sorted(matrix[i].items()) if j in own} for i in rows]
        told = [
            sp.Add(
                right[i],
                *(-e * steps.named(found[j]) for j, e in sorted(matrix[i].items()) if j not in own),
            )
            for i in rows
        ]
        for j, value in zip(columns, _block(inside, told, steps), strict=True):
            found[j] = value
    return [found[j] for j in range(len(matrix))]


def _block(matrix: Sequence[FixedRow], right: Sequence[sp.Expr], steps: Steps) -> Sequence[sp.Expr]:
    if len(matrix) == 1:
        (entry,) = matrix[0].values()
        if is_zero(entry):
            raise SingularError
        return [right[0] / entry]
    right = [steps.named(one) for one in right]
    rows = inverse(matrix)
    if rows is None:
        return eliminated(matrix, right, steps)
    return [
        sp.Add(*(entry * right[j] for j, entry in row.over.items())) / row.under for row in rows
    ]


def blocks(matrix: Sequence[FixedRow]) -> list[tuple[list[int], list[int]]]:
    """Rows and columns of diagonal blocks that cannot be split, each after those whose unknowns it reads.

    Raises `SingularError` where the places of the entries alone leave no determinant.

    >>> one = sp.Integer(1)
    >>> blocks([{0: one, 1: one}, {1: one, 2: one}, {1: one, 2: -one}])
    [([1, 2], [1, 2]), ([0], [0])]
    """
    size = len(matrix)
    pairs: nx.Graph[int] = nx.Graph()
    pairs.add_nodes_from(range(2 * size))
    pairs.add_edges_from((i, size + j) for i, row in enumerate(matrix) for j in sorted(row))
    matched = nx.bipartite.maximum_matching(pairs, range(size))
    if len(matched) < 2 * size:
        raise SingularError
    column = {i: matched[i] - size for i in range(size)}
    reads: nx.DiGraph[int] = nx.DiGraph()
    reads.add_nodes_from(range(size))
    owner = {j: i for i, j in column.items()}
    reads.add_edges_from((i, owner[j]) for i, row in enumerate(matrix) for j in row)
    return [(part, sorted(column[i] for i in part)) for part in parts_in_order(reads)]


def parts_in_order(reads: "nx.DiGraph[Any]") -> list[list[Any]]:
    """The strongly connected parts of a graph of what reads what, each after those that it reads.

    Inside a part, and where it is left open, the order is that in which nodes were added.

    >>> parts_in_order(nx.DiGraph([("a", "b"), ("b", "c"), ("c", "b")]))
    [['b', 'c'], ['a']]
    """
    place = {node: at for at, node in enumerate(reads)}
    whole = nx.condensation(reads.reverse(copy=False))
    members = {at: sorted(part, key=place.__getitem__) for at, part in whole.nodes(data="members")}
    first = {at: place[part[0]] for at, part in members.items()}
    return [members[at] for at in nx.lexicographical_topological_sort(whole, first.__getitem__)]

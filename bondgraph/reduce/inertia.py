"""The matrix A: what states and the dependent storages behind them make of x', and whether it is regular."""

from dataclasses import replace
from types import MappingProxyType

import mpmath
import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import Row
from bondgraph.algebra.residues import (
    DIGITS,
    at_some_numbers,
    decided_by_residues,
    is_plainly_some,
    is_zero,
    residues,
)
from bondgraph.causality.vanishing import generic, told
from bondgraph.errors import SingularStorageError
from bondgraph.reduce.ports import reduce_ports
from bondgraph.reduce.rates import reached
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.storages import stored_rate

LARGEST_ROOTED = 6
"""Blocks of A of more states are decided by residues alone, roots and functions or not."""


def inertia(reduction: Reduction) -> tuple[list[Row], list[Reading]]:
    """A by rows, and the right sides ``J x + B u + E u'``; their H is -A."""
    A: list[Row] = []
    balances: list[Reading] = []
    for port in reduction.states:
        balance = ReadingSum(reduction.reading(reduction.driving(port)))
        balance.add(stored_rate(reduction, port), -sp.Integer(1))
        A.append({j: -entry for j, entry in balance.H.items()})
        balances.append(balance.whole())
    return A, balances


def check_regular(reduction: Reduction, A: list[Row]) -> None:
    """Refuse an A whose determinant vanishes: exactly for its diagonal part, by residues for the rest."""
    states = reduction.names
    coupled = {i for i, row in enumerate(A) for j in row if i != j}
    coupled |= {j for i, row in enumerate(A) for j in row if i != j}
    for i, row in enumerate(A):
        if i not in coupled and (i not in row or (not row[i].is_Symbol and is_zero(row[i]))):
            raise SingularStorageError(
                f"the storages that rule {states[i]}' cancel each other{_told(reduction, i)}; change a value"
            )
    value = residues()
    rows = ResidueRows(
        {j: entry for j, expr in A[i].items() if (entry := value(expr))} for i in sorted(coupled)
    )
    for i in sorted(coupled):
        if not rows.pivot(i, jordan=False) or _vanishes_by_roots(A, i):
            raise SingularStorageError(
                f"the matrix A is singular: {states[i]}' is not determined by the storages' values"
                f"{_told(reduction, i)}; change a value, or leave out a storage that cancels another"
            )


def _vanishes_by_roots(A: list[Row], state: int) -> bool:
    """Whether the block that a state begins has a determinant that only roots or functions cancel.

    Residues don't see every such identity; a small block's determinant is looked at as it is.
    """
    block = reached(A, [state])
    entries = [entry for i in block for entry in A[i].values()]
    if state != block[0] or len(block) > LARGEST_ROOTED or all(map(decided_by_residues, entries)):
        return False
    n, zero = len(block), sp.Integer(0)
    rows = [[A[i].get(j, zero) for j in block] for i in block]
    numbers = at_some_numbers([entry for row in rows for entry in row])
    if numbers is not None:
        with mpmath.workdps(DIGITS):
            value = mpmath.det(mpmath.matrix([numbers[i * n : i * n + n] for i in range(n)]))
        if is_plainly_some(value):
            return False
    return is_zero(sp.Matrix(rows).det())


def _told(reduction: Reduction, state: int) -> str:
    """The determinant that vanishes, over storages and ratios under names of their own."""
    if reduction.motion is not None:
        return ""
    structure = reduction.structure
    made, values = generic({p.element.name: p.element for p in structure.ports})
    ports = tuple(replace(p, element=made.get(p.element.name, p.element)) for p in structure.ports)
    elements = MappingProxyType({**structure.elements, **made})
    A, _ = inertia(reduce_ports(replace(structure, ports=ports, elements=elements)))
    block = reached(A, [state])
    rows = [{block.index(j): entry for j, entry in A[i].items()} for i in block]
    text = told(rows, values)
    return "" if text is None else f": {text}"

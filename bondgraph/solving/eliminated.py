"""A linear system solved in steps: sparse elimination with one name for each quantity on the way."""

from collections.abc import Sequence

import sympy as sp

from bondgraph.algebra.exact import FixedRow, SingularError
from bondgraph.algebra.residues import PRIME, residues
from bondgraph.solving.steps import Steps

Entry = tuple[list[sp.Expr], int]
"""The terms of a sum over names of steps, and its residue, which decides whether it is zero."""


def eliminated(matrix: Sequence[FixedRow], right: Sequence[sp.Expr], steps: Steps) -> list[sp.Expr]:
    """``matrix x = right`` solved for x, over names of steps; later unknowns stand in earlier ones.

    Pivots are those that fill in least (Markowitz 1957); residues decide which are zero, so that no
    expression is multiplied out. Raises `SingularError` if there are not enough.

    >>> a, b, c, u = sp.symbols("a b c u")
    >>> steps = Steps()
    >>> x = eliminated([{0: a, 1: b}, {0: b, 1: c}], [u, sp.Integer(0)], steps)
    >>> whole = [one.xreplace(steps.parts).xreplace(steps.parts).xreplace(steps.parts) for one in x]
    >>> sp.cancel(whole[1].xreplace(steps.parts))
    -b*u/(a*c - b**2)
    """
    value = residues()
    rows = [{j: ([e], v) for j, e in row.items() if (v := value(e))} for row in matrix]
    sums, open_rows = [[term] for term in right], set(range(len(rows)))
    done: list[tuple[int, int, dict[int, sp.Expr]]] = []
    while open_rows:
        i, j = _pivot(rows, open_rows)
        open_rows.remove(i)
        line = {k: steps.named(sp.Add(*terms)) for k, (terms, _) in sorted(rows[i].items())}
        done.append((i, j, line))
        told = steps.named(sp.Add(*sums[i]))
        inverted = pow(rows[i][j][1], -1, PRIME)
        for k in sorted(open_rows):
            if j in rows[k]:
                terms, residue = rows[k].pop(j)
                factor = steps.named(sp.Add(*terms) / line[j])
                residues_ = {at: -residue * inverted * v for at, (_, v) in rows[i].items()}
                _add(rows[k], j, line, -factor, residues_)
                sums[k] += [-factor * told] if told != 0 else []
    found: dict[int, sp.Expr] = {}
    for i, j, line in reversed(done):
        others = [-entry * found[k] for k, entry in line.items() if k != j]
        found[j] = steps.named(sp.Add(*sums[i], *others) / line[j])
    return [found[j] for j in range(len(rows))]


def _pivot(rows: Sequence[dict[int, Entry]], open_rows: set[int]) -> tuple[int, int]:
    """The row and the column whose elimination fills in least; on the diagonal where that is as good."""
    held: dict[int, int] = {}
    for i in open_rows:
        for j in rows[i]:
            held[j] = held.get(j, 0) + 1
    choices = [
        ((len(rows[i]) - 1) * (held[j] - 1), i != j, i, j) for i in open_rows for j in rows[i]
    ]
    if not choices or any(not rows[i] for i in open_rows):
        raise SingularError
    return min(choices)[2:]


def _add(
    row: dict[int, Entry], pivot: int, line: dict[int, sp.Expr], factor: sp.Expr,
    residues_of: dict[int, int],
) -> None:  # fmt: skip
    """Add a multiple of a row in place, but for the column of its pivot; what cancels is dropped."""
    for j, entry in line.items():
        if j == pivot:
            continue
        terms, residue = row.get(j, ([], 0))
        new = (residue + residues_of[j]) % PRIME
        if new:
            row[j] = ([*terms, factor * entry], new)
        else:
            row.pop(j, None)

"""Inverses over polynomials without fractions on the way, given up where they grow long."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import sympy as sp
from sympy.polys.constructor import construct_domain
from sympy.polys.rings import PolyElement

from bondgraph.algebra.exact import FixedRow

MOST_TERMS = 60
"""An entry, of the inverse or on the way, that has more terms is long."""

PolyRow = dict[int, PolyElement]


@dataclass(frozen=True)
class Adjugate:
    """``inverse = over / under``, polynomials; what a row shares with ``under`` is cancelled."""

    over: tuple[FixedRow, ...]
    under: tuple[sp.Expr, ...]


def adjugate(matrix: Sequence[FixedRow]) -> Adjugate | None:
    """The inverse of a regular matrix of fractions of polynomials, a denominator for each row.

    Elimination after Bareiss (1968): every entry on the way is a minor, and what divides it is known. None
    where entries are no such fractions with rational numbers, or get more than `MOST_TERMS` terms.

    >>> a, b = sp.symbols("a b")
    >>> adjugate([{0: a, 1: sp.Integer(1)}, {0: sp.Integer(1), 1: 1/b}])
    Adjugate(over=({0: 1, 1: -b}, {0: -b, 1: a*b}), under=(a - b, a - b))
    """
    count = len(matrix)
    places = [(i, j) for i, row in enumerate(matrix) for j in row]
    # The name puts a ring of polynomials below numbers, too.
    domain, elements = construct_domain(
        [sp.Dummy(), *(matrix[i][j] for i, j in places)], field=True
    )
    if not domain.is_FractionField or not (domain.domain.is_ZZ or domain.domain.is_QQ):
        return None
    fractions = dict(zip(places, elements[1:], strict=True))
    rows: list[PolyRow] = []
    scales: list[PolyElement] = []
    for i, row in enumerate(matrix):
        scale = reduce(lambda one, other: one.lcm(other), (fractions[i, j].denom for j in row))
        own = {j: f.numer * scale.exquo(f.denom) for j in row if (f := fractions[i, j])}
        rows.append({**own, count + i: domain.field.ring.one})
        scales.append(scale)
    found = _eliminated(rows, domain.field.ring.one)
    if found is None:
        return None
    return _told([{j: e * scales[j] for j, e in sorted(row.items())} for row in found[0]], found[1])


def _eliminated(rows: list[PolyRow], last: PolyElement) -> tuple[list[PolyRow], PolyElement] | None:
    """The adjugate and the determinant of the left half of ``[matrix, 1]``."""
    count = len(rows)
    order: dict[int, int] = {}
    for _ in range(count):
        choices = [
            (len(rows[i]) * sum(j in row for row in rows), len(rows[i][j]), i, j)
            for i in range(count) if i not in order
            for j in rows[i] if j < count
        ]  # fmt: skip
        *_, p, c = min(choices)
        order[p] = c
        for i in range(count):
            if i != p:
                rows[i] = _step(rows[i], rows[p], c, last)
                if any(len(entry) > MOST_TERMS for entry in rows[i].values()):
                    return None
        last = rows[p][c]
    by_column = {
        c: {j - count: e for j, e in rows[p].items() if j >= count} for p, c in order.items()
    }
    return [by_column[c] for c in range(count)], last


def _step(row: PolyRow, pivot: PolyRow, column: int, last: PolyElement) -> PolyRow:
    """``(pivot[column] row - row[column] pivot) / last``, which leaves no rest."""
    factor = row.get(column)
    new = {j: pivot[column] * entry for j, entry in row.items() if j != column}
    if factor is not None:
        for j, entry in pivot.items():
            if j != column:
                new[j] = new[j] - factor * entry if j in new else -factor * entry
    return {j: entry.exquo(last) for j, entry in new.items() if entry}


def _told(rows: Sequence[PolyRow], under: PolyElement) -> Adjugate:
    """As expressions, each row without what it shares with the determinant."""
    over: list[FixedRow] = []
    below: list[sp.Expr] = []
    for row in rows:
        common = reduce(lambda one, other: one.gcd(other), row.values(), under)
        over.append({j: entry.exquo(common).as_expr() for j, entry in row.items()})
        below.append(under.exquo(common).as_expr())
    return Adjugate(tuple(over), tuple(below))

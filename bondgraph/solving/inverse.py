"""Inverses of small matrices of expressions as a person would write them: minors over a determinant."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.exact import FixedRow, SingularError, regular_by_residues
from bondgraph.algebra.factored import factored
from bondgraph.algebra.generators import Generators
from bondgraph.solving.polynomials import adjugate
from bondgraph.solving.steps import size

LARGEST_MINORS = 3
"""Up to so many rows the minors of the entries as they stand are looked at."""


MOST_FACTORED = 12
"""A polynomial of more terms is searched for no factors but those that all terms have."""


@dataclass(frozen=True)
class Fractions:
    """A row of an inverse: what stands above at each column, and the one denominator below."""

    over: Mapping[int, sp.Expr]
    under: sp.Expr

    @property
    def operands(self) -> int:
        """How long it is."""
        return sum(size(part, {}) for part in (*self.over.values(), self.under))


def inverse(matrix: Sequence[FixedRow]) -> list[Fractions] | None:
    """The shortest inverse of a square matrix, each row over one denominator; None where it is long.

    Squares of sines are those of cosines where that is shorter. Raises `SingularError`.

    >>> m, M, l, a = sp.symbols("m M l a")
    >>> rows = inverse([{0: m + M, 1: m*l*sp.cos(a)}, {0: m*l*sp.cos(a), 1: m*l**2}])
    >>> rows[0].over, rows[0].under
    ({0: l, 1: -cos(a)}, l*(M + m*sin(a)**2))
    """
    if not regular_by_residues(matrix):
        raise SingularError
    found = []
    if len(matrix) <= LARGEST_MINORS:
        found.append(_by_minors(matrix))
    if (rows := _multiplied_out(matrix)) is not None:
        found.append(rows)
    if not found:
        return None
    return [min(rows, key=lambda row: row.operands) for rows in zip(*found, strict=True)]


def _by_minors(matrix: Sequence[FixedRow]) -> list[Fractions]:
    """By the entries as they stand."""
    places = range(len(matrix))
    under = _minor(matrix, places, places)
    return [
        Fractions({
            i: minor * (-1) ** (i + j)
            for i in places
            if (minor := _minor(matrix, _without(places, i), _without(places, j))) != 0
        }, under)
        for j in places
    ]  # fmt: skip


def _without(places: Iterable[int], one: int) -> list[int]:
    return [at for at in places if at != one]


def _minor(matrix: Sequence[FixedRow], rows: Sequence[int], columns: Sequence[int]) -> sp.Expr:
    """The determinant of some rows and columns, by the first of the rows."""
    if not rows:
        return sp.Integer(1)
    first, *others = rows
    return sp.Add(*(
        (-1) ** at * matrix[first][j] * _minor(matrix, others, _without(columns, j))
        for at, j in enumerate(columns) if j in matrix[first]
    ))  # fmt: skip


def _multiplied_out(matrix: Sequence[FixedRow]) -> list[Fractions] | None:
    """By polynomials, what is common to a row and its denominator taken out; None where they are long."""
    names = Generators()
    found = adjugate([{j: names.plain(entry) for j, entry in row.items()} for row in matrix])
    if found is None:
        return None
    return [_factored(row, u, names) for row, u in zip(found.over, found.under, strict=True)]


def _factored(row: FixedRow, under: sp.Expr, names: Generators) -> Fractions:
    """Polynomials over one, each factored, in the squares of sines or of cosines."""
    parts = [under, *row.values()]
    for sine, cosine in names.pairs():
        ways = ((sine, cosine), (cosine, sine))
        turned = (_without_square(parts, one, other) for one, other in ways)
        parts = min((parts, *turned), key=lambda some: sum(map(_count, some)))
    common = (sp.gcd_list(parts) if names.pairs() else 1) * _sign(parts[0])
    under, *over = (names.back(_in_factors(part, common)) for part in parts)
    return Fractions(dict(zip(row, over, strict=True)), under)


def _in_factors(part: sp.Expr, common: sp.Expr) -> sp.Expr:
    """A polynomial without a factor that it has, as a product where it is short."""
    left = part / common if abs(common) == 1 else sp.cancel(part / common)
    return factored(left) if _count(left) <= MOST_FACTORED else sp.factor_terms(sp.expand(left))


def _without_square(parts: Iterable[sp.Expr], one: sp.Symbol, other: sp.Symbol) -> list[sp.Expr]:
    """Polynomials with ``one^2 = 1 - other^2`` wherever they hold a higher power of one."""
    return [sp.rem(part, one**2 + other**2 - 1, one) for part in parts]


def _count(part: sp.Expr) -> int:
    """The terms of a polynomial, multiplied out."""
    return len(sp.Add.make_args(sp.expand(part)))


def _sign(part: sp.Expr) -> int:
    """The sign that most terms of a polynomial have, multiplied out."""
    terms = sp.Add.make_args(sp.expand(part))
    negative = sum(term.could_extract_minus_sign() for term in terms)
    return -1 if 2 * negative > len(terms) else 1

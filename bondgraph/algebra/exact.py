"""Exact linear algebra on small systems of expressions, in the field that their entries generate."""

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import sympy as sp
from sympy.polys.constructor import construct_domain
from sympy.polys.matrices import DomainMatrix

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.expressions import expanded_terms
from bondgraph.algebra.generators import Generators
from bondgraph.algebra.residues import is_zero, residues

Row = dict[int, sp.Expr]
"""A sparse row: column to expression, no zeros."""

FixedRow = Mapping[int, sp.Expr]
"""A sparse row that is not changed any more."""

SHORT_OPERATIONS = 60
SHORT_TERMS = 100
"""A sum with more operations, or more terms when multiplied out, is left as it came."""


class SingularError(ArithmeticError):
    """The matrix of a linear system has a determinant that vanishes identically."""


def fixed(row: FixedRow) -> FixedRow:
    """A read-only copy of a sparse row; the row itself where it is read-only already.

    >>> fixed({0: sp.Symbol("a")})[1] = sp.Symbol("b")
    Traceback (most recent call last):
    TypeError: 'mappingproxy' object does not support item assignment
    """
    return row if isinstance(row, MappingProxyType) else MappingProxyType(dict(row))


def add_scaled(target: Row, row: FixedRow, factor: sp.Expr) -> None:
    """Add ``factor * row`` to a sparse row in place, dropping entries that cancel exactly."""
    for column, entry in row.items():
        if column in target:
            total = cancelled(target[column] + factor * entry)
            if total.is_zero:
                del target[column]
            else:
                target[column] = total
        else:
            target[column] = factor * entry


def scaled(row: FixedRow, factor: sp.Expr) -> Row:
    """``factor * row``."""
    return {column: factor * entry for column, entry in row.items()}


def cancelled(expr: sp.Expr) -> sp.Expr:
    """The shorter of a sum and its cancelled form; 0 exactly when it vanishes identically."""
    if expr.is_Rational or expr.is_Symbol:
        return expr
    if is_zero(expr):
        return sp.Integer(0)
    if not expr.is_Add or not _is_short(expr) or not _has_denominator(expr):
        return expr
    return min((expr, sp.cancel(expr)), key=lambda form: form.count_ops())


def solve(matrix: Sequence[FixedRow], right: Sequence[FixedRow]) -> list[Row]:
    """Solve ``matrix * X = right`` exactly, both given as sparse rows; the columns of X as in ``right``.

    Entries are fractions in lowest terms over names, functions and roots. Raises `SingularError` if the
    determinant vanishes, be it by an identity of sines and cosines.

    >>> a, b = sp.symbols("a b")
    >>> solve([{0: a, 1: sp.Integer(1)}, {1: b}], [{}, {0: sp.Integer(1)}])
    [{0: -1/(a*b)}, {0: 1/b}]
    """
    size = len(matrix)
    columns = sorted({column for row in right for column in row})
    place = {column: size + at for at, column in enumerate(columns)}
    entries = [(i, j, entry) for i, row in enumerate(matrix) for j, entry in row.items()]
    entries += [(i, place[j], entry) for i, row in enumerate(right) for j, entry in row.items()]
    if not entries:
        raise SingularError
    names = Generators()
    domain, elements = construct_domain(
        [names.plain(entry) for _, _, entry in entries], field=True, extension=True
    )
    if names.named and not regular_by_residues(matrix):
        raise SingularError
    rows: dict[int, dict[int, Any]] = {}
    for (i, j, _), element in zip(entries, elements, strict=True):
        if element:
            rows.setdefault(i, {})[j] = element
    system = DomainMatrix(rows, (size, size + len(columns)), domain)
    reduced, pivots = system.rref()
    if tuple(pivots) != tuple(range(size)):
        raise SingularError
    result: list[Row] = [{} for _ in range(size)]
    for i, row in reduced.to_sparse().rep.items():
        for j, element in row.items():
            if j >= size:
                result[i][columns[j - size]] = names.back(domain.to_sympy(element))
    return result


def determinant(matrix: Sequence[FixedRow]) -> sp.Expr:
    """The determinant of a square system given as sparse rows.

    >>> a, b = sp.symbols("a b")
    >>> determinant([{0: a, 1: sp.Integer(1)}, {0: sp.Integer(1), 1: b}])
    a*b - 1
    """
    size, names = len(matrix), Generators()
    entries = [names.plain(row.get(j, sp.Integer(0))) for row in matrix for j in range(size)]
    domain, elements = construct_domain(entries, field=True, extension=True)
    rows = [elements[i * size : (i + 1) * size] for i in range(size)]
    return names.back(domain.to_sympy(DomainMatrix(rows, (size, size), domain).det()))


def regular_by_residues(matrix: Sequence[FixedRow]) -> bool:
    """Whether the determinant of a square system is not zero, identities of functions included.

    >>> a = sp.Symbol("a")
    >>> s, c = sp.sin(a), sp.cos(a)
    >>> regular_by_residues([{0: c, 1: sp.Integer(1)}, {0: 1 - s**2, 1: c}])
    False
    """
    value = residues()
    rows = ResidueRows({j: v for j, e in row.items() if (v := value(e))} for row in matrix)
    return all(rows.pivot(column, jordan=False) for column in range(len(matrix)))


def combined(parts: Iterable[tuple[FixedRow, sp.Expr]]) -> Row:
    """The sum of multiples of sparse rows, each entry cancelled once, however many terms it has.

    >>> a, b = sp.symbols("a b")
    >>> combined([({0: a}, sp.Integer(1)), ({0: b, 1: b}, sp.Integer(2)), ({0: a}, sp.Integer(-1))])
    {0: 2*b, 1: 2*b}
    """
    terms: dict[int, list[sp.Expr]] = {}
    for row, factor in parts:
        for column, entry in row.items():
            terms.setdefault(column, []).append(factor * entry)
    result: Row = {}
    for column, found in terms.items():
        total = found[0] if len(found) == 1 else cancelled(sp.Add(*found))
        if len(found) == 1 or not total.is_zero:
            result[column] = total
    return result


def _has_denominator(expr: sp.Expr) -> bool:
    """Whether anything but a number stands below a fraction line: else there is nothing to cancel."""
    return any(
        part.exp.could_extract_minus_sign() and part.base.free_symbols
        for part in expr.atoms(sp.Pow)
    )


def _is_short(expr: sp.Expr) -> bool:
    """Whether an expression, multiplied out as well, is short enough to look for a better form."""
    return expr.count_ops() <= SHORT_OPERATIONS and expanded_terms(expr) <= SHORT_TERMS


def rows_of(matrix: sp.Matrix) -> list[Row]:
    """The sparse rows of a sympy matrix."""
    result: list[Row] = [{} for _ in range(matrix.rows)]
    for (i, j), entry in matrix.todok().items():
        result[i][j] = entry
    return result


def matrix_of(rows: Sequence[FixedRow], columns: int) -> sp.ImmutableSparseMatrix:
    """The immutable sparse sympy matrix of sparse rows."""
    entries = {(i, j): entry for i, row in enumerate(rows) for j, entry in sorted(row.items())}
    return sp.ImmutableSparseMatrix(len(rows), columns, entries)

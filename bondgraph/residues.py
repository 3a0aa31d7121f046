"""Expressions as residues modulo a large prime: exact structure decisions at the price of integer arithmetic.

Every symbol stands for a random residue, the same in all places. A residue that is not zero proves
that the expression is not zero; a zero is wrong with a probability of about degree/2**61.
"""

import random
from collections.abc import Callable, Iterable

import sympy as sp

PRIME = 2**61 - 1

Row = dict[int, int]
"""A sparse row of residues: column to entry, no zeros."""


def residues(seed: int = 0) -> Callable[[sp.Expr], int]:
    """A function from expressions to residues; equal seeds give equal functions.

    What is not built from numbers, symbols, sums, products and integer powers counts as a symbol of
    its own. Raises `ZeroDivisionError` where a denominator vanishes.

    >>> value = residues()
    >>> h = sp.Symbol("h")
    >>> value(h/(h - 1) - 1/(h - 1)), value(h - 2) == 0
    (1, False)
    """
    known: dict[sp.Expr, int] = {}

    def value(expr: sp.Expr) -> int:
        if expr.is_Rational:
            return int(expr.p) * _inverse(int(expr.q)) % PRIME
        if expr.is_Add:
            return sum(value(part) for part in expr.args) % PRIME
        if expr.is_Mul:
            product = 1
            for part in expr.args:
                product = product * value(part) % PRIME
            return product
        if expr.is_Pow and expr.exp.is_Integer:
            exponent = int(expr.exp)
            base = value(expr.base)
            return pow(_inverse(base) if exponent < 0 else base, abs(exponent), PRIME)
        if expr not in known:
            known[expr] = random.Random(f"{seed} {sp.srepr(expr)}").randrange(1, PRIME)
        return known[expr]

    return value


def _inverse(residue: int) -> int:
    if residue % PRIME == 0:
        raise ZeroDivisionError("a denominator vanishes")
    return pow(residue, -1, PRIME)


def is_zero(expr: sp.Expr) -> bool:
    """Whether an expression vanishes identically, without expanding it unless it seems to.

    >>> a, b = sp.symbols("a b")
    >>> is_zero((a + b)**2 - a**2 - 2*a*b - b**2), is_zero(sp.sin(a)**2 + sp.cos(a)**2 - 1)
    (True, True)
    """
    if expr.is_Rational:
        return bool(expr.p == 0)
    if expr.is_Symbol:
        return False
    if not is_rational_function(expr):
        return bool(expr.equals(0))
    try:
        return residues()(expr) == 0 and residues(1)(expr) == 0
    except ZeroDivisionError:
        return False


def is_rational_function(expr: sp.Expr) -> bool:
    """Whether only numbers, symbols, sums, products and integer powers occur."""
    if expr.is_Rational or expr.is_Symbol:
        return True
    if expr.is_Pow:
        return bool(expr.exp.is_Integer) and is_rational_function(expr.base)
    return bool(expr.is_Add or expr.is_Mul) and all(map(is_rational_function, expr.args))


class ResidueRows:
    """Sparse rows modulo the prime, eliminated column by column."""

    def __init__(self, rows: Iterable[Row]) -> None:
        self.rows = list(rows)
        self.columns: dict[int, set[int]] = {}
        self.pivots: dict[int, int] = {}
        for at, row in enumerate(self.rows):
            for column in row:
                self.columns.setdefault(column, set()).add(at)

    def pivot(self, column: int, jordan: bool = True) -> bool:
        """Eliminate a column with its shortest free row; False if it depends on earlier ones.

        With ``jordan`` the column also leaves the rows of earlier pivots; without, the pivot's row
        is done with and forgotten.
        """
        free = [at for at in self.columns.get(column, ()) if at not in self.pivots]
        if not free:
            return False
        best = min(free, key=lambda at: (len(self.rows[at]), at))
        scale = pow(self.rows[best][column], -1, PRIME)
        for at in list(self.columns[column] - {best}):
            self._subtract(at, best, self.rows[at][column] * scale % PRIME)
        if jordan:
            self.pivots[best] = column
        else:
            for other in self.rows[best]:
                self.columns[other].discard(best)
            self.rows[best] = {}
        return True

    def pivots_meeting(self, column: int) -> list[int]:
        """The pivot columns whose rows hold this column."""
        return [self.pivots[at] for at in self.columns.get(column, ()) if at in self.pivots]

    def _subtract(self, at: int, source: int, factor: int) -> None:
        row = self.rows[at]
        for column, entry in self.rows[source].items():
            left = (row.get(column, 0) - factor * entry) % PRIME
            if left:
                row[column] = left
                self.columns.setdefault(column, set()).add(at)
            elif column in row:
                del row[column]
                self.columns[column].discard(at)

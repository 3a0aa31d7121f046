"""Entries in the form in which a person would write them."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import sympy as sp

from bondgraph.algebra.exact import FixedRow, matrix_of
from bondgraph.algebra.expressions import expanded_terms
from bondgraph.algebra.factored import factored
from bondgraph.algebra.residues import is_rational_function, is_zero

MOST_OPERATIONS = 100
MOST_TERMS = 300
MOST_SYMBOLS = 20
"""An entry with more operations, symbols, or terms when multiplied out, is left as it came."""

LARGEST_TIDIED = 2_000
"""Matrices with more entries in all are left as they were derived."""

KEPT = 4_096
"""Entries whose forms are remembered: matrices repeat them, and so do graphs that are derived again."""


def tidy_matrices(
    parts: Sequence[tuple[Sequence[FixedRow], int]],
) -> list[sp.ImmutableSparseMatrix]:
    """Immutable matrices from rows and widths, entries in their shortest form while there are few."""
    count = sum(len(row) for rows, _ in parts for row in rows)
    if count <= LARGEST_TIDIED:
        parts = [
            ([{j: tidy(entry) for j, entry in row.items()} for row in rows], width)
            for rows, width in parts
        ]
    return [matrix_of(rows, width) for rows, width in parts]


@lru_cache(maxsize=KEPT)
def tidy(expr: sp.Expr) -> sp.Expr:
    """The shortest of an expression's plain, cancelled, factored and by-symbol forms.

    Sines and cosines of one angle are known to belong together. Long expressions, and those with roots
    or other functions, stay as they are.

    >>> J, m, l, theta = sp.symbols("J m l theta")
    >>> tidy(J + m*l**2*sp.sin(theta)**2 + m*l**2*sp.cos(theta)**2)
    J + l**2*m
    """
    if expr.is_Atom or expr.count_ops() > MOST_OPERATIONS or expanded_terms(expr) > MOST_TERMS:
        return expr
    if len(expr.free_symbols) > MOST_SYMBOLS:
        return expr
    turning = sorted(expr.atoms(sp.sin, sp.cos), key=str)
    # Sines and cosines count as symbols that know their squares' sum.
    named = {part: sp.Dummy(str(part)) for part in turning}
    plain = expr.xreplace(named)
    if not is_rational_function(plain):
        return expr
    if is_zero(expr):
        return sp.Integer(0)
    found = _forms(plain)
    for sine, cosine in _pairs(named):
        found += _forms(_without_square(plain, sine, cosine))
        found += _forms(_without_square(plain, cosine, sine))
    back = {dummy: part for part, dummy in named.items()}
    forms = [form.xreplace(back) for form in found]
    least = min(form.count_ops() for form in forms)
    shortest = dict.fromkeys(form for form in forms if form.count_ops() == least)
    return min(shortest, key=lambda form: len(str(form)))


def _forms(expr: sp.Expr) -> list[sp.Expr]:
    return [expr, sp.cancel(expr), factored(expr), by_linear_symbols(expr)]


def _pairs(named: Mapping[sp.Expr, sp.Dummy]) -> list[tuple[sp.Dummy, sp.Dummy]]:
    """The sine and the cosine of each angle that has both."""
    return [
        (dummy, named[sp.cos(*part.args)])
        for part, dummy in named.items()
        if isinstance(part, sp.sin) and sp.cos(*part.args) in named
    ]


def _without_square(expr: sp.Expr, one: sp.Dummy, other: sp.Dummy) -> sp.Expr:
    """The expression with ``one^2 = 1 - other^2`` wherever it holds a higher power of one."""
    over, under = (
        sp.rem(part, one**2 + other**2 - 1, one) for part in sp.fraction(sp.together(expr))
    )
    return over / under


def by_linear_symbols(expr: sp.Expr) -> sp.Expr:
    """The sum over the symbols in which an expression is linear, each with its coefficient factored.

    So inertias stand beside one another, each with the square of its gear ratio.

    >>> n, I_1, I_2 = sp.symbols("n I_1 I_2")
    >>> by_linear_symbols((n**2*I_1 + 2*n*I_1 + I_1 + n*I_2)/n)
    I_1*(n + 1)**2/n + I_2
    """
    over, under = sp.fraction(sp.together(expr))
    names = sorted(over.free_symbols, key=str)
    if not names:
        return expr
    terms = sp.Poly(over, *names).terms()
    linear: list[int] = []
    for at, name in enumerate(names):
        if name not in under.free_symbols and all(
            powers[at] <= 1 and not (powers[at] and any(powers[k] for k in linear))
            for powers, _ in terms
        ):
            linear.append(at)
    parts: dict[int | None, list[sp.Expr]] = {}
    for powers, number in terms:
        own = next((at for at in linear if powers[at]), None)
        factors = [name ** powers[at] for at, name in enumerate(names) if at != own]
        parts.setdefault(own, []).append(number * sp.prod(factors))
    return sp.Add(*(
        (1 if own is None else names[own]) * factored(sp.Add(*found) / under)
        for own, found in parts.items()
    ))  # fmt: skip

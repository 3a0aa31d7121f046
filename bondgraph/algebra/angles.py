"""Products of sines and cosines that are the sine or the cosine of a sum or a difference of angles."""

from collections.abc import Iterator
from functools import lru_cache

import sympy as sp

KEPT = 1_024
"""Expressions whose forms are remembered."""


@lru_cache(maxsize=KEPT)
def joined(expr: sp.Expr) -> sp.Expr:
    """The expression with ``cos a cos b + sin a sin b = cos(a - b)`` and its like put together.

    Looked for among the terms of each sum as it stands; nothing is multiplied out.

    >>> a, b, m = sp.symbols("a b m")
    >>> joined(m*(sp.sin(a)*sp.sin(b) + sp.cos(a)*sp.cos(b)))
    m*cos(a - b)
    >>> joined(sp.sin(a)*sp.cos(b) - sp.sin(b)*sp.cos(a) + m)
    m + sin(a - b)
    """
    if not expr.args or not expr.has(sp.sin) or not expr.has(sp.cos):
        return expr
    expr = expr.func(*map(joined, expr.args))
    if not expr.is_Add:
        return expr
    terms = list(expr.args)
    while (found := next(_couples(terms), None)) is not None:
        first, second, one = found
        terms = [term for at, term in enumerate(terms) if at not in (first, second)] + [one]
    return sp.Add(*terms)


def _couples(terms: list[sp.Expr]) -> Iterator[tuple[int, int, sp.Expr]]:
    """Two terms that are one, and which."""
    turned: dict[sp.Expr, int] = {}
    for at, term in enumerate(terms):
        for first, second, rest in _products(term):
            sign, other = _partner(first, second)
            for factor in (1, -1):
                place = turned.get(factor * rest * other)
                if place is not None:
                    yield place, at, rest * _one(first, second, factor * sign)
        turned[term] = at


def _products(term: sp.Expr) -> Iterator[tuple[sp.Expr, sp.Expr, sp.Expr]]:
    """Each product of two sines or cosines of different angles in a term, and what is beside it."""
    if not term.is_Mul:
        return
    round_ = [part for part in term.args if isinstance(part, sp.sin | sp.cos)]
    for at, first in enumerate(round_):
        for second in round_[:at]:
            if first.args != second.args:
                # The sine first, where there is one of each.
                pair = (first, second) if isinstance(first, sp.sin) else (second, first)
                yield *pair, term / (first * second)


def _partner(first: sp.Expr, second: sp.Expr) -> tuple[int, sp.Expr]:
    """The product that goes with a product, and the sign with which their sum is that of a difference."""
    (a,), (b,) = first.args, second.args
    if isinstance(first, sp.sin) and isinstance(second, sp.cos):
        return -1, sp.sin(b) * sp.cos(a)
    if isinstance(first, sp.sin):
        return 1, sp.cos(a) * sp.cos(b)
    return 1, sp.sin(a) * sp.sin(b)


def _one(first: sp.Expr, second: sp.Expr, difference: int) -> sp.Expr:
    """What two such products are together: of the difference of their angles, or of the sum."""
    (a,), (b,) = first.args, second.args
    angle = a - b if difference > 0 else a + b
    if isinstance(first, sp.sin) and isinstance(second, sp.cos):
        return sp.sin(angle)
    whole = sp.cos(angle)
    return -whole if isinstance(first, sp.sin) and difference < 0 else whole

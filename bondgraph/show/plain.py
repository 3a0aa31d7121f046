"""Expressions as one line of text, as a person would write them."""

import decimal
from collections.abc import Mapping
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.str import StrPrinter

from bondgraph.algebra.called import unguarded
from bondgraph.algebra.expressions import TIME

LATE = sp.Symbol("\U0010ffff")
"""The time, by a name that comes after all others: ``w*t``, not ``t*w``."""

LONG = 1000
"""Fractions with denominators from here on are read more easily as decimals."""


def plain(expr: sp.Expr) -> str:
    """An expression as text: powers with ``^``, magnitudes between bars, pieces with their conditions.

    Numbers that were told as decimals are shown so.

    >>> x = sp.Symbol("x")
    >>> plain(x**2/4), plain(sp.Rational("0.12345")*x), plain(3*x*sp.Abs(x))
    ('x^2/4', '0.12345*x', '3*x*|x|')
    >>> plain(sp.Piecewise((2*x, x < 0), (x, x < 1), (0, True)))
    '{2*x if x < 0, x if x < 1, else 0}'
    >>> plain(-x + sp.Symbol("x_0")), plain(sp.sin(sp.Symbol("w")*sp.Symbol("t")))
    ('x_0 - x', 'sin(w*t)')
    """
    return one_line(decimals(expr)).replace("**", "^")


def one_line(expr: sp.Expr) -> str:
    """The same with powers, and with numbers, as sympy writes them.

    >>> one_line(sp.Symbol("x")**2/1024)
    'x**2/1024'
    """
    return str(_Plain().doprint(_ready(expr))).replace(LATE.name, TIME.name)


def typed(expr: Any, names: Mapping[sp.Symbol, str]) -> str:
    r"""An expression or a matrix as LaTeX, symbols by these names.

    >>> x, y = sp.symbols("x y")
    >>> typed(y - x, {x: r"\dot{x}"})
    'y - \\dot{x}'
    """
    told = {**names, LATE: names.get(TIME, TIME.name)}
    return str(_Typed({"symbol_names": told}).doprint(_ready(decimals(expr))))


def _ready(expr: Any) -> Any:
    return unguarded(expr).xreplace({TIME: LATE})


class _PositiveFirst:
    """Sums that would begin with a minus sign begin with what has none, if anything has."""

    def _as_ordered_terms(self, expr: sp.Expr, order: Any = None) -> list[sp.Expr]:
        terms: list[sp.Expr] = super()._as_ordered_terms(expr, order=order)  # type: ignore[misc]
        signs = [term.could_extract_minus_sign() for term in terms]
        if not signs[0] or all(signs):
            return terms
        return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


class _Typed(_PositiveFirst, LatexPrinter):  # type: ignore[misc]
    pass


class _Plain(_PositiveFirst, StrPrinter):  # type: ignore[misc]
    def _print_Abs(self, expr: sp.Abs) -> str:
        return f"|{self._print(expr.args[0])}|"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        pieces: list[str] = []
        for value, held in expr.args:
            told = self._print(value)
            last = f"else {told}" if pieces else told
            pieces.append(last if held == sp.true else f"{told} if {self._print(held)}")
        return f"{{{', '.join(pieces)}}}"


def decimals(expr: Any) -> Any:
    """With exact decimals for fractions of long denominators that have them."""
    fractions = {one for one in expr.atoms(sp.Rational) if one.q >= LONG and _is_decimal(one.q)}
    told = {
        one: sp.Symbol(_digits(one)) if one > 0 else -sp.Symbol(_digits(-one)) for one in fractions
    }
    return expr.xreplace(told) if told else expr


def _is_decimal(number: int) -> bool:
    for factor in (2, 5):
        while number % factor == 0:
            number //= factor
    return number == 1


def _digits(value: sp.Rational) -> str:
    """All its digits, by a power of ten where they would begin far off."""
    with decimal.localcontext(prec=400):
        told = (decimal.Decimal(value.p) / decimal.Decimal(value.q)).normalize()
    return str(told)

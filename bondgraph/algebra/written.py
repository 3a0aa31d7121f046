"""Expressions as the text that reads back as them."""

from typing import Any

import sympy as sp
from sympy.printing.str import StrPrinter

_NAMED = {
    sp.Eq: "==", sp.Ne: "!=", sp.Lt: "<", sp.Le: "<=", sp.Gt: ">", sp.Ge: ">=",
}  # fmt: skip


def written(expr: sp.Expr) -> str:
    """The text of an exact expression, in the syntax that `expression` reads; terms in alphabetical order.

    >>> x, y = sp.symbols("x y")
    >>> written(sp.pi * sp.Piecewise((x, (x > 1) & ~sp.Eq(y, 0)), (sp.E, True)))
    'pi*Piecewise((x, (x > 1) and (y != 0)), (exp(1), True))'
    """
    return str(_Text({"order": "lex"}).doprint(expr))


class _Text(StrPrinter):  # type: ignore[misc]
    """sympy's own text, but for what it spells otherwise."""

    def _print_Exp1(self, expr: Any) -> str:
        return "exp(1)"

    def _print_Relational(self, expr: Any) -> str:
        return f"{self._print(expr.lhs)} {_NAMED[expr.func]} {self._print(expr.rhs)}"

    def _print_And(self, expr: Any) -> str:
        return self._joined(expr, " and ")

    def _print_Or(self, expr: Any) -> str:
        return self._joined(expr, " or ")

    def _print_Not(self, expr: Any) -> str:
        return f"not ({self._print(expr.args[0])})"

    def _joined(self, expr: Any, by: str) -> str:
        return by.join(
            f"({self._print(one)})" for one in sorted(expr.args, key=sp.default_sort_key)
        )

"""Expressions and blocks of a program as text in C or Python, one assignment a line."""

from collections.abc import Mapping

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.pycode import PythonCodePrinter


class _C(C99CodePrinter):  # type: ignore[misc]
    """C99 with doubles only: no integer division, no pow where a product is shorter."""

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return str(expr.name)

    def _print_Pow(self, expr: sp.Pow) -> str:
        if expr.exp.is_Integer and 2 <= abs(int(expr.exp)) <= 4 and expr.base.is_Symbol:
            product = "*".join([self._print(expr.base)] * abs(int(expr.exp)))
            return f"({product})" if expr.exp > 0 else f"1.0/({product})"
        return str(super()._print_Pow(expr))


class _Python(PythonCodePrinter):  # type: ignore[misc]
    """Python over floats and ``math``."""

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return str(expr.name)

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{expr.p}/{expr.q}"

    def _print_sign(self, expr: sp.Expr) -> str:
        inside = self._print(expr.args[0])
        return f"(({inside} > 0) - ({inside} < 0))"


PRINTERS: Mapping[str, type] = {"c": _C, "python": _Python}


def printed(expr: sp.Expr, language: str, names: Mapping[str, str]) -> str:
    """An expression as text, its symbols under the names given.

    >>> x = sp.Symbol("double")
    >>> printed(sp.sin(x)/3 + x**2, "c", {"double": "double_"})
    '(double_*double_) + (1.0/3.0)*sin(double_)'
    >>> printed(sp.sin(x)/3 + x**2, "python", {"double": "double"})
    'double**2 + (1/3)*math.sin(double)'
    """
    put = {
        name: sp.Symbol(names[name.name])
        for name in expr.free_symbols
        if names.get(name.name, name.name) != name.name
    }
    text: str = PRINTERS[language]().doprint(expr.xreplace(put))
    return text

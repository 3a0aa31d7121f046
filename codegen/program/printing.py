"""Expressions and blocks of a program as text in C or Python, one assignment a line."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.codeprinter import PrintMethodNotImplementedError
from sympy.printing.pycode import PythonCodePrinter

from bondgraph.algebra.lookups import INTEGRAL, Handle
from bondgraph.tables.looking import FREE
from bondgraph.tables.record import Sampled
from codegen.program.identifiers import identifiers


class _C(C99CodePrinter):  # type: ignore[misc]
    """C99 with doubles only: no integer division, no macros that strict C99 lacks, products for powers."""

    def __init__(self) -> None:
        super().__init__({"math_macros": {}})

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return str(expr.name)

    def _print_Pow(self, expr: sp.Pow) -> str:
        if expr.exp.is_Integer and 2 <= abs(int(expr.exp)) <= 4 and expr.base.is_Symbol:
            product = "*".join([self._print(expr.base)] * abs(int(expr.exp)))
            return f"({product})" if expr.exp > 0 else f"1.0/({product})"
        return str(super()._print_Pow(expr))

    def _print_Integer(self, expr: sp.Integer) -> str:
        return _double(expr)

    def _print_Rational(self, expr: sp.Rational) -> str:
        if max(abs(expr.p), expr.q) < 2**53:
            return f"{expr.p}.0/{expr.q}.0"
        return _double(expr)

    def _print_Float(self, expr: sp.Float) -> str:
        return _double(expr)

    def _print_NumberSymbol(self, expr: sp.NumberSymbol) -> str:
        return _double(expr)

    _print_Pi = _print_Exp1 = _print_NumberSymbol

    def _print_sign(self, expr: sp.Expr) -> str:
        inside = self._print(expr.args[0])
        return f"((double)((({inside}) > 0) - (({inside}) < 0)))"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        """Conditions in turn; not a number where none holds."""
        text = "NAN"
        for value, condition in reversed(expr.args):
            chosen = self._print(value)
            plain = condition == sp.true
            text = chosen if plain else f"({self._print(condition)}) ? {chosen} : {text}"
            text = f"({text})"
        return text

    def _print_Branch(self, expr: sp.Expr) -> str:
        side, above, below = map(self._print, expr.args)
        return f"(({side} > 0) ? ({above}) : ({below}))"

    def _print_Look(self, expr: Any) -> str:
        handle, *places = expr.args
        return self._looked_up(handle, places, [sp.Integer(FREE)] * len(places))

    def _print_Guard(self, expr: Any) -> str:
        return self._print_Look(expr)

    def _print_LookOn(self, expr: Any) -> str:
        handle, *told = expr.args
        count = len(handle.orders)
        return self._looked_up(handle, told[:count], told[count:])

    def _looked_up(self, handle: Handle, places: Sequence[Any], regions: Sequence[Any]) -> str:
        if handle.orders == INTEGRAL:
            raise PrintMethodNotImplementedError(f"the integral of table {handle.table.name!r}")
        call = "bg_interpolate" if len(places) == 1 else "bg_interpolate_over"
        given = [*map(str, handle.orders), *map(self._print, (*places, *regions))]
        return f"{call}({table_place(handle)}, {', '.join(given)})"

    def _print_Inverse(self, expr: Any) -> str:
        begin, value, *given = map(self._print, (sp.sympify(expr.begin), *expr.places))
        told = ", ".join(given or ["0.0"])
        return f"bg_searched(bg_{expr.turning.code}, {begin}, {value}, (const double[]){{{told}}})"

    def _print_Edge(self, expr: Any) -> str:
        handle, axis, bit, x, *region = expr.args
        given = ", ".join(map(self._print, (x, *(region or [sp.Integer(FREE)]))))
        return f"bg_edge({table_place(handle)}, {int(axis)}, {int(bit)}, {given})"

    _print_EdgeOn = _print_Edge

    def _print_And(self, expr: sp.And) -> str:
        return " && ".join(f"({self._print(part)})" for part in expr.args)

    def _print_Or(self, expr: sp.Or) -> str:
        return " || ".join(f"({self._print(part)})" for part in expr.args)

    def _print_Not(self, expr: sp.Not) -> str:
        return f"!({self._print(expr.args[0])})"

    def _print_BooleanTrue(self, expr: sp.Expr) -> str:
        return "1"

    def _print_BooleanFalse(self, expr: sp.Expr) -> str:
        return "0"


def table_place(handle: Handle) -> str:
    """Where a table is among those of an instant ``v``."""
    return f"v->tables + bg_{table_name(handle.table)}"


class _CheckedC(_C):
    """C that calls bg_min, bg_max and bg_sign, which give no number where an argument is none."""

    def _print_Min(self, expr: sp.Min) -> str:
        return self._nested("bg_min", expr.args)

    def _print_Max(self, expr: sp.Max) -> str:
        return self._nested("bg_max", expr.args)

    def _nested(self, call: str, parts: Sequence[sp.Expr]) -> str:
        text = str(self._print(parts[0]))
        for part in parts[1:]:
            text = f"{call}({text}, {self._print(part)})"
        return text

    def _print_sign(self, expr: sp.Expr) -> str:
        return f"bg_sign({self._print(expr.args[0])})"


class _Lanes(_CheckedC):
    """The same C of functions that have no branch, as far as there are some."""

    def _called(self, expr: sp.Expr) -> str:
        return f"bg_lane_{type(expr).__name__}({self._print(expr.args[0])})"

    _print_atan = _print_sin = _print_cos = _print_exp = _print_log = _print_tanh = _called


def _double(expr: sp.Expr) -> str:
    """A number as the nearest double, in digits that give it back."""
    value = float(expr)
    return repr(value) if math.isfinite(value) else "HUGE_VAL"


class _Python(PythonCodePrinter):  # type: ignore[misc]
    """Python over floats, ``math`` and ``log_of``, which is infinite at zero."""

    def _print_log(self, expr: sp.Expr) -> str:
        return f"log_of({self._print(expr.args[0])})"

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return str(expr.name)

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{expr.p}/{expr.q}"

    def _print_sign(self, expr: sp.Expr) -> str:
        inside = self._print(expr.args[0])
        return f"(({inside} > 0) - ({inside} < 0))"

    def _print_Look(self, expr: Any) -> str:
        handle, *places = expr.args
        given = ", ".join(map(self._print, places))
        look = "looked_back" if handle.table.turned else "looked_up"
        return f"{look}(tables[{handle.table.name!r}], {handle.orders}, ({given},))"

    def _print_Guard(self, expr: Any) -> str:
        return self._print_Look(expr)

    def _print_Inverse(self, expr: Any) -> str:
        return str(expr._numpycode(self))


def table_name(table: Sampled) -> str:
    """What a table is called in generated code, after a beginning that nothing else has there.

    >>> table_name(Sampled("map", ((0.0, 1.0),), (0.0, 1.0), "linear", "hold"))
    'table_map'
    """
    plain = identifiers([f"table_{table.name}"], "c")[f"table_{table.name}"]
    return plain if table.name.isascii() else f"{plain}_{table.digest}"


class _Floats(_Python):
    """Python over floats that never becomes complex; what is no number stays so, or is an error."""

    def _looked(self, expr: Any) -> str:
        return str(expr._numpycode(self))

    _print_Look = _print_Guard = _print_LookOn = _print_Edge = _print_EdgeOn = _looked

    def _print_log(self, expr: sp.Expr) -> str:
        return f"math.log({self._print(expr.args[0])})"

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base, exponent = expr.args
        if exponent.is_Integer and 2 <= exponent <= 4 and base.is_Symbol:
            return "(" + "*".join([self._print(base)] * int(exponent)) + ")"
        if exponent.is_Integer or exponent in (sp.S.Half, -sp.S.Half):
            return str(super()._print_Pow(expr, rational=rational))
        return f"math.pow({self._print(base)}, {self._print(exponent)})"

    def _print_sign(self, expr: sp.Expr) -> str:
        inside = self._print(expr.args[0])
        return f"({super()._print_sign(expr)} + 0.0*({inside}))"

    def _print_Min(self, expr: sp.Min) -> str:
        return f"least({', '.join(map(self._print, expr.args))})"

    def _print_Max(self, expr: sp.Max) -> str:
        return f"most({', '.join(map(self._print, expr.args))})"


PRINTERS: Mapping[str, type] = {
    "c": _C, "checked_c": _CheckedC, "lanes": _Lanes, "python": _Python, "floats": _Floats,
}  # fmt: skip


def printed(expr: sp.Expr, language: str, names: Mapping[str, str]) -> str:
    """An expression as text, its symbols under the names given.

    ``language``: "c", "python", or "checked_c", where ``bg_min``, ``bg_max`` and ``bg_sign`` are called;
    "lanes", which calls functions of several runs at once; or
    "floats", Python that calls ``least`` and ``most``, in which nothing that is no number is lost.

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

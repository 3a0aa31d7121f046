"""How finely known sources of a unit have to be looked at: where importers choose the steps, and in its own.

Generated C tells whether a stretch of time is short beside what sources do: the argument of no sine or
exponential changes by much in it, by ranges over the whole stretch, at whatever numbers parameters have.
"""

from collections.abc import Callable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from codegen.c.blocks import names_for, places, text_of
from codegen.c.text import statement
from codegen.numbers.cells import cells
from codegen.program.printing import table_name
from codegen.program.records import Program

TURNING = (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc, sp.sinh, sp.cosh, sp.atan, sp.asin, sp.acos,
           sp.asinh, sp.floor, sp.ceiling, sp.frac)  # fmt: skip
"""Functions that do much where their argument changes by one."""

GENTLE = (sp.sin, sp.cos, sp.tanh, sp.atan, sp.asinh, sp.Abs)
"""Functions whose slope is one at most."""


def resolution_text(program: Program, sources: Sequence[sp.Expr]) -> list[str]:
    """``fmu_resolved``: whether these expressions of time and parameters do little from t to t + h."""
    writer = _Writer(program)
    for expr in sources:
        writer.range_of(expr)
    return [
        "",
        "/* Whether known sources do little from t to t + h. */",
        "int fmu_resolved(const bg_values *v, double t, double h)",
        "{",
        "    const fmu_range time = {t + 0.5 * h, 0.5 * h};",
        "    int fine = 1;",
        "    (void)v, (void)time;",
        *writer.lines,
        "    return fine;",
        "}",
    ]


class _Writer:
    """The lines of the function; each part of the sources once."""

    def __init__(self, program: Program) -> None:
        self.lines: list[str] = []
        self._places, self._known = places(program), dict[sp.Expr, str]()

    def range_of(self, expr: sp.Expr) -> str:
        """The name of a part's range, which is written if it was not yet."""
        if expr == TIME:
            return "time"
        if expr not in self._known:
            text = self._text(expr)
            self._known[expr] = f"r{len(self._known)}"
            self.lines += statement(f"const fmu_range {self._known[expr]} = {text};")
            self.lines.append(f"    (void){self._known[expr]};")
        return self._known[expr]

    def _text(self, expr: sp.Expr) -> str:
        if TIME not in expr.free_symbols:
            return f"fmu_level({self._constant(expr)})"
        if isinstance(expr, sp.Add | sp.Mul):
            join = "fmu_sum" if isinstance(expr, sp.Add) else "fmu_product"
            text = self.range_of(expr.args[0])
            for argument in expr.args[1:]:
                text = f"{join}({text}, {self.range_of(argument)})"
            return text
        if isinstance(expr, sp.Pow):
            return self._power(expr)
        parts = [self.range_of(part) for part in _values(expr)]
        self._check(expr, parts)
        return self._function(expr, parts)

    def _power(self, expr: sp.Pow) -> str:
        if TIME in expr.exp.free_symbols:
            return self._text(sp.exp(expr.exp * sp.log(expr.base), evaluate=False))
        base, power = self.range_of(expr.base), self._constant(expr.exp)
        if expr.exp.is_Integer and expr.exp > 0:
            return f"fmu_whole_power({base}, {power})"
        self.lines.append(f"    fine &= fmu_keeps_away({base});")
        return f"fmu_power({base}, {power})"

    def _check(self, expr: sp.Expr, parts: Sequence[str]) -> None:
        rule: Callable[[str], str] | None = None
        if isinstance(expr, Look):
            # Corners of tables are events; between them those of degree one do nothing.
            for part, width in zip(
                parts, cells(expr) if expr.handle.table.smooth else (), strict=False
            ):
                of_cell = f"fmu_product({part}, fmu_level({1 / width!r}))"
                self.lines += statement(f"fine &= fmu_turns_little({of_cell});")
        if isinstance(expr, TURNING):
            rule = "fmu_turns_little({})".format
        elif isinstance(expr, sp.exp):
            rule = "fmu_grows_little({})".format
        elif isinstance(expr, sp.tanh | sp.erf | sp.erfc):
            rule = "fmu_saturates({}, 20.0)".format
        elif isinstance(expr, sp.log):
            rule = "fmu_keeps_away({})".format
        elif isinstance(expr, sp.Mod):
            rule = f"fmu_turns_little(fmu_product({{}}, fmu_power({parts[1]}, -1.0)))".format
        if rule:
            self.lines += statement(f"fine &= {rule(parts[0])};")

    def _function(self, expr: sp.Expr, parts: Sequence[str]) -> str:
        if isinstance(expr, sp.exp):
            return f"fmu_exponential({parts[0]})"
        if isinstance(expr, GENTLE):
            middle = self._called(expr.func, parts[0])
            return f"fmu_sloped({middle}, 1.0, {parts[0]})"
        if isinstance(expr, Look) and len(parts) == 1:
            slope = f"v->tables[bg_{table_name(expr.handle.table)}].steepest"
            return f"fmu_sloped({self._looked_up(expr, parts[0])}, {slope}, {parts[0]})"
        # What has corners, and functions that are seldom inside another: the sum of all that they read.
        text = parts[0]
        for part in parts[1:]:
            text = f"fmu_sum({text}, {part})"
        return text

    def _called(self, function: type, part: str) -> str:
        middle = sp.Symbol("middle")
        return text_of(function(middle), {"middle": f"{part}.mid"})

    def _looked_up(self, look: Look, part: str) -> str:
        middle = sp.Symbol("middle")
        return text_of(Look(look.handle, middle), {"middle": f"{part}.mid"})

    def _constant(self, expr: sp.Expr) -> str:
        names: Mapping[str, str] = {name.name: self._places[name] for name in expr.free_symbols}
        return text_of(expr, names or names_for([]))


def _values(expr: sp.Expr) -> list[sp.Expr]:
    """What an expression reads, conditions as the differences that they compare."""
    found: list[sp.Expr] = []
    for argument in expr.places if isinstance(expr, Look) else expr.args:
        if isinstance(argument, sp.core.relational.Relational):
            found.append(argument.lhs - argument.rhs)
        elif isinstance(argument, sp.logic.boolalg.BooleanFunction | sp.Tuple):
            found += _values(argument)
        elif isinstance(argument, sp.Expr):
            found.append(argument)
    return found or [sp.Integer(0)]

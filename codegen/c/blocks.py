"""Blocks of a program as C functions of an instant, with readable local names."""

from collections.abc import Mapping, Sequence
from itertools import takewhile

import sympy as sp
from sympy.printing.codeprinter import PrintMethodNotImplementedError

from bondgraph.errors import ExpressionError
from bondgraph.tables.looking import FREE
from codegen.c.text import comment, statement
from codegen.corners.tabled import Edge
from codegen.program.identifiers import identifiers
from codegen.program.layout import readable
from codegen.program.printing import printed, table_place
from codegen.program.records import Block, Program

_MACROS = """
    M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2
    HUGE MAXFLOAT HUGE_VALF HUGE_VALL SNAN DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS EOF
    FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL FP_FAST_FMA FP_ILOGB0 FP_ILOGBNAN
    MATH_ERRNO MATH_ERREXCEPT math_errhandling isgreater isless islessgreater isunordered i386 vax
"""

TAKEN = frozenset({*_MACROS.split(), "v", "out", "m", "s", "w", "rate", "signs", "time"})
"""Names that the functions use themselves, and macros of the headers they include."""


def names_for(symbols: Sequence[sp.Symbol]) -> Mapping[str, str]:
    """Identifiers for these symbols that nothing in generated code uses."""
    texts = [symbol.name for symbol in symbols]
    own = {text for text in texts if text.lower().startswith(("bg_", "fp_"))}
    return identifiers(texts, "c", TAKEN | own)


def places(program: Program) -> Mapping[sp.Symbol, str]:
    """Where each name's value stands in an instant ``v``; a parameter before an input that it holds."""
    return readable(
        program, lambda _, part, at, name: "v->t" if part == "t" else f"v->{part}[{at}]"
    )


def text_of(expr: sp.Expr, names: Mapping[str, str], language: str = "checked_c") -> str:
    """An expression as C; `ExpressionError` for a function that C does not have."""
    try:
        text = printed(expr, language, names)
    except PrintMethodNotImplementedError:
        text = "Not supported"
    if "Not supported" in text:
        raise ExpressionError(f"{expr} uses a function that C's math library does not have")
    return text


def body(
    code: Block,
    where: Mapping[sp.Symbol, str],
    result: str,
    language: str = "checked_c",
    place: str = "",
) -> list[str]:
    """The lines of a block: its arguments by name, its temporaries, its results, each with a ``place``."""
    names = names_for([*code.arguments, *(name for name, _ in code.assignments)])
    lines = []
    for name in code.arguments:
        lines += statement(f"const double {names[name.name]} = {where[name]};")
    for name, value in code.assignments:
        lines += statement(f"const double {names[name.name]} = {text_of(value, names, language)};")
    at = 0
    while at < len(code.results):
        count = _bits(code.results[at:])
        lines += _edges(code.results[at], count, names, f"{result} + {at}") if count > 1 else statement(
            f"{result}[{at}]{place} = {text_of(code.results[at], names, language)};"
        )  # fmt: skip
        at += count
    return lines


def _bits(results: Sequence[sp.Expr]) -> int:
    """How many of the first are the bits of one argument of a table, in turn, which C finds at once."""
    first = results[0]
    if not isinstance(first, Edge):
        return 1
    same = (type(first), *first.args[:2], *first.args[3:])
    alike = (
        isinstance(one, Edge) and (type(one), *one.args[:2], *one.args[3:]) == same and one.args[2] == bit
        for bit, one in enumerate(results)
    )  # fmt: skip
    return max(1, sum(1 for _ in takewhile(bool, alike)))


def _edges(first: Edge, count: int, names: Mapping[str, str], out: str) -> list[str]:
    """The statement for all of them."""
    handle, axis, _, *told = first.args
    x, region = (text_of(one, names) for one in (*told, sp.Integer(FREE))[:2])
    return statement(f"bg_edges({table_place(handle)}, {axis}, {count}, {x}, {region}, {out});")


def function(
    name: str,
    what: str,
    code: Block,
    where: Mapping[sp.Symbol, str],
    local: bool = True,
    on_sides: Block | None = None,
) -> list[str]:
    """A block as a function that writes its results to ``out``; ``on_sides``: on one side of each corner."""
    if on_sides is not None and on_sides != code:
        beside = function(
            f"{name}_on_sides", f"{what}, on one side of each corner", on_sides, where
        )
        turn = [f"    if (v->sided > 0) {{ {name}_on_sides(v, out); return; }}"]
    else:
        beside, turn = [], []
    count = code.operations
    counted = f"{count} operation{'s' if count != 1 else ''}"
    unused = [
        *([] if code.arguments or turn else ["    (void)v;"]),
        *([] if code.results else ["    (void)out;"]),
    ]
    return [
        *beside,
        "",
        *comment(f"{what}: {counted}."),
        f"{'static ' if local else ''}void {name}(const bg_values *v, double *out)",
        "{",
        *turn,
        *body(code, where, "out"),
        *unused,
        "}",
    ]

"""Tables that are looked into, as C: how a model is generated, and where they may be left."""

from collections.abc import Mapping, Sequence

from bondgraph.inverses.tabled import fixed
from bondgraph.tables.pieces import pieces
from bondgraph.tables.record import OUTSIDE, Sampled
from codegen.c.blocks import function, places
from codegen.c.text import array, comment, doubles, quoted, strings
from codegen.corners.refusing import arguments, refusals
from codegen.numbers.cells import steepest
from codegen.program.printing import table_name
from codegen.program.records import Program

BEYOND = dict(zip(OUTSIDE, ("BG_TABLE_HOLDS", "BG_TABLE_EXTENDS", "BG_TABLE_REFUSES"), strict=True))


def lookup_sizes(program: Program) -> Mapping[str, int]:
    """How many there are, and what their values, the factors and working these out take."""
    tables = program.tables
    return {
        "TABLES": len(tables),
        "TABLE_VALUES": sum(len(table.values) for table in tables),
        "TABLE_FACTORS": sum(len(pieces(table)[3]) for table in tables),
        "TABLE_WORK": max([0, *map(_work, tables)]),
        "REFUSING": len(refusals(program)),
    }


def _work(table: Sampled) -> int:
    """Numbers that `model_fit.c` works with: slopes along each axis and both, chords, a row."""
    longest = max(map(len, table.axes))
    return 3 * len(table.values) + longest if len(table.axes) == 2 else 2 * longest + 3


def lookup_names(tables: Sequence[Sampled]) -> list[str]:
    """The place of each by its name; nothing where there are none."""
    if not tables:
        return []
    named = [f"#define bg_{table_name(table)} {at}" for at, table in enumerate(tables)]
    return ["", *comment("Tables that are looked into."), *named]


def lookup_tables(tables: Sequence[Sampled]) -> list[str]:
    """``bg_tables``, in the order of their names, and these."""
    lines: list[str] = []
    rows = []
    kept = fixed(tables)
    for table in tables:
        found, row = _lookup_table(table, table.name in kept)
        lines += found
        rows.append(row)
    lines += array("const bg_table bg_tables[]", rows, "{0}")
    return [*lines, *strings("bg_lookup_names", [table.name for table in tables]), ""]


def _lookup_table(table: Sampled, kept: bool) -> tuple[list[str], str]:
    """The constants of a table, and what tells of them."""
    name = table_name(table)
    breaks, degree, outside, factors = pieces(table)
    lines = ["", *comment(f"The table {table.name}, {table.method}.")]
    axes, points = list[str](), list[str]()
    for letter, knots, axis in zip("xy", breaks, table.axes, strict=False):
        axes.append(f"{name}_{letter}")
        lines += doubles(axes[-1], knots, local=True)
        points.append(axes[-1] if knots == axis else f"{name}_points_{letter}")
        lines += [] if knots == axis else doubles(points[-1], axis, local=True)
    lines += doubles(f"{name}_values", table.values, local=True)
    lines += doubles(f"{name}_factors", factors, local=True)
    cells = ", ".join(str(len(knots) - 1) for knots in (*breaks, (0.0, 0.0))[:2])
    counts = ", ".join(str(len(axis)) for axis in (*table.axes, (0.0,))[:2])
    found, given = (", ".join((*one, "0")[:2]) for one in (axes, points))
    steep = steepest(table) if len(axes) == 1 else 0.0
    method = "BG_TABLE_FIXED" if kept else f"BG_TABLE_{table.method.upper()}"
    return lines, (
        f"{{{degree}, {BEYOND[outside]}, {{{cells}}}, {{{found}}}, {name}_factors, {method}, {{{counts}}}, "
        f"{{{given}}}, {name}_values, {steep!r}}}"
    )


def refused(program: Program) -> list[str]:
    """Arguments of tables that refuse what is outside, in the order in which laws are evaluated."""
    rows = [
        f"{{bg_{table_name(one.table)}, {one.axis}, {quoted(str(one.argument))}, "
        f"{quoted(one.never) if one.never else 0}}}"
        for one in refusals(program)
    ]
    what = "Arguments of tables that refuse what is outside"
    return [
        *array("const bg_refusing bg_refusings[]", rows, "{0, 0, 0, 0}"),
        *function("bg_refused", what, arguments(program), places(program), local=False),
    ]

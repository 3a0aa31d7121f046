"""Tables that are looked into, as constants of C."""

from collections.abc import Sequence

from bondgraph.tables.pieces import pieces
from bondgraph.tables.record import OUTSIDE, Sampled
from codegen.c.text import array, comment, doubles
from codegen.program.printing import table_name

BEYOND = dict(zip(OUTSIDE, ("BG_TABLE_HOLDS", "BG_TABLE_EXTENDS", "BG_TABLE_REFUSES"), strict=True))


def lookup_names(tables: Sequence[Sampled]) -> list[str]:
    """A name for each; nothing where there are none."""
    if not tables:
        return []
    named = [f"#define bg_{table_name(table)} bg_tables[{at}]" for at, table in enumerate(tables)]
    return ["", *comment("Tables that are looked into."), *named]


def lookup_tables(tables: Sequence[Sampled]) -> list[str]:
    """``bg_tables``, in the order of their names; nothing where there are none."""
    lines: list[str] = []
    rows = []
    for table in tables:
        name = table_name(table)
        breaks, degree, outside, factors = pieces(table)
        lines += ["", *comment(f"The table {table.name}, {table.method}.")]
        axes = [f"{name}_{letter}" for letter, _ in zip("xy", breaks, strict=False)]
        for axis, knots in zip(axes, breaks, strict=True):
            lines += doubles(axis, knots, local=True)
        lines += doubles(f"{name}_factors", factors, local=True)
        cells = ", ".join(str(len(knots) - 1) for knots in (*breaks, (0.0,))[:2])
        places = ", ".join((*axes, "0")[:2])
        rows.append(f"{{{degree}, {BEYOND[outside]}, {{{cells}}}, {{{places}}}, {name}_factors}}")
    return [*lines, *array("const bg_table bg_tables[]", rows), ""] if tables else []

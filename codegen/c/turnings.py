"""Laws that are turned round by a search, as functions of C."""

from collections.abc import Sequence

import sympy as sp

from bondgraph.inverses.inverse import PLACE, Turning
from codegen.c.text import array, comment, statement
from codegen.program.printing import printed


def turning_names(turnings: Sequence[Turning]) -> list[str]:
    """A name for each; nothing where there are none."""
    if not turnings:
        return []
    named = [f"#define bg_{one.code} bg_turnings[{at}]" for at, one in enumerate(turnings)]
    return ["", *comment("Laws that are turned round."), *named]


def turned_laws(turnings: Sequence[Turning]) -> list[str]:
    """A function for each, and ``bg_turnings``, in the order of their names; nothing where there are none."""
    lines: list[str] = []
    for turning in turnings:
        names = {name.name: f"a[{at}]" for at, name in enumerate(turning.parameters)}
        law, slope, *above = (_text(one, names) for one in turning.evaluated())
        lines += ["", *comment(f"{turning.law} with its slope.")]
        lines += [
            f"static double law_of_{turning.code}(double {PLACE}, const double *a, double *slope)",
            "{",
        ]
        lines += [] if names else ["    (void)a;"]
        if above:
            inside = " && ".join(f"{one} > 0.0" for one in above)
            lines += [*statement(f"if (!({inside}))"), "        return NAN;"]
        lines += [*statement(f"*slope = {slope};"), *statement(f"return {law};"), "}"]
    rows = [f"law_of_{turning.code}" for turning in turnings]
    return [*lines, "", *array("const bg_law bg_turnings[]", rows), ""] if turnings else []


def _text(expr: sp.Expr, names: dict[str, str]) -> str:
    return printed(expr, "c", names)

"""Rates of slipping friction as a C function of their own: straight-line where nothing is solved for."""

import re
from typing import Any

from bondgraph.algebra.expressions import TIME
from codegen.c.blocks import body, function, places
from codegen.c.rhs import Straight
from codegen.c.text import comment, integers
from codegen.program.records import Block, Program

_SIGNATURE = (
    "int bg_model_rhs(bg_model *m, double time, const double *s, const double *w,",
    "                 const double *signs, double *rate)",
    "{",
)


def straight_rates(program: Program, fast: Straight) -> list[str]:
    """The constants of straight-line rates, and the rates."""
    count = len(fast.hoisted)
    used = {name for value in fast.hoisted for name in value.free_symbols}
    hoisted = Block(tuple(n for n in program.parameters if n in used), (), fast.hoisted)
    rows, columns = (tuple(place[at] for place in fast.inverses) for at in (0, 1))
    lines = function("bg_hoisted", "What parameters determine", hoisted, places(program))
    lines += ["", *integers("inverse_rows", rows, local=True)]
    lines += integers("inverse_columns", columns, local=True)
    lines += [
        "", "void bg_prepare_rhs(bg_model *m)", "{",
        "    bg_hoisted(&m->now, m->constants);",
        f"    bg_inverse_entries(m, {len(rows)}, inverse_rows, inverse_columns,"
        f" m->constants + {count});",
        "}", "",
        *comment(f"Rates of slipping friction: {fast.code.operations} operations."),
        *_SIGNATURE,
    ]  # fmt: skip
    found = _rate_places(program, fast)
    # s has room for one where nothing is integrated, and whoever asks reads all of its rate.
    code = body(fast.code, found, "rate") if fast.code.results else ["    rate[0] = 0.0;"]
    used = {re.split(r"\W", found[name])[0] for name in fast.code.arguments}
    names = ("m", "time", "s", "w", "signs")
    unused = [f"    (void){name};" for name in names if name not in used]
    return [*lines, *unused, *code, "    return BG_OK;", "}"]


def _rate_places(program: Program, fast: Straight) -> dict[Any, str]:
    """Where the values that straight-line rates use stand."""
    found = {TIME: "time"}
    for at, name in enumerate((*program.states, *program.law_states)):
        found.setdefault(name, f"s[{at}]")
    for at, name in enumerate(program.external):
        found.setdefault(name, f"w[{at}]")
    found |= {name: f"m->constants[{at}]" for at, name in enumerate(fast.constants)}
    return found | {name: f"signs[{at}]" for at, name in enumerate(fast.signs)}


def plain_rates() -> list[str]:
    """Rates by way of an evaluation, where something has to be solved for."""
    return [
        "", "void bg_prepare_rhs(bg_model *m)", "{", "    (void)m;", "}", "",
        "/* By way of a full evaluation: something has to be solved for, or values change. */",
        *_SIGNATURE,
        "    int mode[BG_ROOM(BG_FRICTION)] = {0}, status;",
        "    for (int i = 0; i < BG_FRICTION; i++)",
        "        mode[i] = signs[i] > 0 ? 1 : -1;",
        "    status = bg_model_evaluate(m, time, s, w, NULL, mode, &m->shot);",
        "    for (int i = 0; i < BG_SIZE; i++)",
        "        rate[i] = m->shot.rate[i];",
        "    return status;",
        "}",
    ]  # fmt: skip

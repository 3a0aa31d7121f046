"""Rates of slipping friction as a C function of their own: straight-line where nothing is solved for."""

import re
from collections.abc import Sequence
from typing import Any

from bondgraph.algebra.expressions import TIME
from codegen.c.blocks import body, function, places
from codegen.c.rhs import Straight
from codegen.c.text import comment, integers
from codegen.program.records import Block, Program

_ARGUMENTS = (
    "bg_model *m, double time, const double *s, const double *w,",
    "                 const double *signs, double *rate)",
    "{",
)

_SIGNATURE = (f"int bg_model_rhs({_ARGUMENTS[0]}", *_ARGUMENTS[1:])

_ON_SIDES = (f"static int rhs_on_sides({_ARGUMENTS[0]}", *_ARGUMENTS[1:])


def straight_rates(program: Program, fast: Sequence[Straight]) -> list[str]:
    """The constants of straight-line rates, and the rates: of laws as they are, and on sides of corners."""
    names = ("", "_on_sides")[: len(fast)]
    lines, prepare, first = list[str](), list[str](), 0
    for name, one in zip(names, fast, strict=True):
        lines += _constants(program, one, name)
        room = f"m->constants + {first}" if first else "m->constants"
        count = first + len(one.hoisted)
        prepare += [
            f"    bg_hoisted{name}(&m->now, {room});",
            f"    bg_inverse_entries(m, {len(one.inverses)}, inverse_rows{name}, inverse_columns{name},"
            f" m->constants + {count});",
        ]
        first += len(one.constants)
    lines += ["", "void bg_prepare_rhs(bg_model *m)", "{", *prepare, "}"]
    what, turn = "Rates of slipping friction", list[str]()
    if len(fast) > 1:
        own, begin = f"{what}, on one side of each corner", len(fast[0].constants)
        lines += _rates(program.on_sides, fast[1], own, _ON_SIDES, begin, [])
        turn = [
            "    if (m->now.sided > 0)",
            "        return rhs_on_sides(m, time, s, w, signs, rate);",
        ]
    return lines + _rates(program, fast[0], what, _SIGNATURE, 0, turn)


def _constants(program: Program, fast: Straight, name: str) -> list[str]:
    """What parameters determine, and which entries of A^-1."""
    used = {name for value in fast.hoisted for name in value.free_symbols}
    hoisted = Block(tuple(n for n in program.parameters if n in used), (), fast.hoisted)
    rows, columns = (tuple(place[at] for place in fast.inverses) for at in (0, 1))
    what = "What parameters determine"
    lines = function(f"bg_hoisted{name}", what, hoisted, places(program))
    lines += ["", *integers(f"inverse_rows{name}", rows, local=True)]
    return lines + integers(f"inverse_columns{name}", columns, local=True)


def _rates(
    program: Program, fast: Straight, what: str, signature: Sequence[str], first: int, turn: list[str]
) -> list[str]:  # fmt: skip
    """The rates themselves; ``first``: the place of their constants."""
    found = _rate_places(program, fast, first)
    # s has room for one where nothing is integrated, and whoever asks reads all of its rate.
    code = body(fast.code, found, "rate") if fast.code.results else ["    rate[0] = 0.0;"]
    looks = any("v->tables" in line for line in code)
    code = ["    const bg_values *const v = &m->now;", *code] if looks else code
    used = {"m"} if looks else set()
    used |= {re.split(r"\W", found[name])[0] for name in fast.code.arguments}
    names = ("m", "time", "s", "w", "signs")
    unused = [f"    (void){name};" for name in names if name not in used and not turn]
    head = ["", *comment(f"{what}: {fast.code.operations} operations."), *signature]
    return [*head, *turn, *unused, *code, "    return BG_OK;", "}"]


def _rate_places(program: Program, fast: Straight, first: int) -> dict[Any, str]:
    """Where the values that straight-line rates use stand."""
    found = {TIME: "time"}
    for at, name in enumerate((*program.states, *program.law_states)):
        found.setdefault(name, f"s[{at}]")
    for at, name in enumerate(program.external):
        found.setdefault(name, f"w[{at}]")
    found |= {name: f"m->now.side[{at}]" for at, name in enumerate(program.sides)}
    found |= {name: f"m->constants[{first + at}]" for at, name in enumerate(fast.constants)}
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

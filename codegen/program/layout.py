"""Where every signal of a program stands: one order for numpy, C, exported text and sweeps."""

from collections.abc import Callable
from typing import TypeVar

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.program.records import Program

Where = TypeVar("Where")


def readable(
    program: Program, where: Callable[[int, str, int, str], Where]
) -> dict[sp.Symbol, Where]:
    """For each name that formulas read where its value stands; a parameter before an input that it holds.

    ``where``: of the place among all (t, x, z, y, u, w, w', parameters), part, place in that, and name.
    """
    parts = {
        "t": (TIME,), "x": program.states, "z": program.law_states, "y": program.readings,
        "u": program.inputs, "w": program.external, "dw": program.external_rates,
        "p": program.parameters,
    }  # fmt: skip
    listed = [(part, at, name) for part, names in parts.items() for at, name in enumerate(names)]
    first = len(listed) - len(program.parameters)
    found: dict[sp.Symbol, Where] = {}
    for k in (*range(first, len(listed)), *range(first)):
        part, at, name = listed[k]
        found.setdefault(name, where(k, part, at, name.name))
    return found


def places(program: Program) -> dict[str, int]:
    """Each signal's place among x, z, u, u' and readings; -1 - j for the external input j."""
    states = len(program.states) + len(program.law_states)
    groups = (
        (program.states, range(states)),
        (program.law_states, range(len(program.states), states)),
        (program.inputs, range(states, states + len(program.inputs))),
        (program.external, range(-1, -1 - len(program.external), -1)),
        (program.readings, range(states + 2 * len(program.inputs), 1 << 20)),
    )
    found: dict[str, int] = {}
    for names, rows in groups:
        for name, row in zip(names, rows, strict=False):
            found.setdefault(name.name, row)
    return found

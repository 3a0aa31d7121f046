"""What stands where at an instant: one order of parts, for numpy, C and exported Python."""

from collections.abc import Callable
from typing import TypeVar

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.program.records import Program

Where = TypeVar("Where")

STATES, LAW_STATES, INPUTS, RATES_OF_INPUTS, READINGS, RATE, CAPS, EXTERNAL = range(8)
"""The parts of an instant: x, z, u, u', y, the rate of s, what ports may hold, external inputs."""

RECORDED = (STATES, LAW_STATES, INPUTS, RATES_OF_INPUTS, READINGS, RATE, EXTERNAL)
"""The parts that are kept of each sample."""

NAMES = ("x", "z", "u", "du", "y", "rate", "caps", "external")
"""What the parts are called in records of numpy and C."""

SHOT = ("x", "u", "slip", "effort", "cap", "push", "rate")
"""What the exact engine knows of an instant: of friction ports slips, efforts, what they may hold, and how
fast slips change; `exact.h` has the same order."""

SIZES = (
    "BG_STATES", "BG_LAW_STATES", "BG_INPUTS", "BG_INPUTS", "BG_READINGS", "BG_SIZE", "BG_FRICTION",
    "BG_EXTERNAL",
)  # fmt: skip
"""How many numbers each part has, as C calls it."""


def layout_text() -> str:
    """The order as C, ``layout.h``: macros that do something with each part in turn."""
    shown = [f"each({NAMES[part]}, {SIZES[part]})" for part in range(EXTERNAL)]
    kept = [
        f"given(w, {SIZES[part]})" if part == EXTERNAL
        else f"shown({NAMES[part]}, {SIZES[part]})" for part in RECORDED
    ]  # fmt: skip
    return "\n".join([
        "/* What stands where at an instant; written by bondgraph-toolkit. */",
        "#ifndef BG_LAYOUT_H", "#define BG_LAYOUT_H", "",
        "/* The parts of a snapshot: states, law states, inputs, their rates, readings, the rate of s,",
        " * what ports may hold. */",
        " \\\n    ".join(["#define BG_PARTS(each)", *shown]), "",
        "/* What is kept of a sample; external inputs, w, are given beside the snapshot. */",
        " \\\n    ".join(["#define BG_RECORDED(shown, given)", *kept]), "", "#endif", "",
    ])  # fmt: skip


def widths(program: Program) -> tuple[int, ...]:
    """How many numbers each part has, in their order; s has one where there are no states."""
    states, own = len(program.states), len(program.law_states)
    inputs, readings = len(program.inputs), len(program.readings)
    return (
        states, own, inputs, inputs, readings, max(states + own, 1), len(program.friction),
        len(program.external),
    )  # fmt: skip


def recorded(program: Program) -> tuple[int, ...]:
    """How many numbers each part has that is kept of a sample."""
    sizes = widths(program)
    return tuple(sizes[part] for part in RECORDED)


def readable(
    program: Program, where: Callable[[int, str, int, str], Where]
) -> dict[sp.Symbol, Where]:
    """For each name that formulas read where its value stands; a parameter before an input that it holds.

    ``where``: of the place among all (t, x, z, y, u, w, w', parameters, sides), part, place in that, name.
    """
    parts = {
        "t": (TIME,), "x": program.states, "z": program.law_states, "y": program.readings,
        "u": program.inputs, "w": program.external, "dw": program.external_rates,
        "p": program.parameters, "side": program.sides,
    }  # fmt: skip
    listed = [(part, at, name) for part, names in parts.items() for at, name in enumerate(names)]
    last = len(listed) - len(program.sides)
    first = last - len(program.parameters)
    found: dict[sp.Symbol, Where] = {}
    for k in (*range(first, last), *range(first), *range(last, len(listed))):
        part, at, name = listed[k]
        found.setdefault(name, where(k, part, at, name.name))
    return found


def places(program: Program) -> dict[str, int]:
    """Each signal's place among x, z, u, u' and readings; -1 - j for the external input j."""
    # What a run is given goes before readings that show the same.
    named = (
        (STATES, program.states), (LAW_STATES, program.law_states), (INPUTS, program.inputs),
        (EXTERNAL, program.external), (READINGS, program.readings),
    )  # fmt: skip
    sizes, found = widths(program), dict[str, int]()
    for part, names in named:
        begin = sum(sizes[:part])
        for at, name in enumerate(names):
            found.setdefault(name.name, -1 - at if part == EXTERNAL else begin + at)
    return found

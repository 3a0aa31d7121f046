"""`to_python`: a model as one readable Python module that needs numpy and nothing else."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError
from codegen.model.doubts import warn_of_doubts
from codegen.model.numbers import exact_parameters
from codegen.modes.closed import ClosedModel
from codegen.program.lower import lower
from codegen.program.records import Program
from codegen.python.blocks import (
    Names,
    coefficients_function,
    group_function,
    law_names,
    names_of,
    operations,
    values_function,
)
from codegen.python.sticking import sticking_ranks
from codegen.python.tables import flags, friction_tables, places, public, step_settings, units
from codegen.python.text import chosen, filled, listing, plain, quoted, table
from codegen.runs.arguments import initial_values, signals_for
from codegen.runs.steps import step_at_start

TEMPLATE = "templates/standalone.py.txt"
"""What is the same for every model; lines between ``#% if`` and ``#% end`` where they apply."""

_HEAD = '''"""{title}: the equations of a bond graph, and their simulation in fixed steps.

    A x' = J x + B u + E u'
       y = F x + D u + G u'

Written by bondgraph-toolkit {version}; change the graph rather than this file. Needs numpy only.
{operations} operations in all assignments, matrices included.

    run = simulate(time, initial, inputs)    fixed steps, friction with Karnopp's dead band
    model = Model(parameters)                model.rhs(t, x, u), model.outputs(t, x, u)

{names}
"""

import itertools
import math
from functools import partial
from types import SimpleNamespace

import numpy as np
'''


def to_python(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    name: str = "model",
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
) -> str:
    """The equations, closed by laws, as the text of a Python module that needs only numpy.

    ``parameters``: name to number, the module's defaults. ``laws``: as `simulator` takes them.
    ``name``: what the module calls itself. ``initial`` (states by name, others at 0) under ``inputs``
    (signals or numbers, others are 0): where a run starts, at which the longest stable step is found. The
    same arguments give the same text.

    The module has ``PARAMETERS``, ``STATES``, ``INPUTS``, ``OUTPUTS``, ``LONGEST_STEP``; ``Model`` with
    ``rhs`` and ``outputs``; and ``simulate``, which takes fixed Runge-Kutta steps, lets friction ports stick
    inside a dead band and raises the module's ``UnstableStep`` for steps beyond the method's stability.

    Raises what `simulator` raises; `StructureError` or `ParameterError`, naming the ports, where what holds
    sticking ports differs with other numbers; `ExpressionError` for functions Python lacks.
    """
    if not isinstance(parameters, Mapping):
        raise ParameterError(f"parameters must map names to numbers, not be {parameters!r}")
    program = lower(equations, laws, parameters)
    exact = exact_parameters(parameters)
    closed = ClosedModel(program, equations, parameters)
    warn_of_doubts(program, equations, exact)
    states = [symbol.name for symbol in (*program.states, *program.law_states)]
    external = [symbol.name for symbol in program.external]
    signals = signals_for({**dict.fromkeys(external, 0.0), **(inputs or {})}, external)
    longest = step_at_start(closed, initial_values(initial or {}, states), signals)
    held = sticking_ranks(program, equations, exact) if program.friction else {}
    names = names_of(program)
    used = {symbol.name: float(exact[symbol.name]) for symbol in program.parameters}
    body, fixed = _functions(program, names), chosen(_template(), flags(program, equations, held))
    lines = [
        *_head(program, equations, name, body, fixed),
        *("", *table("PARAMETERS", used)),
        *("", *public(program)),
        *("", *places(program)),
        *friction_tables(program, equations, held),
        *step_settings(longest),
        *body,
    ]
    return "\n".join(lines) + "\n\n\n" + fixed


def _template() -> str:
    return files("codegen").joinpath(TEMPLATE).read_text(encoding="utf-8")


def _head(
    program: Program, equations: StateEquations, name: str, body: Sequence[str], fixed: str
) -> list[str]:
    """The docstring, and the imports that body and fixed part need."""
    known = units(equations)
    groups = (
        ("states", (*program.states, *program.law_states)),
        ("inputs", program.external),
        ("outputs", program.outputs),
    )
    rows = []
    for title, symbols in groups:
        listed = [plain(f"{one.name} {known.get(one.name, '')}") for one in symbols] or ["none"]
        lines = filled([f"{one}, " for one in listed[:-1]] + listed[-1:], 4)
        rows += [f"{title}: {lines[0].strip()}"] if len(lines) == 1 else [f"{title}:", *lines]
    text = _HEAD.format(
        title=plain(name),
        version=version("bondgraph-toolkit"),
        operations=operations(program),
        names="\n".join(rows),
    )
    code = [line for line in body if not line.lstrip().startswith(("#", '"'))]
    used = {"math": any("math." in line for line in code), "itertools": "itertools." in fixed}
    unused = {f"import {module}" for module, needed in used.items() if not needed}
    return [line for line in text.splitlines() if line not in unused]


def _functions(program: Program, names: Names) -> list[str]:
    """The blocks of the program."""
    lines = coefficients_function(program, names)
    lines += group_function("known_laws", program.known, program, names)
    rates = [f"rate of {program.inputs[j].name}" for j in program.known.inputs]
    doc = "How fast change what known laws give." if rates else "There are none."
    lines += values_function("known_law_rates", doc, program.known_rates, rates, names)
    for name, group in zip(law_names(program), program.groups, strict=True):
        lines += group_function(name, group, program, names)
    lines += _in_turn(program)
    if program.friction:
        what = ("level", "breakaway effort", "curve", "curve at rest")
        rows = [f"{plain(str(port.name))}: {part}" for port in program.friction for part in what]
        doc = "For each friction port u = level * curve(|slip|) * sign(slip)."
        lines += values_function("friction_values", doc, program.friction_values, rows, names)
    if program.joint:
        lines += group_function("coupled_laws", program.coupled, program, names)
    return [*lines, *(_laws(program) if program.friction else ())]


def _laws(program: Program) -> list[str]:
    """A table of the laws in turn with the inputs they give, for whoever asks how large their terms are."""
    groups = [("known_laws", program.known), *zip(law_names(program), program.groups, strict=True)]
    if program.joint:
        groups.append(("coupled_laws", program.coupled))
    rows = [f"({name}, {list(group.inputs)})" for name, group in groups if group.inputs]
    return ["", "", *listing("LAWS = [", rows, "]", 0)]


def _in_turn(program: Program) -> list[str]:
    """The function that evaluates the groups of laws one after the other."""
    lines = ["", "", "def laws_in_turn(parameters, now):"]
    lines += ['    """The other laws, in an order in which each can be evaluated."""']
    for name, group in zip(law_names(program), program.groups, strict=True):
        values = f"values({name}, parameters, now, {len(group.inputs)})"
        inputs = list(group.inputs)
        if not group.loop:
            lines += listing("give(", ["now", f"{inputs}", values], ")", 4)
            continue
        ports = [quoted(str(port)) for port in group.ports]
        lines += [
            *listing("solve(", ["now", f"{inputs}", f"{list(group.readings)}",
                                f"lambda: now.u[{inputs}] - {values}",
                                f"[{', '.join(ports)}]"], ")", 4),
        ]  # fmt: skip
    return lines

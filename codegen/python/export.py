"""`to_python`: a model as one readable Python module that needs numpy and nothing else."""

import math
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

from bondgraph.equations import StateEquations
from codegen.corners.refusing import arguments, refusals
from codegen.energy.holdings import holdings
from codegen.model.commands import conditions_told
from codegen.model.doubts import warn_of_doubts
from codegen.model.starts import told_starts
from codegen.modes.steps import is_implicit
from codegen.ports.holds import all_plain, check_sets
from codegen.program.records import Program
from codegen.program.units import units
from codegen.python.beginning import held_function
from codegen.python.blocks import (
    Names,
    coefficients_function,
    group_function,
    law_names,
    names_of,
    values_function,
)
from codegen.python.closing import closing, needed
from codegen.python.lagging import lagging_functions
from codegen.python.looking import lookup_tables
from codegen.python.modules import written_out
from codegen.python.tables import friction_tables, places, public, step_settings
from codegen.python.text import RULE, filled, plain, table
from codegen.python.ticking import set_by_tasks
from codegen.python.turnings import turned_laws
from codegen.runs.start import start_of

_HEAD = '''"""{title}: the equations of a bond graph, and their simulation in fixed steps.

    A x' = J x + B u + E u'
       y = F x + D u + G u'

Written by bondgraph-toolkit {version}; change the graph rather than this file. Needs numpy only.
{operations} operations in all assignments, matrices included. Names, numbers and formulas of the model
stand first, then what is the same for every model, and `Model` and `simulate` last.

    run = simulate(time, initial, inputs)    fixed steps, friction sticks and slips
    model = Model(parameters)                model.rhs(t, x, u), model.outputs(t, x, u)

{names}
"""

{imports}
'''


def to_python(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    name: str = "model",
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
    integrator: str = "rk4",
) -> str:
    """The equations, closed by laws, as the text of a Python module that needs only numpy.

    ``parameters``: name to number, the module's defaults. ``laws``: as `simulator` takes them.
    ``name``: what the module calls itself. ``initial`` (states by name, others at 0) under ``inputs``
    (signals or numbers, others are 0): where a run starts, at which the longest stable step is found.
    ``integrator``: the method of a step, "rk4", the classical one of order 4, or "rosenbrock", a linearly
    implicit one of order 4 for stiff laws. The same arguments give the same text.

    The module has ``PARAMETERS``, ``STATES``, ``INPUTS``, ``OUTPUTS``, ``LONGEST_STEP``, and, where the graph
    declares starts, these for the parameters given as ``STARTS``; ``Model`` with ``rhs`` and ``outputs``; and
    ``simulate``, which takes fixed steps, lets friction ports stick inside a dead band and raises the
    module's ``UnstableStep`` for steps beyond the method's stability; of "rosenbrock" it warns where a step's
    error is beyond 1 % of a state's range.

    What holds sticking ports is decided for the parameters given; the module raises an `ArithmeticError` that
    names the ports with others at which other ones are redundant, and as `simulator` does.

    Raises what `simulator` raises; `ExpressionError` for functions Python lacks.
    """
    implicit = is_implicit(integrator)
    start = start_of(equations, parameters, laws, initial, inputs, located=False)
    closed, longest = start.closed, math.inf if implicit else start.longest
    program, exact = closed.program, closed.parameters
    warn_of_doubts(program, equations, exact)
    names = names_of(program)
    used = {symbol.name: float(exact[symbol.name]) for symbol in program.parameters}
    starts = told_starts(equations, exact)
    check_sets(program, closed.slips)
    slips = None if all_plain(program, closed.slips) else closed.slips
    held = holdings(program)
    imports, fixed = written_out(needed(program, slips, implicit, bool(held.names)))
    lines = [
        *_head(program, equations, name, imports),
        *("", *table("PARAMETERS", used)),
        *("", *public(program)),
        *lookup_tables(program),
        *(("", *table("STARTS", starts)) if starts else ()),
        *("", *places(program)),
        *(friction_tables(program, closed.slips) if program.friction else ()),
        *step_settings(longest, len(program.friction)),
        *_functions(program, names),
        *lagging_functions(program, names),
        *held_function(held, program, names),
    ]
    same = [RULE, "# What follows is the same for every model.", "", "", fixed]
    tail = closing(program, slips, bool(starts), held, implicit)
    return "\n".join([*lines, "", "", *same, "", "", *tail]) + "\n"


def _head(
    program: Program, equations: StateEquations, name: str, imports: Sequence[str]
) -> list[str]:
    """The docstring, and the imports."""
    known = units(equations)
    groups = (
        ("states", (*program.states, *program.law_states)),
        ("inputs", program.external),
        *([("of these by delays", program.delayed)] if program.delayed else []),
        ("outputs", program.outputs),
    )
    rows = []
    for title, symbols in groups:
        listed = [
            plain(f"{one.name} [{known[one]}]" if one in known else one.name) for one in symbols
        ] or ["none"]
        lines = filled([f"{one}, " for one in listed[:-1]] + listed[-1:], 4)
        rows += [f"{title}: {lines[0].strip()}"] if len(lines) == 1 else [f"{title}:", *lines]
    for one in equations.plain_switches:
        if told := conditions_told(one):
            words = plain(f"switch {one.name}: {told}").split(" ")
            rows += [line.strip() for line in filled([f"{word} " for word in words], 4)]
    text = _HEAD.format(
        title=plain(name),
        version=version("bondgraph-toolkit"),
        operations=sum(code.operations for code in program.blocks),
        names="\n".join(rows),
        imports="\n".join(imports),
    )
    return text.splitlines()


def _functions(program: Program, names: Names) -> list[str]:
    """The blocks of the program."""
    lines = turned_laws(program.turnings)
    lines += coefficients_function(program, names)
    lines += group_function("known_laws", program.known, program, names)
    rates = [f"rate of {program.inputs[j].name}" for j in program.known.inputs]
    doc = "How fast change what known laws give." if rates else "There are none."
    lines += values_function("known_law_rates", doc, program.known_rates, rates, names)
    for name, group in zip(law_names(program), program.groups, strict=True):
        lines += group_function(name, group, program, names)
    if program.friction:
        what = ("level", "breakaway effort", "curve", "curve at rest")
        rows = [f"{plain(str(port.name))}: {part}" for port in program.friction for part in what]
        doc = "For each friction port u = level * curve(|slip|) * sign(slip)."
        lines += values_function("friction_values", doc, program.friction_values, rows, names)
    if program.guarded or program.clocks:
        lines += _conditions(program, names)
    if program.momenta.results:
        rows = [f"moving {plain(state.name)}" for state in program.states]
        rows += [f"behind {plain(program.readings[at].name)}" for at in program.momenta_rows]
        doc = "What storages hold that impulses exchange; the matrix A has the slopes."
        lines += values_function("momenta", doc, program.momenta, rows, names)
    if program.joint:
        lines += group_function("coupled_laws", program.coupled, program, names)
    if found := refusals(program):
        rows = [plain(f"{one.argument} of {one.table.name}") for one in found]
        doc = "Arguments of tables that refuse what is outside."
        lines += values_function("table_places", doc, arguments(program), rows, names)
    return lines


def _conditions(program: Program, names: Names) -> list[str]:
    """What switches change over by, and what states become with them, or as tasks set them."""
    rows = [
        f"{plain(str(p.name))}: {way}" for p in program.told_by_guards
        if p.switch is not None for way in p.switch.guards
    ]  # fmt: skip
    rows += [
        f"{plain(str(program.friction[i].name))}: what it jumps by" for i, _ in program.hanging
    ]
    states = (*program.states, *program.law_states)
    rows += [f"{plain(str(states[one.place]))} reset by {plain(str(program.friction[one.port].name))}"
             for one in program.events]  # fmt: skip
    rows += [plain(one) for one in set_by_tasks(program)]
    doc = "Conditions of switches: to turn on and to turn off in turn, each above zero."
    if not program.guarded:
        doc = "What tasks set."
    return values_function("switch_conditions", doc, program.guards, rows, names)

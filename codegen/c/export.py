"""`to_c`: a model as C99 that allocates nothing, ready for a real-time target."""

import math
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from importlib.metadata import version
from typing import Any

from bondgraph.equations import StateEquations
from codegen.c.beginning import held_tables
from codegen.c.blocks import function, places
from codegen.c.lookups import lookup_tables, refused
from codegen.c.prefix import external_symbols, renamed
from codegen.c.rates import plain_rates, straight_rates
from codegen.c.rhs import straights
from codegen.c.runtime import runtime_file, runtime_names
from codegen.c.scenario import scenario_text
from codegen.c.tables import (
    config,
    group_tables,
    name_tables,
    program_tables,
    slip_tables,
)
from codegen.c.text import comment
from codegen.c.turnings import turned_laws
from codegen.energy.holdings import holdings
from codegen.model.commands import conditions_told
from codegen.model.doubts import warn_of_doubts
from codegen.model.resting import warn_of_rests
from codegen.model.sources import lags
from codegen.modes.closed import ClosedModel
from codegen.modes.steps import is_implicit, round_step
from codegen.ports.holds import check_sets
from codegen.program.layout import layout_text
from codegen.program.records import Block, Program, block
from codegen.runs.start import Start, start_of
from codegen.tuning import TUNING, tuning_text

STEPPED = ("model", "ports", "run")
"""Folders of what is the same for every model."""

LOCATED = "located"
"""The folder of what event-located runs need beside that .."""

CALLING = ("located_rows.h", "located_rows.c")
""".. but for what calls a model for a table of a run."""

_HEAD = """\
/* {name}
 *
 *     A x' = J x + B u + E u'
 *        y = F x + D u + G u'
 *
 * Written by bondgraph-toolkit {version}; change the graph rather than this file. C99, no memory is
 * allocated and nothing is global: an instance is one `bg_model`, which the caller provides.
 *
 *     #include "model_runtime.h"
 *     static bg_model model;                          size known when compiled
 *     double s[BG_SIZE], w[3 * BG_ROOM(BG_EXTERNAL)]; states; inputs at t, t + h/2, t + h
 *     bg_model_init(&model, NULL);                    NULL: the parameters written here
 *     bg_model_vector(&model, 0, states, w, s);
 *     for (...) bg_model_step(&model, t, h, s, w);    a real-time step; friction sticks and slips
 * or, with events located and steps that keep a tolerance, `bg_model_run` of model_located.h.
 *
 * Every call gives a status, 0 for success; `bg_model_message` says what it means. Build all files
 * of the folder, for example `cc -std=c99 -O2 *.c -lm`; with main.c that gives a program:
 *     ./a.out END SAMPLE [located] [name=value ...]   prints states and outputs as CSV
 *
 * {together}
 *
 * One evaluation takes {operations} operations beside those of the matrices.
{names}
 */
#include <math.h>

#include "model_internal.h"
"""

_ALONE = """\
A program with two models takes each from a folder of its own, written with `prefix`, which every
 * external symbol then carries. Where a model is used, a file of its own includes its header; sizes
 * and types are those of that file, and `bg_model_init` and the others its model's functions."""

_BESIDE = """\
External symbols begin with `{prefix}`, by macros in config.h: `bg_model_init` is
 * `{prefix}bg_model_init`. So other models link into the same program: each in a folder of its own,
 * each used by a file of its own, which includes its header and sees its sizes and types alone."""


def to_c(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    name: str = "model",
    main: bool = False,
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
    prefix: str = "",
    initially_on: Iterable[Hashable] = (),
    integrator: str = "rk4",
) -> dict[str, str]:
    """The equations, closed by laws, as files of C99: name to text.

    ``parameters``: name to number, the defaults of `bg_model_init`. ``laws``: as `simulator` takes them.
    ``name``: what the model calls itself. ``main``: with a main program that prints a run as CSV, from
    ``initial`` (states by name, others start at 0) under ``inputs`` (signals or numbers, others are 0)
    unless it is told otherwise, and warned of if a command of a switch that is on rests at zero in it;
    `BG_LONGEST_STEP` of config.h is found there, too. ``prefix``: what every
    external symbol begins with, such as "front_"; models with different ones link into one program.
    ``initially_on``: the switches that are on before a run, as far as their conditions let them; in the main
    program states that are not in ``initial`` then follow what these hold. ``integrator``: the method of a
    real-time step, "rk4", the classical one of order 4, or "rosenbrock", a linearly implicit one of order 4
    for stiff laws, which is stable at any length. The same arguments give the same text; `model.c` tells how
    it is used, and config.h what a step costs.

    Which sticking ports are redundant is decided exactly, at these parameters; others at which that
    changes are refused when the model is run.

    Raises what `simulator` raises; `ExpressionError` for functions C lacks; `ParameterError` for a prefix
    that no name in C can begin with, or an integrator that is none of these.
    """
    given = (main, initial, inputs, prefix, initially_on, integrator)
    start, files = exported(equations, parameters, laws, name, *given)
    closed = start.closed
    warn_of_doubts(closed.program, equations, closed.parameters)
    if main:
        names = [symbol.name for symbol in closed.program.external]
        signals = dict(zip(names, start.signals, strict=True))
        warn_of_rests(closed.equations, closed.parameters, signals, start.on)
    return files


def exported(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    name: str = "model",
    main: bool = False,
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
    prefix: str = "",
    initially_on: Iterable[Hashable] = (),
    integrator: str = "rk4",
) -> tuple[Start, dict[str, str]]:
    """As `to_c`, with where it begins; who asks for it tells what there is to be told of that."""
    implicit = is_implicit(integrator)
    start = start_of(equations, parameters, laws, initial, inputs, initially_on)
    closed = start.closed
    longest = math.inf if implicit else start.longest
    defaults = [float(closed.parameters[symbol.name]) for symbol in closed.program.parameters]
    memory = memory_of(closed, longest)
    files = texts(closed, name, defaults, prefix, longest, start.on, implicit, memory)
    if main:
        states = [*closed.program.states, *closed.program.law_states]
        named = [state.name in start.told for state in states]
        scenario = scenario_text(start.signals, start.states.tolist(), named)
        files |= {"main.c": runtime_file("main.c"), "scenario.h": scenario}
    return start, files


def texts(
    closed: ClosedModel,
    name: str,
    defaults: Sequence[float],
    prefix: str = "",
    longest: float | None = None,
    on: Collection[Hashable] = (),
    implicit: bool = False,
    memory: int = 0,
) -> dict[str, str]:
    """The files of a model without a main program; ``longest``: its longest stable step, if that is told;
    ``on``: the switches that are on before a run; ``implicit``: whether fixed steps are linearly implicit;
    ``memory``: how many parts of a run delays remember, 0 where what they give is given.

    Its parameters are in ``defaults`` and ``longest`` alone, and in which sticking ports are redundant.
    """
    names = [name for folder in (*STEPPED, LOCATED) for name in runtime_names(folder)]
    runtime = {name: runtime_file(name) for name in names if name not in CALLING}
    headers = [text for file, text in runtime.items() if file.endswith(".h")]
    macros = renamed(prefix, external_symbols(headers))
    program, equations, kept = closed.program, closed.equations, holdings(closed.program)
    check_sets(program, closed.slips)
    ports, fast = range(len(program.friction)), straights(program)
    lines = [
        *_head(program, equations, name, prefix),
        *name_tables(program, equations, name),
        *lookup_tables(program.tables),
        *turned_laws(program.turnings),
        "",
        *program_tables(program, defaults, [closed.coupled_directly(i) for i in ports], on),
        "",
        *slip_tables(closed.slips, len(program.states), program.coupled.inputs),
        *held_tables(kept),
        *_functions(program, kept.values, program.delaying if memory else block([])),
        "",
        *refused(program),
        *group_tables(program),
        *(straight_rates(program, fast) if fast else plain_rates()),
    ]
    sizes = config(program, fast, kept, name, macros, longest, implicit, memory)
    told = {"config.h": sizes, "layout.h": layout_text(), "tuning.h": tuning_text()}
    return {**told, "model.c": "\n".join(lines) + "\n", **runtime}


def memory_of(closed: ClosedModel, longest: float) -> int:
    """How many parts delays remember: steps of the usual length twice over; 0 where there are no delays."""
    if not closed.program.delayed:
        return 0
    late = max(one.late for one in lags(closed.equations.delays, closed.parameters))
    usual = round_step(min(TUNING.usual_step, longest / 2))
    least, most = TUNING.least_memory, TUNING.most_memory
    return min(max(math.ceil(2 * late / usual), least), most)


def stepped(files: Mapping[str, str]) -> dict[str, str]:
    """An export without what only event-located runs need."""
    located = runtime_names(LOCATED)
    return {name: text for name, text in files.items() if name not in located}


def _head(program: Program, equations: StateEquations, name: str, prefix: str) -> list[str]:
    parts = (
        ("states", (*program.states, *program.law_states)), ("inputs", program.wanted),
        ("outputs", program.outputs), ("parameters", program.parameters),
        *([("late, given by delays", program.delayed)] if program.delayed else []),
    )  # fmt: skip
    rows: list[str] = []
    for what, symbols in parts:
        listed = ", ".join(symbol.name for symbol in symbols) or "none"
        # Less the marks of a comment of its own.
        rows += comment(f"{what}: {listed}")
    for one in equations.switches:
        if told := conditions_told(one):
            rows += comment(f"switch {one.name}: {told}")
    names = "\n".join(f" * {row.removeprefix('/* ').removesuffix(' */')}" for row in rows)
    title = comment(name)[0].removeprefix("/* ").removesuffix(" */")
    count = sum(code.operations for code in program.blocks)
    text = _HEAD.format(
        name=title,
        version=version("bondgraph-toolkit"),
        operations=count,
        names=names,
        together=_BESIDE.format(prefix=prefix) if prefix else _ALONE,
    )
    return text.splitlines() + [""]


def _functions(program: Program, held: Block, delaying: Block) -> list[str]:
    """The blocks of the program as functions."""
    where, on = places(program), program.on_sides
    rows = [
        ("bg_coefficients", "Nonzero entries of A, J, B, E, F, D, H, K", program.coefficients,
         on.coefficients),
        ("bg_known_rates", "Rates of what known laws give", program.known_rates, on.known_rates),
        ("bg_friction_values", "Level, breakaway level, curve and curve at rest of each friction port",
         program.friction_values, on.friction_values),
        ("bg_guards", "Conditions of switches, to turn on and to turn off in turn", program.guards, None),
        ("bg_momenta", "What storages hold that impulses exchange", program.momenta, None),
        ("bg_held_values", "How states follow from what storages hold at a start", held, None),
        ("bg_delaying", "Of each delay what it reads, how late it is, what it gives before", delaying, None),
        ("bg_corners", "What corners hang on, and for each whether it counts", *_hung(program)),
    ]  # fmt: skip
    lines: list[str] = []
    for name, what, code, sided in rows:
        lines += function(name, what, code, where, False, sided)
    known, coupled = program.known.values, program.coupled.values
    lines += function("known_values", "What known laws give", known, where, True, on.known.values)
    for at, (group, beside) in enumerate(zip(program.groups, on.groups, strict=True)):
        ports = ", ".join(str(port) for port in group.ports)
        what = f"What {ports} gives"
        lines += function(f"group_{at}_values", what, group.values, where, True, beside.values)
    what = "Laws solved with friction"
    return [*lines, *function("coupled_values", what, coupled, where, True, on.coupled.values)]


def _hung(program: Program) -> tuple[Block, Block]:
    """What corners hang on by laws as they are, and on one side of each; of no corners nothing."""
    corners = program.corners
    return (block([]), block([])) if corners is None else (corners.values, corners.on_sides)

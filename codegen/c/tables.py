"""The sizes and tables of a program as C."""

from collections.abc import Collection, Hashable, Iterable, Sequence

import sympy as sp

from bondgraph.equations import StateEquations
from codegen.c.counting import StepCost, step_cost
from codegen.c.lookups import lookup_names, lookup_sizes
from codegen.c.rhs import Straight
from codegen.c.text import array, comment, doubles, integers, quoted, strings
from codegen.c.turnings import turning_names
from codegen.energy.holdings import Holdings
from codegen.modes.stability import modes_told
from codegen.modes.steps import told_step
from codegen.program.records import FrictionPort, Group, Program
from codegen.program.units import units
from codegen.standalone.ranks import SlipRows

WAYS = ("BG_RUBS", "BG_ONE_SIDED", "BG_TOLD", "BG_STOPS")
"""What makes a port change over, by the names of C."""

MOST_HOLDS = 16
"""Holding equations of so many sets of friction ports are kept once they are found .."""

FEW_HOLDS = 4
""".. and of so many where they are large, or hold for an instant only."""

LARGE = 16
"""More ports than these have large ones."""


def config(
    program: Program,
    fast: Sequence[Straight],
    held: Holdings,
    name: str,
    macros: Sequence[str] = (),
    longest: float | None = None,
    implicit: bool = False,
    memory: int = 0,
) -> str:
    """config.h: the sizes of everything, and macros that rename external symbols.

    ``longest``: the longest stable step at the default point [s], None for no word on it; ``implicit``:
    whether fixed steps are linearly implicit. ``memory``: how many parts of a run delays remember; of 0 what
    they give is given.
    """
    lines = [*comment(f"Sizes of {name}; written by bondgraph-toolkit."), "#ifndef BG_CONFIG_H"]
    lines += [
        "#define BG_CONFIG_H",
        "",
        *_cost(step_cost(program, implicit), bool(program.clocks), memory > 0),
        "",
    ]
    lines += [f"#define BG_{key} {value}" for key, value in _sizes(program, fast).items()]
    lines += [
        f"#define BG_HOLDINGS {len(held.names)}",
        f"#define BG_HOLDING_VALUES {len(held.places)}",
    ]
    lines += [f"#define BG_ROSENBROCK {int(implicit)}"]
    lines += _memory(program, memory)
    lines += ["", *_steps(longest, len(program.friction))]
    lines += ["", *macros] if macros else []
    lines += [*lookup_names(program.tables), *turning_names(program.turnings)]
    return "\n".join([*lines, "", "#endif", ""])


def _cost(cost: StepCost, ticks: bool, late: bool) -> list[str]:
    """What a real-time step takes, in operations; whether there are sampled tasks, and delays."""
    told = [
        "What a real-time step takes, in operations of floating point; tables count as if full.",
        f"One evaluation of the rates: {cost.evaluation}.",
        f"A step in which no port changes, {cost.evaluations} evaluations: {cost.usual}.",
    ]
    if cost.changes:
        told += [
            f"Each change of ports, at most {cost.changes} in a step: {cost.change}, with {cost.pivots} ways "
            "to hold and let go at the most.",
        ]
    if ticks:
        told += [
            "Each instant of a task inside a step costs a step more; what tasks set is beside these."
        ]
    if late:
        told += [
            "Four evaluations more are for what delays read; a break in what they give costs a step more."
        ]
    lines = [line for text in told for line in comment(text)]
    return [
        *lines,
        f"#define BG_STEP_OPERATIONS {cost.usual.total}",
        f"#define BG_STEP_MOST_OPERATIONS {cost.most.total}",
    ]


def _memory(program: Program, parts: int) -> list[str]:
    """How much delays remember."""
    if not parts:
        return ["#define BG_DELAYS 0", "#define BG_DELAYED_FROM 0", "#define BG_MEMORY 1"]
    return [
        f"#define BG_DELAYS {len(program.delayed)}",
        f"#define BG_DELAYED_FROM {program.external.index(program.delayed[0])}",
        "",
        *comment("Delays remember so many parts of a run: of fixed steps each is one, and more where "
                 "these are cut."),
        "#ifndef BG_MEMORY",
        f"#define BG_MEMORY {parts}",
        "#endif",
    ]  # fmt: skip


def _steps(longest: float | None, ports: int) -> list[str]:
    """What there is to say of fixed steps."""
    told = []
    if longest is not None:
        told = [
            *comment(
                "The longest step [s] that is stable at the default start, parameters and inputs, in "
                f"{modes_told(ports)}; 1e300 if nothing bounds it."
            ),
            f"#define BG_LONGEST_STEP {told_step(longest)!r}",
            "",
        ]
    return [
        *told,
        *comment("Whether each step is checked for stability, at two evaluations more."),
        "#ifndef BG_CHECK_STEP",
        "#define BG_CHECK_STEP 1",
        "#endif",
    ]


def _sizes(program: Program, fast: Sequence[Straight]) -> dict[str, int]:
    ports, coupled = len(program.friction), len(program.coupled.inputs)
    sizes = [len(group.inputs) for group in program.groups]
    loops = [len(group.inputs) for group in program.groups if group.loop]
    largest = max(1, coupled, len(program.known.inputs), *sizes)
    return {
        "STATES": len(program.states),
        "LAW_STATES": len(program.law_states),
        "INPUTS": len(program.inputs),
        "EXTERNAL": len(program.external),
        "OUTSIDE": sum(name in program.inputs for name in program.external),
        "READINGS": len(program.readings),
        "OUTPUTS": len(program.outputs),
        "PARAMETERS": len(program.parameters),
        "ENTRIES": len(program.coefficients.results),
        "GROUPS": len(program.groups),
        "EARLY": program.early,
        "LARGEST": largest,
        "LOOP": max([ports + coupled if program.joint else 0, *loops]),
        "FRICTION": ports,
        "PORTS": max(ports, 1),
        "SWITCHES": sum(port.switch is not None for port in program.friction),
        "HUNG": sum(port.order == 2 for port in program.friction),
        "STOPPING": int(program.stopped),
        "GUARDS": len(program.guards.results),
        "RESETS": len(program.resets),
        "CLOCKS": len(program.clocks),
        "MOMENTA": len(program.momenta.results),
        "COUPLED": coupled,
        "HOLDS": min(FEW_HOLDS if program.varying or ports > LARGE else MOST_HOLDS, 2**ports),
        "CONSTANTS": sum(len(one.constants) for one in fast),
        "VARYING": int(program.varying),
        "AFFINE": int(program.affine),
        "JOINT": int(program.joint),
        "DRIVEN": int(bool(program.layout["E"].rows)),
        "RATED": int(program.rated),
        "STRAIGHT": int(bool(fast)),
        "CORNERS": len(program.sides),
        "CORNERS_TOLD": int(program.corners_told),
        **lookup_sizes(program),
    }


def name_tables(program: Program, equations: StateEquations, name: str) -> list[str]:
    """Names and units, for whoever calls the model."""
    known = units(equations)
    lines = [f"const char *const bg_model_name = {quoted(name)};"]
    groups = (
        ("state", (*program.states, *program.law_states)),
        ("input", program.external),
        ("output", program.outputs),
    )
    for what, symbols in groups:
        lines += strings(f"bg_{what}_names", _names(symbols))
        lines += strings(f"bg_{what}_units", [known.get(symbol, "") for symbol in symbols])
    lines += strings("bg_parameter_names", _names(program.parameters))
    lines += strings("bg_friction_names", [str(port.name) for port in program.friction])
    return [*lines, *strings("bg_task_names", [str(task.name) for task in equations.tasks])]


def _names(symbols: Iterable[sp.Symbol]) -> list[str]:
    return [symbol.name for symbol in symbols]


def program_tables(
    program: Program, defaults: Sequence[float], beside: Sequence[bool], on: Collection[Hashable]
) -> list[str]:
    """Places of laws, friction ports, readings and outputs in the arrays; ``on``: switches at first."""
    readings = list(program.readings)
    friction, rated = program.friction, program.rated_inputs
    tables: list[tuple[str, Sequence[int]]] = [
        ("bg_law_rates", program.law_rates),
        ("bg_friction_inputs", [port.input for port in friction]),
        ("bg_friction_readings", [port.reading for port in friction]),
        ("bg_received_readings", [port.received for port in friction]),
        ("bg_moving", [-1 if port.moving is None else port.moving for port in friction]),
        ("bg_first_modes", program.before(on)),
        ("bg_beside", [int(one) for one in beside]),
        ("bg_momenta_rows", program.momenta_rows),
        ("bg_outside_inputs", program.given),
        ("bg_differentiable", [int(j in rated) for j in range(len(program.inputs))]),
        ("bg_output_readings", [readings.index(one) for one in program.outputs]),
    ]
    lines = doubles("bg_defaults", defaults)
    for name, numbers in tables:
        lines += integers(name, numbers)
    rows = [_switch(port) for port in friction]
    lines += array("const bg_switch bg_switches[]", rows, f"{{{', '.join('0' * 10)}}}")
    rows = [f"{{{one.port}, {one.sign}, {one.place}, {one.value}}}" for one in program.resets]
    lines += array("const bg_reset bg_resets[]", rows, "{0, 0, 0, 0}")
    rows = [f"{{{one.every!r}, {one.offset!r}, {one.unit!r}}}" for one in program.clocks]
    lines += array("const bg_clock bg_clocks[]", rows, "{0.0, 0.0, 0.0}")
    return [*lines, "", *_layout(program)]


def _switch(port: FrictionPort) -> str:
    kind, *parts = port.in_c
    return f"{{{', '.join((WAYS[kind], *map(str, parts)))}}}"


def _layout(program: Program) -> list[str]:
    """Where the entries of each matrix stand."""
    lines, rows = [], []
    for letter, pattern in program.layout.items():
        lines += integers(f"rows_{letter}", pattern.rows, local=True)
        lines += integers(f"columns_{letter}", pattern.columns, local=True)
        rows.append(f"{{{len(pattern.rows)}, rows_{letter}, columns_{letter}}}")
    return [*lines, *array("const bg_pattern bg_layout[BG_MATRICES]", rows)]


def slip_tables(slips: SlipRows, states: int, coupled: Sequence[int]) -> list[str]:
    """What friction ports receive, in residues; ``coupled``: inputs of laws that friction moves."""
    places, residues, begins = list[int](), list[str](), [0]
    moved, moved_begins = list[int](), [0]
    for F, D, laws in zip(slips.F, slips.D, slips.moved, strict=True):
        row = {**F, **{states + j: entry for j, entry in D.items()}}
        places += row
        residues += (f"{entry}u" for entry in row.values())
        begins.append(len(places))
        moved += (coupled.index(j) for j in laws)
        moved_begins.append(len(moved))
    inverse = -pow(slips.prime, -1, 2**64) % 2**64
    return [
        *integers("bg_slip_begins", begins),
        *integers("bg_slip_places", places),
        *array("const unsigned long long bg_slip_residues[]", residues),
        *integers("bg_moved_begins", moved_begins),
        *integers("bg_moved", moved),
        f"const unsigned long long bg_prime = {slips.prime}u;",
        f"const unsigned long long bg_prime_inverse = {inverse}u;",
    ]


def group_tables(program: Program) -> list[str]:
    """The groups of laws in their order, with the functions that evaluate them."""
    lines: list[str] = []
    for at, group in enumerate(program.groups):
        lines += _places(f"group_{at}", group)
    lines += [*_places("known", program.known), *_places("coupled", program.coupled)]
    lines += [f"const bg_group bg_known = {_entry('known', program.known)};"]
    lines += [f"const bg_group bg_coupled = {_entry('coupled', program.coupled)};"]
    rows = [_entry(f"group_{at}", group) for at, group in enumerate(program.groups)]
    nothing = _entry("known", program.known)
    return [*lines, *array("const bg_group bg_groups[]", rows, nothing)]


def _places(name: str, group: Group) -> list[str]:
    return [
        *integers(f"{name}_inputs", group.inputs, local=True),
        *integers(f"{name}_readings", group.readings, local=True),
    ]


def _entry(name: str, group: Group) -> str:
    count, loop = len(group.inputs), int(group.loop)
    return f"{{{count}, {loop}, {name}_inputs, {name}_readings, {name}_values}}"

"""What the C glue of a functional mock-up unit is told of its model: sizes, variables, sources."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from bondgraph.equations import StateEquations
from codegen.c.blocks import function, places
from codegen.c.scenario import signal_lines, signals_record
from codegen.c.text import array, comment, doubles, integers, quoted
from codegen.fmu.resolution import resolution_text
from codegen.fmu.variable import Variable
from codegen.fmu.variables import Starts
from codegen.inputs.signal import Signal
from codegen.inputs.tables import known_span, signal_table
from codegen.program.records import Program, block


@dataclass(frozen=True)
class FmuModel:
    """A model on its way into a unit. ``sources``: external inputs with the signals that are inside.

    ``first``: the mode of each port before a run. ``switches``: expressions at whose zeros laws switch,
    ``timed``: those of time and parameters alone, with conditions of switches that are. ``known``: what
    holds the time and parameters alone. ``shortest`` [s]: its shortest time constant. ``identifier``: what
    its binaries are called.
    """

    name: str
    identifier: str
    program: Program
    equations: StateEquations
    variables: tuple[Variable, ...]
    starts: Starts
    sources: tuple[tuple[int, Signal], ...]
    first: tuple[int, ...]
    switches: tuple[sp.Expr, ...]
    timed: tuple[sp.Expr, ...]
    known: tuple[sp.Expr, ...]
    shortest: float

    @property
    def indicators(self) -> int:
        """Two for each port, one for each expression at whose zero a law switches."""
        return 2 * len(self.program.friction) + len(self.switches)


def config_text(model: FmuModel, token: str) -> str:
    """fmu_config.h."""
    lines = [*comment(f"Sizes of the unit {model.name}; written by bondgraph-toolkit.")]
    lines += ["#ifndef BG_FMU_CONFIG_H", "#define BG_FMU_CONFIG_H", ""]
    sizes = {
        "VARIABLES": str(len(model.variables)),
        "SWITCHES": str(len(model.switches)),
        "TIMED": str(len(model.timed)),
        "SHORTEST": repr(model.shortest),
        "TOKEN": quoted(token),
    }
    lines += [f"#define FMU_{key} {value}" for key, value in sizes.items()]
    return "\n".join([*lines, "", "#endif", ""])


def model_text(model: FmuModel) -> str:
    """fmu_model.c: variables, start values and modes, sources and switching expressions."""
    program = model.program
    taken = {*program.parameters, *program.inputs, *program.readings, *program.external}
    code, timed = block(model.switches, taken), block(model.timed, taken)
    lines = [
        *comment(f"Tables of the unit {model.name}; written by bondgraph-toolkit."),
        "#include <math.h>",
        "",
        '#include "fmu_common.h"',
        '#include "fmu_ranges.h"',
        "",
        *array(
            "const fmu_variable fmu_variables[]",
            [f"{{{one.kind}, {one.index}}}" for one in model.variables],
        ),
        *doubles("fmu_starts", model.starts.states),
        *doubles("fmu_inputs", model.starts.inputs),
        *integers("fmu_named", map(int, model.starts.named)),
        *integers("fmu_first", model.first),
        *_sources(model.sources, len(program.external)),
        *function("fmu_switch_values", "Where laws switch", code, places(program), local=False),
        *function(
            "fmu_timed_values", "What changes by time alone", timed, places(program), local=False
        ),
        *resolution_text(program, model.known),
    ]
    return "\n".join(lines) + "\n"


def _sources(sources: Sequence[tuple[int, Signal]], external: int) -> list[str]:
    inside = [signal for _, signal in sources]
    begin, end = known_span(inside)
    table = signal_table(inside, begin - 1.0, end)
    places = [at for at, _ in sources]
    terms = [(places[at], *rest) for at, *rest in table.terms]
    return [
        *signal_lines(replace(table, terms=tuple(terms)), "fmu_signals"),  # type: ignore[arg-type]
        *signals_record(table, "fmu_signals"),
        *integers("fmu_inside", (int(at in places) for at in range(external))),
    ]

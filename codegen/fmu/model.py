"""What the C glue of a functional mock-up unit is told of its model: sizes, variables, sources."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph import StateEquations
from codegen.c.blocks import function, places
from codegen.c.text import array, comment, doubles, quoted
from codegen.fmu.variables import Starts, Variable
from codegen.inputs.pieces import Piece
from codegen.inputs.signals import Signal
from codegen.program import Program, block


@dataclass(frozen=True)
class FmuModel:
    """A model on its way into a unit. ``sources``: external inputs with the signals that are inside.

    ``shortest`` [s]: its shortest time constant. ``identifier``: what its binaries are called.
    """

    name: str
    identifier: str
    program: Program
    equations: StateEquations
    variables: tuple[Variable, ...]
    starts: Starts
    sources: tuple[tuple[int, Signal], ...]
    switches: tuple[sp.Expr, ...]
    shortest: float

    @property
    def indicators(self) -> int:
        """Two for each friction port, one for each expression at whose zero a law switches."""
        return 2 * len(self.program.friction) + len(self.switches)


def config_text(model: FmuModel, token: str) -> str:
    """fmu_config.h."""
    lines = [*comment(f"Sizes of the unit {model.name}; written by bondgraph-toolkit.")]
    lines += ["#ifndef BG_FMU_CONFIG_H", "#define BG_FMU_CONFIG_H", ""]
    sizes = {
        "VARIABLES": str(len(model.variables)),
        "SWITCHES": str(len(model.switches)),
        "SOURCES": str(len(model.sources)),
        "SHORTEST": repr(model.shortest),
        "STEP": repr(model.starts.step),
        "TOKEN": quoted(token),
    }
    lines += [f"#define FMU_{key} {value}" for key, value in sizes.items()]
    return "\n".join([*lines, "", "#endif", ""])


def model_text(model: FmuModel) -> str:
    """fmu_model.c: variables, start values, sources and switching expressions."""
    program = model.program
    taken = {*program.parameters, *program.inputs, *program.readings, *program.external}
    code = block(model.switches, taken)
    lines = [
        *comment(f"Tables of the unit {model.name}; written by bondgraph-toolkit."),
        "#include <math.h>",
        "",
        '#include "fmu_common.h"',
        "",
        *array(
            "const fmu_variable fmu_variables[]",
            [f"{{{one.kind}, {one.index}}}" for one in model.variables],
        ),
        *doubles("fmu_starts", model.starts.states),
        *doubles("fmu_inputs", model.starts.inputs),
        *_sources(model.sources),
        *function("fmu_switch_values", "Where laws switch", code, places(program), local=False),
    ]
    return "\n".join(lines) + "\n"


def _sources(sources: Sequence[tuple[int, Signal]]) -> list[str]:
    coefficients: list[complex] = []
    terms: list[str] = []
    pieces: list[str] = []
    breaks: list[float] = []
    rows: list[str] = []
    for external, signal in sources:
        points = signal.breakpoints
        rows.append(f"{{{external}, {len(breaks)}, {len(points)}, {len(pieces)}}}")
        breaks += points
        for piece in signal.pieces:
            pieces.append(f"{{{float(piece.start)!r}, {len(terms)}, {len(piece.terms)}}}")
            _add_terms(piece, terms, coefficients)
    pairs = [f"{{{c.real!r}, {c.imag!r}}}" for c in coefficients]
    return [
        *array("const fmu_source fmu_sources[]", rows, "{0, 0, 0, 0}"),
        *array("const fmu_piece fmu_pieces[]", pieces, "{0.0, 0, 0}"),
        *array("const fmu_term fmu_terms[]", terms, "{{0.0, 0.0}, 0, 0}"),
        *array("const double fmu_coefficients[][2]", pairs, "{0.0, 0.0}"),
        *doubles("fmu_breaks", breaks),
    ]


def _add_terms(piece: Piece, terms: list[str], coefficients: list[complex]) -> None:
    for rate, polynomial in piece.terms:
        value = complex(rate)
        place = f"{len(coefficients)}, {len(polynomial)}"
        terms.append(f"{{{{{value.real!r}, {value.imag!r}}}, {place}}}")
        coefficients += [complex(one) for one in polynomial]

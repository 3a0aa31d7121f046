"""The signals of a model's known sources: expressions of time at its parameters' numbers."""

from collections.abc import Mapping

import sympy as sp

from bondgraph.errors import StructureError
from codegen.inputs.known import known_signal
from codegen.inputs.signal import Signal
from codegen.model.exact_values import at_parameters
from codegen.program.records import Program
from codegen.tuning import TUNING


def source_signals(
    program: Program, parameters: Mapping[str, sp.Rational], begin: float, end: float,
    found: bool = False,
) -> list[Signal]:  # fmt: skip
    """A signal for each of the program's sources, from ``begin`` to ``end`` [s].

    ``found``: whether what delays give is among the inputs already, as in runs.

    Raises `StructureError` where it is not, which is everywhere but in runs.
    """
    if program.delayed and not found:
        refuse_delays(program)
    return [
        known_signal(at_parameters(expr, parameters), begin, max(end, begin + TUNING.shortest))
        for expr in program.sources
    ]


def refuse_delays(program: Program) -> None:
    """Refuse what has no past: what a delay gives is told by the run so far.

    Raises `StructureError`, naming the delay.
    """
    if program.delayed:
        name = program.delayed[0]
        raise StructureError(
            f"delay {name}: what it gives is told by the past of a run, and only runs and sweeps have one; "
            f"put bg.Function({name.name!r}, ...) in its place for what rests or is instantaneous, or a "
            "bg.TransferFunction that stands for it"
        )

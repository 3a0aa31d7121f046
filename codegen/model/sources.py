"""The signals of a model's known sources: expressions of time at its parameters' numbers."""

from collections.abc import Mapping

import sympy as sp

from codegen.inputs.known import known_signal
from codegen.inputs.signal import Signal
from codegen.model.exactly import at_parameters
from codegen.program.records import Program
from codegen.tuning import TUNING


def source_signals(
    program: Program, parameters: Mapping[str, sp.Rational], begin: float, end: float
) -> list[Signal]:
    """A signal for each of the program's sources, from ``begin`` to ``end`` [s]."""
    return [
        known_signal(at_parameters(expr, parameters), begin, max(end, begin + TUNING.shortest))
        for expr in program.sources
    ]

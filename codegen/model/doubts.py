"""What a model that can be run is told for: storages that give energy away, laws with several solutions."""

import warnings
from collections.abc import Container, Iterator, Mapping

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import ModelWarning
from codegen.model.energies import negative_energies
from codegen.model.outside import outside
from codegen.model.solutions import several_solutions
from codegen.program.records import Program


def warn_of_doubts(
    program: Program,
    equations: StateEquations,
    parameters: Mapping[str, sp.Rational],
    told: Container[str] = (),
) -> tuple[str, ...]:
    """One `ModelWarning` for each doubt about a model at these numbers, at the user's line; what they say.

    ``told``: what need not be said again.
    """
    texts = tuple(text for text in _doubts(program, equations, parameters) if text not in told)
    for text in texts:
        warnings.warn(text, ModelWarning, stacklevel=outside())
    return texts


def _doubts(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Iterator[str]:
    yield from negative_energies(equations, parameters)
    yield from several_solutions(program, parameters)

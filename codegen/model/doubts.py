"""What a model that can be run is told for: storages that give energy away, laws with several solutions."""

import sys
import warnings
from collections.abc import Container, Iterator, Mapping
from types import FrameType

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import ModelWarning
from codegen.model.energies import negative_energies
from codegen.model.solutions import several_solutions
from codegen.program.records import Program

INSIDE = ("codegen", "differentials", "functools")
"""Packages whose lines are none of the user's; the last calls what is made when it is first asked for."""


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
        warnings.warn(text, ModelWarning, stacklevel=_outside())
    return texts


def _doubts(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Iterator[str]:
    yield from negative_energies(equations, parameters)
    yield from several_solutions(program, parameters)


def _outside() -> int:
    """How far above the caller the line stands that is no part of the toolkit."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and _package(frame) in INSIDE:
        frame, level = frame.f_back, level + 1
    return level


def _package(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]

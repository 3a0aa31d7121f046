"""What of a derivation is shown: how many lines of a step, and how many terms of a line."""

from collections.abc import Sequence
from typing import TypeVar

from bondgraph.display import counted, listed, structure as formula
from bondgraph.equations import StateEquations

MOST_LINES = 40
"""A step of more lines than this, unless told otherwise, shows its first few."""

FIRST_FEW = 6

MOST_TERMS = 16
"""Of longer sums the first terms are shown, unless everything is."""

LARGEST_MATRIX = 8
"""Matrices with more rows or columns are told by their size, unless everything is shown."""

T = TypeVar("T")


def first_few(lines: Sequence[T], limit: int | None) -> tuple[Sequence[T], int]:
    """The lines to show and how many are left out."""
    if limit is None or len(lines) <= limit:
        return lines, 0
    shown = min(FIRST_FEW, limit)
    return lines[:shown], len(lines) - shown


def shortened(pieces: Sequence[str], limit: int | None) -> tuple[list[str], int]:
    """The terms of a sum to show and how many are left out."""
    if limit is None or len(pieces) <= MOST_TERMS:
        return list(pieces), 0
    return list(pieces[:MOST_TERMS]), len(pieces) - MOST_TERMS


def fits(equations: StateEquations, limit: int | None) -> bool:
    """Whether matrices over states are small enough to be shown."""
    return limit is None or len(equations.states) <= LARGEST_MATRIX


def heading(equations: StateEquations) -> tuple[str, ...]:
    """What is derived, and the names that the derivation is about."""
    structure = equations.reduction.structure
    dependent = [structure.ports[port].element.name for port in equations.reduction.dependent]
    lines = [
        f"From a bond graph of {counted(len(structure.elements), 'node')} and "
        f"{counted(len(structure.bonds), 'bond')} to {formula(equations)}"
    ]
    for count, what, names in (
        (len(equations.states), "state", equations.states),
        (len(equations.inputs), "input", equations.inputs),
        (len(equations.outputs), "output", equations.outputs),
        (len(dependent), "dependent storage", dependent),
    ):
        if count:
            lines.append(f"{counted(count, what)}: {listed(list(names))}")
    return tuple(lines)

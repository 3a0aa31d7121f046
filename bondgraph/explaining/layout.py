"""What of a derivation is shown: how many lines of a step, and how many terms of a line."""

from collections.abc import Sequence
from typing import TypeVar

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.show.display import counted, listed
from bondgraph.show.display import structure as formula
from bondgraph.show.sums import Sum

MOST_LINES = 40
"""A step of more lines than this, unless told otherwise, shows its first few."""

FIRST_FEW = 6

MOST_TERMS = 16
"""Of longer sums the first terms are shown, unless everything is."""

MOST_OPERATIONS = 80
"""Of longer factors the length is shown, unless everything is."""

LARGEST_MATRIX = 8
"""Matrices with more rows or columns are told by their size, unless everything is shown."""

T = TypeVar("T")


def first_few(lines: Sequence[T], limit: int | None) -> tuple[Sequence[T], int]:
    """The lines to show and how many are left out."""
    if limit is None or len(lines) <= limit:
        return lines, 0
    shown = min(FIRST_FEW, limit)
    return lines[:shown], len(lines) - shown


def shortened(side: Sum, limit: int | None, name: str) -> tuple[Sum, int]:
    """The terms of a sum to show and how many are left out; long factors are told by their length.

    ``name``: what such a factor is called, with a place for the number of its operations.
    """
    if limit is None:
        return side, 0
    terms = tuple((_named(factor, name), signal) for factor, signal in side[:MOST_TERMS])
    return terms, len(side) - len(terms)


def _named(factor: sp.Expr, name: str) -> sp.Expr:
    operations = factor.count_ops()
    return sp.Symbol(name.format(operations)) if operations > MOST_OPERATIONS else factor


def fits(equations: StateEquations, limit: int | None) -> bool:
    """Whether matrices over states and dependent storages are small enough to be shown."""
    largest = max(len(equations.states), len(equations.reduction.dependent))
    return limit is None or largest <= LARGEST_MATRIX


def heading(equations: StateEquations) -> tuple[str, ...]:
    """What is derived, and the names that the derivation is about."""
    structure = equations.reduction.structure
    dependent = [structure.ports[port].element.name for port in equations.reduction.dependent]
    further = equations.further_states
    goal = formula(equations) or _rates_of(len(further))
    elements = structure.elements
    signals = {one.whole for one in elements.values() if one.of_signals}
    nodes = [one for one in elements.values() if not one.of_signals]
    bonds = [
        one
        for one in structure.bonds
        if not {elements[e].whole for e in one if e in elements} & signals
    ]
    lines = [
        f"From a bond graph of {counted(len(nodes), 'node')} and {counted(len(bonds), 'bond')}"
        + (f" with {counted(len(signals), 'node')} of signals" if signals else "")
        + f" to {goal}"
    ]
    for count, what, names in (
        (len(equations.states), "state", equations.states),
        (len(further), "state of laws and detectors", further),
        (len(equations.inputs), "input", equations.inputs),
        (len(equations.outputs), "output", equations.outputs),
        (len(dependent), "dependent storage", dependent),
    ):
        if count:
            many = what.replace("state", "states", 1) if "state of" in what else None
            lines.append(f"{counted(count, what, many)}: {listed(list(names))}")
    return tuple(lines)


def _rates_of(count: int) -> str:
    if not count:
        return "no equations: there is neither a state nor an output"
    return f"the {'rate' if count == 1 else 'rates'} of {counted(count, 'state')}"

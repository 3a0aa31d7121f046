"""`Step`, `Equation` and `Formula`: what a derivation consists of, as sympy that can be checked."""

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

import sympy as sp

from bondgraph.show.sums import Sum, Term, total

Topic = Literal[
    "causality", "storages", "laws", "junctions", "loops", "received", "resistances", "dependent",
    "balances", "inertia", "result", "whole", "signals",
]  # fmt: skip
"""What a step is about."""


@dataclass(frozen=True)
class Equation:
    """``side = side = ...``: two or more sides that are equal, each a sum in the order it is written in.

    ``node``: the node whose equation it is, if it is one node's; ``number`` counts through a derivation.
    """

    sides: tuple[Sum, ...]
    node: Hashable | None = None
    number: int = 0

    @property
    def left(self) -> sp.Expr:
        """The first side."""
        return total(self.sides[0])

    @property
    def right(self) -> sp.Expr:
        """The last side: what the equation comes to."""
        return total(self.sides[-1])

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All sides, each as one expression."""
        return tuple(map(total, self.sides))


@dataclass(frozen=True)
class Factor:
    """A matrix under its name: as text, and as LaTeX."""

    text: str
    latex: str
    matrix: sp.ImmutableSparseMatrix


@dataclass(frozen=True)
class Formula:
    """``left = sum of products``: a matrix made of others, each with its entries."""

    left: Factor
    products: tuple[tuple[Factor, ...], ...]
    number: int = 0

    @property
    def right(self) -> sp.Matrix:
        """The sum of the products, multiplied out."""
        result = sp.zeros(*self.left.matrix.shape)
        for product in self.products:
            value = sp.eye(self.left.matrix.rows)
            for factor in product:
                value = value * factor.matrix
            result += value
        return result


@dataclass(frozen=True)
class Step:
    """One step of a derivation: sentences, then equations, then formulas of matrices."""

    topic: Topic
    title: str
    sentences: tuple[str, ...] = ()
    equations: tuple[Equation, ...] = ()
    formulas: tuple[Formula, ...] = ()


def equation(*sides: Iterable[Term] | sp.Expr, node: Hashable | None = None) -> Equation:
    """An equation of these sides: sums, or expressions as they are; a side like the last is left out."""
    sums: list[Sum] = []
    for side in sides:
        terms = ((sp.Integer(1), side),) if isinstance(side, sp.Expr) else tuple(side)
        if not sums or total(sums[-1]) != total(terms):
            sums.append(terms)
    return Equation(tuple(sums), node)


def numbered(steps: Iterable[Step]) -> Iterator[Step]:
    """The steps that say something, equations that say nothing left out and the others counted."""
    count = 0
    for step in steps:
        equations = []
        for one in step.equations:
            if len(one.sides) > 1:
                count += 1
                equations.append(replace(one, number=count))
        formulas = []
        for formula in step.formulas:
            count += 1
            formulas.append(replace(formula, number=count))
        if equations or formulas or step.sentences:
            yield replace(step, equations=tuple(equations), formulas=tuple(formulas))

"""What a model does in time alone: expressions of time and parameters, told apart as inputs of their own.

A source ``A*sin(omega*t)**3``, a level, the term of a law that holds nothing but the time: as inputs they
are pieces between breakpoints, as a user's signals are, and nothing that they do is missed between two steps.
"""

from dataclasses import replace
from itertools import count

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law
from codegen.inputs.known import known
from codegen.program.closing import Closing

PREFIX = "known_"
"""What such an input is called, with a number; no result shows it."""


class Sources:
    """The expressions of time that were found so far, and the name of each."""

    def __init__(self, closing: Closing, parameters: set[str], taken: set[sp.Symbol]) -> None:
        symbols = {name for law in closing.laws.values() for name in law.free_symbols} | taken
        self._still = {name for name in symbols if name.name in parameters}
        names = {name.name for name in taken}
        self._fresh = (s for s in map(f"{PREFIX}{{}}".format, count(1)) if s not in names)
        self.found: dict[sp.Expr, sp.Symbol] = {}

    def told(self, closing: Closing) -> Closing:
        """The laws over these inputs, which come after all others."""
        laws = {name: self._law(law) for name, law in closing.laws.items()}
        return replace(closing, laws=laws, external=(*closing.external, *self.found.values()))

    def parted(self, expr: sp.Expr) -> sp.Expr:
        """An expression with inputs in place of the largest parts that hold the time alone."""
        if TIME not in expr.free_symbols:
            return expr
        if self._of_time(expr):
            return self._named(expr)
        if isinstance(expr, sp.Add | sp.Mul):
            moving = [argument for argument in expr.args if self._of_time(argument)]
            others = [argument for argument in expr.args if argument not in moving]
            rest = [self.parted(argument) for argument in others]
            return expr.func(*([self._named(expr.func(*moving))] if moving else []), *rest)
        return expr.func(*(self.parted(argument) for argument in expr.args))

    def _law(self, law: Law) -> Law:
        if isinstance(law, ExpressionLaw):
            return replace(law, expression=self.parted(law.expression))
        if isinstance(law, DryFriction):
            return DryFriction(*map(self.parted, (law.level, law.curve, law.breakaway)))
        return law

    def _of_time(self, expr: sp.Expr) -> bool:
        names = expr.free_symbols
        return TIME in names and names <= self._still | {TIME}

    def _named(self, expr: sp.Expr) -> sp.Expr:
        if isinstance(expr, sp.core.relational.Relational | sp.logic.boolalg.BooleanFunction):
            return self._named(sp.Piecewise((1, expr), (-1, True))) > 0
        if not known(expr):
            return expr
        if expr not in self.found:
            self.found[expr] = sp.Symbol(next(self._fresh))
        return self.found[expr]

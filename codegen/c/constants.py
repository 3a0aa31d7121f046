"""Expressions with whatever parameters determine taken out, to be computed once."""

from collections.abc import Sequence

import sympy as sp

from codegen.program.records import Block


def expanded(code: Block) -> list[sp.Expr]:
    """A block's results without temporaries."""
    known: dict[sp.Symbol, sp.Expr] = {}
    for name, value in code.assignments:
        known[name] = value.xreplace(known)
    return [result.xreplace(known) for result in code.results]


def needed(assignments: Sequence[tuple[sp.Symbol, sp.Expr]], results: Sequence[sp.Expr]) -> Block:
    """The assignments that results need, and what these need from outside."""
    used: set[sp.Symbol] = set().union(*(value.free_symbols for value in results))
    kept: list[tuple[sp.Symbol, sp.Expr]] = []
    for name, value in reversed(assignments):
        if name in used:
            used = (used - {name}) | value.free_symbols
            kept.append((name, value))
    return Block(tuple(sorted(used, key=str)), tuple(reversed(kept)), tuple(results))


class Constants:
    """Names for what parameters determine; ``names``: expression of parameters to its name."""

    def __init__(self, parameters: set[sp.Symbol], taken: set[str]) -> None:
        self._parameters, self._taken = parameters, taken
        self.names: dict[sp.Expr, sp.Symbol] = {}

    def new(self, wanted: str) -> sp.Symbol:
        """A symbol that nothing else has, called as wanted if that is free."""
        while wanted in self._taken:
            wanted += "_"
        self._taken.add(wanted)
        return sp.Symbol(wanted)

    def named(self, expr: sp.Expr) -> sp.Expr:
        """A name for what parameters determine."""
        if not expr.free_symbols:
            return expr
        if expr not in self.names:
            self.names[expr] = self.new(f"k{len(self.names)}")
        return self.names[expr]

    def hoisted(self, expr: sp.Basic) -> sp.Basic:
        """An expression with whatever parameters determine under a name of its own."""
        if not expr.free_symbols - self._parameters and isinstance(expr, sp.Expr):
            return self.named(expr)
        # Of pieces and conditions it is the sides that are named.
        if not expr.args:
            return expr
        if not isinstance(expr, (sp.Add, sp.Mul)):
            return expr.func(*(self.hoisted(part) for part in expr.args))
        fixed = [part for part in expr.args if not part.free_symbols - self._parameters]
        moving = [self.hoisted(part) for part in expr.args if part not in fixed]
        return expr.func(self.named(expr.func(*fixed)), *moving)

"""Where runs may leave tables that refuse what is outside: their arguments, as laws come to them."""

from collections.abc import Iterator
from typing import NamedTuple

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.inverses.guarding import never_given
from bondgraph.tables.record import Sampled
from codegen.program.gains import written_out
from codegen.program.records import Block, Program, block


class Refusal(NamedTuple):
    """A table, one of its axes, and the argument there."""

    table: Sampled
    axis: int
    argument: sp.Expr

    @property
    def ends(self) -> tuple[float, float]:
        """From where to where the table is."""
        points = self.table.axes[self.axis]
        return points[0], points[-1]

    @property
    def never(self) -> str:
        """What to say of a law that is turned round where it never gives this; nothing of other tables."""
        return never_given(self.table.name, *self.ends)


def refusals(program: Program) -> list[Refusal]:
    """Each of them once, in the order in which laws are evaluated; those inside an argument before it."""
    if not any(table.outside == "refuse" for table in program.tables):
        return []
    early, late = program.groups[: program.early], program.groups[program.early :]
    blocks = [program.known.values, program.coefficients, *(group.values for group in early)]
    blocks += [program.friction_values, program.coupled.values, program.guards]
    blocks += [group.values for group in late]
    found: dict[Refusal, None] = {}
    for expr in (expr for code in blocks for expr in written_out(code)):
        for look in _looks(expr):
            for axis, place in enumerate(look.places):
                found.setdefault(Refusal(look.handle.table, axis, place))
    return [one for one in found if one.table.outside == "refuse"]


def arguments(program: Program) -> Block:
    """What those arguments are, in their order."""
    own = {*program.parameters, *program.inputs, *program.readings, *program.external}
    return block([one.argument for one in refusals(program)], own)


def _looks(expr: sp.Expr) -> Iterator[Look]:
    found = sorted(expr.atoms(Look), key=sp.default_sort_key)
    return iter(sorted(found, key=lambda look: len(look.atoms(Look))))

"""Where laws switch: the expressions at whose zeros their slopes or values jump."""

from collections.abc import Iterator

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from bondgraph.algebra.whole import Floor
from codegen.corners.tabled import signs_of
from codegen.program.records import Block, Program

MOST_CHOICES = 4
"""The least or largest of more values is not looked into."""


def switching(program: Program) -> tuple[sp.Expr, ...]:
    """Arguments of Abs, sign and Heaviside, differences that Min, Max and conditions compare, and what
    changes its sign at corners of tables.

    Not those of parameters, of what is kept between events or of time alone, nor the slips of friction ports,
    which are events anyway.
    """
    return tuple(size for size in _sizes(program) if not _of_time(size, program))


def told_by_time(program: Program) -> tuple[sp.Expr, ...]:
    """What changes its sign by time alone, at given parameters: of those, and conditions of switches."""
    found: dict[sp.Expr, None] = {}
    conditions = [*_whole(program.guards)][: len(program.guards.results) - len(program.resets)]
    for size in (*_sizes(program), *conditions):
        if _of_time(size, program) and -size not in found:
            found.setdefault(size)
    return tuple(found)


def _of_time(size: sp.Expr, program: Program) -> bool:
    return TIME in size.free_symbols and size.free_symbols <= {TIME, *program.parameters}


def _sizes(program: Program) -> tuple[sp.Expr, ...]:
    slips = {program.readings[port.received] for port in program.friction}
    blocks = [program.known.values, *(group.values for group in program.groups)]
    blocks += [program.coupled.values, program.friction_values, program.coefficients]
    still = {*program.parameters, *program.equations.kept}
    found: dict[sp.Expr, None] = {}
    for code in blocks:
        for expr in _whole(code):
            for argument in _arguments(expr):
                size = sp.sympify(argument)
                constant = not size.free_symbols - still
                if not constant and size not in slips and -size not in slips:
                    found.setdefault(-size if -size in found else size)
    return tuple(sorted(found, key=sp.default_sort_key))


def _whole(code: Block) -> Iterator[sp.Expr]:
    """The results of a block without its temporaries."""
    values: dict[sp.Symbol, sp.Expr] = {}
    for name, value in code.assignments:
        values[name] = value.xreplace(values)
    return (result.xreplace(values) for result in code.results)


def _arguments(expr: sp.Expr) -> Iterator[sp.Expr]:
    for part in sorted(expr.atoms(sp.Abs, sp.sign, sp.Heaviside), key=sp.default_sort_key):
        yield part.args[0]
    for part in sorted(expr.atoms(Floor), key=sp.default_sort_key):
        yield part.size
    for part in sorted(expr.atoms(sp.Min, sp.Max), key=sp.default_sort_key):
        choices = sorted(part.args, key=sp.default_sort_key)
        if len(choices) <= MOST_CHOICES:
            for at, one in enumerate(choices):
                yield from (one - other for other in choices[at + 1 :])
    for part in sorted(expr.atoms(sp.core.relational.Relational), key=sp.default_sort_key):
        yield part.lhs - part.rhs
    for look in sorted(expr.atoms(Look), key=sp.default_sort_key):
        for axis in range(len(look.places)):
            yield from signs_of(look, axis)

"""Which sweeps can be done side by side, and which of their runs have numbers that need no exact look."""

from collections.abc import Iterable, Mapping

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.reduce.resistances import resistive_loops
from codegen.abreast.matrices import swept_in
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, Flags
from codegen.numbers.lambdified import lambdified
from codegen.program.records import Program
from codegen.tuning import TUNING


def fits(program: Program, equations: StateEquations, swept: frozenset[str]) -> bool:
    """Whether many runs of a program can be done side by side: affine, small, friction its only switching.

    What is decided exactly for one of them, loops and sources, must not depend on what is ``swept``.
    """
    plain = (
        program.affine and program.guards_affine and not program.varying and not program.switched
        and not program.joint and not program.late and not program.hanging and not program.sides
        and not program.sources and not equations.starts and not program.clocks and not program.delayed
    )  # fmt: skip
    simple = all(
        port.switch is None and port.moving is None and not port.jumps and not port.slides
        for port in program.friction
    )
    small = (len(program.readings) + program.size) * program.size**2 <= TUNING.products_beside
    if not (plain and simple and small) or any(group.loop for group in program.groups):
        return False
    return not any(swept_in(entry, swept) for entry in _looped(equations))


def suits(model: ClosedModel) -> bool:
    """The same of a model with numbers: no slip depends at once on friction."""
    return not any(model.coupled_directly(i) for i in range(len(model.switching)))


def _looped(equations: StateEquations) -> Iterable[sp.Expr]:
    """What is in loops of bonds and of resistances."""
    reduction = equations.reduction
    for rows in reduction.structure.loops:
        for row in rows:
            yield from row.values()
    for _, inside in resistive_loops(reduction):
        for row in inside:
            yield from row.values()


class Sound:
    """Tells which runs surely have no element whose value is zero or no number; others take an exact look."""

    def __init__(self, equations: StateEquations, swept: frozenset[str]) -> None:
        values = (e.value for e in equations.elements.values() if not e.kind.resists)
        told = dict.fromkeys(v for v in values if v is not None and swept_in(v, swept))
        self._sums = [_Sum(part) for value in told for part in _fraction(value)]

    def of(self, parameters: Mapping[str, float | Array], runs: int) -> Flags:
        """Which of so many runs; ``parameters``: a number, or one for each run."""
        found = np.ones(runs, dtype=bool)
        for one in self._sums:
            found &= one.surely(parameters)
        return found


class _Sum:
    """A sum of terms of parameters."""

    def __init__(self, expr: sp.Expr) -> None:
        self._names = sorted(name.name for name in expr.free_symbols)
        self._terms = lambdified(self._names, list(sp.Add.make_args(sp.expand(expr))))

    def surely(self, parameters: Mapping[str, float | Array]) -> Flags:
        """Whether it is far from zero beside its terms, and these are finite."""
        given = [np.asarray(parameters[name], dtype=float) for name in self._names]
        terms = [np.asarray(term, dtype=float) for term in self._terms(*given)]
        size = np.asarray(sum(map(np.abs, terms)))
        total = np.abs(np.asarray(sum(terms)))
        sure: Flags = np.isfinite(size) & (size > 0) & (total > TUNING.regular * size)
        return sure


def _fraction(value: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    top, bottom = sp.fraction(sp.together(sp.sympify(value)))
    return top, bottom


def even(times: Array) -> bool:
    """Whether samples lie at one distance."""
    lengths = np.diff(times)
    step = (times[-1] - times[0]) / len(lengths)
    return bool((np.abs(lengths - step) <= TUNING.alike * step).all())

"""Which sweeps can be done side by side, and which of their runs have numbers that need no exact look."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import sympy as sp

from bondgraph.declare.elements import Element
from bondgraph.equations import StateEquations
from bondgraph.reduce.resistances import resistive_loops
from codegen.abreast.matrices import swept_in
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified
from codegen.program.records import Program
from codegen.tuning import TUNING


def fits(program: Program, equations: StateEquations, swept: frozenset[str]) -> bool:
    """Whether many runs of a program can be done side by side: affine, friction its only switching.

    What is decided exactly for one of them, loops and sources, must not depend on what is ``swept``.
    """
    plain = (
        program.affine and program.guards_affine and not program.varying and not program.switched
        and not program.joint and not program.hanging and not program.sides and not program.sources
        and not equations.starts
    )  # fmt: skip
    simple = all(
        port.switch is None and port.moving is None and not port.jumps and not port.slides
        for port in program.friction
    )
    if not plain or not simple or any(group.loop for group in program.groups):
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
    for _, rows in resistive_loops(reduction):
        for row in rows:
            yield from row.values()


def sound(
    equations: StateEquations, parameters: Mapping[str, float | Array], swept: frozenset[str],
    runs: int,
) -> Array:  # fmt: skip
    """Which runs surely have no element whose value is zero or no number; of the others an exact look tells."""
    found = np.ones(runs, dtype=bool)
    for element in equations.elements.values():
        if element.value is None or element.kind.resists or not swept_in(element.value, swept):
            continue
        found &= _surely(element, parameters)
    return found


def _surely(element: Element, parameters: Mapping[str, float | Array]) -> Array:
    """Whether its value is far from zero beside the terms that make it up, and finite."""
    expr = sp.sympify(element.value)
    names = sorted(name.name for name in expr.free_symbols)
    given = [np.asarray(parameters[name], dtype=float) for name in names]
    terms = sp.Add.make_args(sp.expand(sp.together(expr).as_numer_denom()[0]))
    bottom = sp.Add.make_args(sp.expand(sp.together(expr).as_numer_denom()[1]))
    sure: Array = np.ones((), dtype=bool)
    for parts in (terms, bottom):
        values = [np.asarray(lambdified(names, part)(*given), dtype=float) for part in parts]
        size = np.asarray(sum(abs(value) for value in values))
        total = np.abs(np.asarray(sum(values)))
        sure = sure & np.isfinite(size) & (size > 0) & (total > TUNING.regular * size)
    return sure


def even(times: Sequence[float] | Array) -> bool:
    """Whether samples lie at one distance."""
    lengths = np.diff(times)
    step = (times[-1] - times[0]) / len(lengths)
    return bool((np.abs(lengths - step) <= TUNING.alike * step).all())

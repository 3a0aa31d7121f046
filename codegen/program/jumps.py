"""Laws that jump: the sign of what a jump hangs on, as dry friction of level 1 that stands by itself.

``sign(v - w)`` is 1 on one side and -1 on the other; a motion that is pushed back from both sides slides
along ``v = w``, by that mixture of both which keeps it there (Filippov, Differential Equations with
Discontinuous Righthand Sides, section 4). That is what friction of level 1 does whose slip is ``v - w``: it
gives 1 or -1, or holds its slip at zero by what that takes in between. So a jump is one more port: it gives
its mixture, an input with the columns of what the law gives, and receives what it hangs on.

A jump that moves no first rate of what it hangs on, but the second (``x'' = -2 sign(x) - sign(x')``), is of
second order: it can hold that rate, and rests where both are zero (sliding of second order: Levant,
International Journal of Control 58, 1993, section 3). It receives the rate, and its sign is of what it
hangs on.
"""

from collections.abc import Container, Hashable, Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.analyse.degrees import Degrees
from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port
from codegen.program.sliding import row_of, told_of, unused
from codegen.program.thresholds import taken_apart
from codegen.program.widened import spread, widened


@dataclass(frozen=True)
class Jump:
    """``mixture``: the input from -1 to 1 that it gives; ``depends``: the reading that it is the sign of.

    ``offset``: the input that is what no sum of signals makes up of that, and ``law`` gives it.
    ``hangs``: of one of second order what it is the sign of, of which ``depends`` is the rate; else None.
    """

    node: Hashable
    mixture: sp.Symbol
    depends: sp.Symbol
    offset: sp.Symbol
    law: sp.Expr
    hangs: sp.Expr | None = None


@dataclass(frozen=True)
class Smooth:
    """A port whose law jumps: the input that is the rest of what it gives, and the law of that."""

    port: Port
    given: sp.Symbol
    law: ExpressionLaw


def jumps_of(
    equations: StateEquations, laws: Mapping[Hashable, Law], still: Iterable[str]
) -> tuple[StateEquations, tuple[Jump, ...], tuple[Smooth, ...]]:
    """Equations over what jumps give; what laws with jumps give are readings then.

    ``still``: the names of parameters. A law whose jump has a factor that moves, or hangs on time and inputs
    alone, stays as it is.
    """
    still = set(still)
    steps = _Steps(equations, still)
    found: dict[Port, tuple[sp.Expr, dict[sp.Expr, sp.Expr]]] = {}
    driven = _driving(equations)
    for port in equations.ports:
        law = laws.get(port.element.name)
        if not isinstance(law, ExpressionLaw) or law.state is not None or port.given in driven:
            continue
        rest, factors = steps.parted(law.expression)
        if factors:
            found[port] = rest, factors
    if not found:
        return equations, (), ()
    abrupt = {port.element.name for port in found}
    abrupt |= {name for name, law in laws.items() if isinstance(law, DryFriction)}
    return _with_jumps(equations, found, Degrees(equations, still, laws, abrupt))


def _driving(equations: StateEquations) -> set[sp.Symbol]:
    """The inputs whose rates count: they may not jump by themselves."""
    columns = {j for row in equations.readings.values() for j in row.K}
    columns |= {j for _, j in equations.E.todok()}
    return {equations.inputs[j] for j in columns}


class _Steps:
    """Which parts of laws jump, by what they hang on."""

    def __init__(self, equations: StateEquations, still: set[str]) -> None:
        self._equations, self._still = equations, still
        outer = set(equations.inputs) - {port.given for port in equations.ports}
        moving = {*equations.signals, *equations.states, *equations.integrals}
        self._moving = moving - outer - equations.kept

    def parted(self, law: sp.Expr) -> tuple[sp.Expr, dict[sp.Expr, sp.Expr]]:
        """A law without its jumps, and half of each jump by what it hangs on."""
        marks: dict[sp.Expr, sp.Dummy] = {}
        marked = law.replace(
            lambda part: isinstance(part, sp.sign | sp.Piecewise),
            lambda part: self._marked(part, marks),
        )
        if not marks:
            return law, {}
        marked = sp.expand(marked)
        factors = {argument: marked.coeff(mark) for argument, mark in marks.items()}
        rest = marked.xreplace(dict.fromkeys(marks.values(), sp.Integer(0)))
        whole = rest + sp.Add(*(factors[argument] * mark for argument, mark in marks.items()))
        if sp.expand(marked - whole) != 0 or any(self._changes(f) for f in factors.values()):
            return law, {}
        return rest, {argument: f for argument, f in factors.items() if f != 0}

    def _marked(self, part: sp.Expr, marks: dict[sp.Expr, sp.Dummy]) -> sp.Expr:
        whole, jumps = taken_apart(part)
        if not jumps or not jumps[0][0].free_symbols & self._moving:
            return part
        for argument, half in jumps:
            key, turned = _known(argument, marks)
            whole += turned * half * marks.setdefault(key, sp.Dummy())
        return whole

    def _changes(self, factor: sp.Expr) -> bool:
        return any(name.name not in self._still for name in factor.free_symbols)


def _with_jumps(
    equations: StateEquations,
    found: Mapping[Port, tuple[sp.Expr, Mapping[sp.Expr, sp.Expr]]],
    degrees: Degrees,
) -> tuple[StateEquations, tuple[Jump, ...], tuple[Smooth, ...]]:
    """The equations with an input for each jump and each offset, and smooth laws in place of the others."""
    arguments, owners = dict[sp.Expr, dict[int, sp.Expr]](), dict[sp.Expr, Hashable]()
    for port, (_, factors) in found.items():
        for argument, factor in factors.items():
            key, turned = _known(argument, arguments)
            columns = arguments.setdefault(key, {})
            columns[equations.inputs.index(port.given)] = turned * factor
            owners.setdefault(key, port.element.name)
    taken = {*equations.signals, *equations.inputs, *equations.readings, *equations.parameters}
    taken |= {*equations.integrals, TIME}
    told = {argument: told_of(equations, argument) for argument in arguments}
    named = {name for parts, _ in told.values() for name in parts}
    equations = equations.with_readings(named)
    rows = {
        argument: _sum((row_of(equations, name), factor) for name, factor in parts.items())
        for argument, (parts, _) in told.items()
    }
    rates = {
        argument: rate
        for argument, columns in arguments.items()
        if (rate := degrees.rate(rows[argument], told[argument][1])) is not None
        and degrees.moves(rate, columns)
    }
    smooth = tuple(
        Smooth(port, unused(f"smooth_{port.given}", taken), ExpressionLaw(rest))
        for port, (rest, _) in found.items()
    )
    jumps = tuple(
        Jump(owners[argument], unused(f"jump_{at}", taken), unused(f"hangs_{at}", taken),
             unused(f"offset_{at}", taken), *_of(argument, told[argument][1], rates))
        for at, argument in enumerate(arguments, 1)
    )  # fmt: skip
    rows |= rates
    return (
        _widened(equations, tuple(arguments.values()), [*rows.values()], jumps, smooth),
        jumps,
        smooth,
    )


def _of(
    argument: sp.Expr, rest: sp.Expr, rates: Container[sp.Expr]
) -> tuple[sp.Expr, sp.Expr | None]:
    """What its row lacks of what a jump receives; and of one of second order what it hangs on."""
    return (sp.Integer(0), argument) if argument in rates else (rest, None)


def _known(argument: sp.Expr, arguments: Iterable[sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """What is the same but for a factor, and which way that turns."""
    for known in arguments:
        ratio = sp.cancel(argument / known)
        if ratio.is_number and ratio.is_finite and ratio != 0:
            return known, sp.sign(ratio)
    return argument, sp.Integer(1)


def _widened(
    equations: StateEquations, columns: tuple[Mapping[int, sp.Expr], ...],
    told: Iterable[Reading], jumps: tuple[Jump, ...], smooth: tuple[Smooth, ...],
) -> StateEquations:  # fmt: skip
    count = len(equations.inputs)
    renamed = {one.port.given: one.given for one in smooth}
    inputs = tuple(renamed.get(name, name) for name in equations.inputs)
    inputs += tuple(name for jump in jumps for name in (jump.mixture, jump.offset))
    copies = {count + 2 * at: own for at, own in enumerate(columns)}
    rows = {name: spread(row, copies) for name, row in equations.readings.items()}
    for each in smooth:
        own = {equations.inputs.index(each.port.given): sp.Integer(1)}
        rows[each.port.given] = spread(Reading({}, own, {}, {}), copies)
    one = sp.Integer(1)
    for at, (jump, row) in enumerate(zip(jumps, told, strict=True)):
        # Without one the slips of two jumps of one signal are the same.
        offset = Reading({}, {} if jump.law == 0 else {count + 2 * at + 1: one}, {}, {})
        rows[jump.depends] = _sum([(offset, one), (spread(row, copies), one)])
    return widened(equations, inputs, copies, rows)


def _sum(parts: Iterable[tuple[Reading, sp.Expr]]) -> Reading:
    total = ReadingSum()
    for row, factor in parts:
        total.add(row, factor)
    return total.whole()

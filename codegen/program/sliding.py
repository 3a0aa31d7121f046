"""Dry friction that gives a flow (a slider directly on a spring) as two one-sided ports.

It receives an effort e and slips by ``u = u_1 + u_2``: forwards ``u_1 >= 0``, which holds ``e - level``
at zero, or backwards ``u_2 <= 0``, which holds ``e + level`` there. Let go, both give nothing, and it sticks:
``-level <= e <= level``. So a slider is two ports of the kind of a diode, with the columns of its own.
"""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import DryFriction, Law, slides
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port
from codegen.program.widened import spread, widened


@dataclass(frozen=True)
class Half:
    """One way of slipping: the flow that it gives, what it receives, 1 forwards or -1 backwards."""

    given: sp.Symbol
    received: sp.Symbol
    way: int


@dataclass(frozen=True)
class Slider:
    """``level``: the input that is its level, as far as that is no sum of signals; ``law`` gives it.

    ``whole``: the level with those signals.
    """

    port: Port
    halves: tuple[Half, Half]
    level: sp.Symbol
    law: sp.Expr
    whole: sp.Expr

    @property
    def name(self) -> Hashable:
        """The node."""
        return self.port.element.name


def sliders_of(
    equations: StateEquations, laws: Mapping[Hashable, Law]
) -> tuple[StateEquations, tuple[Slider, ...]]:
    """Equations over what sliders' halves give instead of their slips, which are readings then."""
    found: list[Slider] = []
    for port in equations.ports:
        law = laws.get(port.element.name)
        if slides(law, port.gives):
            equations, slider = _halved(equations, port, law)
            found.append(slider)
    return equations, tuple(found)


def _halved(
    equations: StateEquations, port: Port, law: DryFriction
) -> tuple[StateEquations, Slider]:
    own, count = equations.inputs.index(port.given), len(equations.inputs)
    taken = {*equations.signals, *equations.inputs, *equations.readings, *equations.parameters}
    names = [
        f"{way}_{of}" for of in (port.given, port.received) for way in ("forwards", "backwards")
    ]
    a, b, over, under = (unused(name, taken) for name in names)
    level = unused(f"level_{port.received}", taken)
    told, rest = told_of(equations, law.level * law.curve)
    equations = equations.with_readings({*told, port.received})
    inputs = (*equations.inputs[:own], a, *equations.inputs[own + 1 :], b, level)
    copies = {count: {own: sp.Integer(1)}}
    readings = {name: spread(row, copies) for name, row in equations.readings.items()}
    readings[port.given] = Reading({}, {own: sp.Integer(1), count: sp.Integer(1)}, {}, {})
    for name, sign in ((over, -1), (under, 1)):
        total = ReadingSum(readings[port.received])
        total.add(Reading({}, {count + 1: sp.Integer(1)}, {}, {}), sp.Integer(sign))
        for signal, factor in told.items():
            total.add(spread(row_of(equations, signal), copies), sign * factor)
        readings[name] = total.whole()
    halves = Half(a, over, 1), Half(b, under, -1)
    return widened(equations, inputs, copies, readings), Slider(
        port, halves, level, rest, law.level * law.curve
    )


def row_of(equations: StateEquations, name: sp.Symbol) -> Reading:
    """A signal over states and inputs."""
    one = sp.Integer(1)
    if name in equations.states:
        return Reading({equations.states.index(name): one}, {}, {}, {})
    if name in equations.inputs:
        return Reading({}, {equations.inputs.index(name): one}, {}, {})
    return equations.readings[name]


def told_of(equations: StateEquations, level: sp.Expr) -> tuple[dict[sp.Symbol, sp.Expr], sp.Expr]:
    """What an expression has of each signal, constant factors, and what is left of it."""
    signals = {*equations.signals, *equations.states}
    found: dict[sp.Symbol, sp.Expr] = {}
    left = sp.expand(level)
    for name in sorted(left.free_symbols & signals, key=str):
        factor = slope_of(left, name)
        if not factor.free_symbols & signals:
            found[name] = factor
            left = sp.expand(left - factor * name)
    return found, left


def unused(name: str, taken: set[sp.Symbol]) -> sp.Symbol:
    """A symbol of this name, or a longer one, that nothing else has; it is taken then."""
    symbol = sp.Symbol(name)
    while symbol in taken:
        symbol = sp.Symbol(f"{symbol}_")
    taken.add(symbol)
    return symbol


def halves_of(sliders: Iterable[Slider]) -> dict[sp.Symbol, Half]:
    """Each half of these by what it gives."""
    return {half.given: half for slider in sliders for half in slider.halves}

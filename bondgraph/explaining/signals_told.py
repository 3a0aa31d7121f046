"""Nodes of signals told as what they are, functions, states and controllers, not as what they are made of."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import replace

from bondgraph.equations import StateEquations
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.show.sums import rate, signed_terms
from bondgraph.show.ways import going, switching, working


def signals_step(equations: StateEquations) -> Step:
    """What functions and states come to; what controllers set at their instants, and where states stay."""
    elements = equations.reduction.structure.elements
    kept = {name for task in equations.tasks for name in task.states} | equations.kept
    lines = [
        line
        for element in elements.values()
        if element.of_signals and element.integral not in kept
        for line in _lines(element, elements)
    ]
    sentences = [working(task) for task in equations.tasks]
    sentences += [going(one, equations.switches) for one in equations.machines]
    sentences += [switching(one) for one in equations.plain_switches if one.port.element.of_signals]
    return Step("signals", "Signals, which carry no power", tuple(sentences), tuple(lines))


def _lines(element: Element, elements: Mapping[Hashable, Element]) -> Iterator[Equation]:
    """A law's value by its name; the rate of what is integrated, by the name that its value has."""
    if isinstance(element.law, ExpressionLaw) and element.given is not None:
        yield equation(element.given, signed_terms(element.law.expression), node=element.name)
    if element.integral is not None:
        first = elements[element.whole]
        value = first.given if first.kind.supplies else element.received
        yield equation(rate(element.integral), value, node=element.whole)


def without_signals(step: Step, elements: Mapping[Hashable, Element]) -> Step:
    """A step without the equations of the ports that nodes of signals are made of."""
    own = {name for name, element in elements.items() if element.of_signals}
    return replace(step, equations=tuple(one for one in step.equations if one.node not in own))

"""Nodes of signals told as what they are, functions, states and controllers, not as what they are made of."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import replace

from bondgraph.equations import StateEquations
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.show.signal_nodes import SignalNode, signal_nodes
from bondgraph.show.sums import rate, signed_terms
from bondgraph.show.ways import going, lagging, switching, working


def signals_step(equations: StateEquations) -> Step:
    """What functions and states come to, what has several ways, what controllers set at which instants."""
    nodes = {node.name: node for node in signal_nodes(equations)}
    kept = {name for task in equations.tasks for name in task.states} | equations.kept
    lines = [
        line
        for element in equations.elements.values()
        if element.of_signals and element.integral not in kept
        for line in _lines(element, equations.elements, nodes.get(element.whole))
    ]
    ruled = [node.ruled for node in nodes.values() if node.ruled is not None]
    sentences = [f"{one.left} = {one.text()}" for one in ruled]
    sentences += [working(task) for task in equations.tasks]
    sentences += [
        switching(one)
        for one in equations.plain_switches
        if one.port.element.of_signals and one.port.element.whole not in nodes
    ]
    sentences += [going(one, equations.switches) for one in equations.machines]
    sentences += map(lagging, equations.delays)
    return Step("signals", "Signals, which carry no power", tuple(sentences), tuple(lines))


def _lines(
    element: Element, elements: Mapping[Hashable, Element], node: SignalNode | None
) -> Iterator[Equation]:
    """What a function is; the rate of a state, or what it is called where bounds rule it."""
    law = element.law if element.given is not None else None
    if node is not None:
        if node.rate is not None and element.integral is not None:
            yield equation(rate(element.integral), signed_terms(node.rate), node=node.name)
        if element.given == node.stated and isinstance(law, ExpressionLaw):
            yield equation(element.given, signed_terms(law.expression), node=node.name)
        return
    if isinstance(law, ExpressionLaw):
        yield equation(element.given, signed_terms(law.expression), node=element.name)
    if element.integral is not None:
        first = elements[element.whole]
        value = first.given if first.kind.supplies else element.received
        yield equation(rate(element.integral), value, node=element.whole)


def without_signals(step: Step, elements: Mapping[Hashable, Element]) -> Step:
    """A step without the equations of the ports that nodes of signals are made of."""
    own = {name for name, element in elements.items() if element.of_signals}
    return replace(step, equations=tuple(one for one in step.equations if one.node not in own))

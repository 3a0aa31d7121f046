"""The equations that a bond graph states node by node: storages, laws, junctions and two-ports."""

from collections.abc import Hashable, Sequence

import sympy as sp

from bondgraph.causality.assignments import Assignment
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations
from bondgraph.declare.elements import OTHER, Reset
from bondgraph.declare.laws import DryFriction, ExpressionLaw
from bondgraph.equations import StateEquations
from bondgraph.explaining.momenta import Momenta
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.reduce.sorting import Reduction, detects
from bondgraph.reduce.structure import Port
from bondgraph.reduce.switch_port import SwitchPort
from bondgraph.show.sums import plain, rate, split


def storages_step(reduction: Reduction, momenta: Momenta) -> Step:
    """Every storage's law as a rate: ``I f' = e``, ``C e' = f``; of a moving value by its momentum."""
    lines: list[Equation] = []
    one = sp.Integer(1)
    for at in sorted((*reduction.states, *reduction.dependent)):
        port = reduction.structure.ports[at]
        effect = port.element.variable(OTHER[port.element.kind.gives])
        name, stored = port.element.name, momenta.stored[at]
        if at in momenta.symbols:
            symbol = momenta.symbols[at]
            lines.append(equation(symbol, stored, node=name))
            if reduction.driving(at) == reduction.structure.rows[at]:
                lines.append(equation(rate(symbol), effect, node=name))
        else:
            ((value, variable),) = stored
            lines.append(equation([(value, rate(variable))], effect, node=name))
    for port in reduction.structure.ports:
        if port.own_state is not None:
            lines.append(
                equation(rate(port.own_state), [(one, port.received)], node=port.element.name)
            )
    return Step("storages", "Storages", (), tuple(lines))


def laws_step(equations: StateEquations, signals: Sequence[Assignment]) -> Step:
    """Linear resistances, detectors, and the laws and switches that close ports."""
    known = {line.symbol for line in signals}
    lines = [
        equation(line.symbol, split(line.right, known), node=line.node)
        for line in signals
        if line.kind == "law"
    ]
    for port in equations.reduction.structure.ports:
        if detects(port):
            lines.append(equation(port.given, sp.Integer(0), node=port.element.name))
    sentences = []
    for port in equations.ports:
        law = port.element.law
        if isinstance(law, ExpressionLaw):
            lines.append(equation(port.given, law.expression, node=port.element.name))
        elif isinstance(law, DryFriction):
            sentences.append(f"{port.element.name}: dry friction, {_rubbing(port, law)}")
    sentences += map(_switch, equations.switches)
    return Step("laws", _title_of_laws(equations), tuple(sentences), tuple(lines))


def _rubbing(port: Port, law: DryFriction) -> str:
    """What dry friction does, by what it gives."""
    if port.gives == "flow":
        level = law.level * law.curve
        return (
            f"{port.given} = 0 while {port.received} stays within {level} either way; slipping it keeps "
            f"{port.received} there"
        )
    return (
        f"{port.given} opposes the slip {port.received} with at most {law.level} times its curve "
        f"{law.curve}"
    )


def _title_of_laws(equations: StateEquations) -> str:
    kinds = (("laws", equations.laws), ("switches", equations.switches))
    what = [word for word, there in kinds if there]
    if not what:
        return "Resistances and detectors"
    listed = ", ".join(["Resistances", "detectors", *what[:-1]])
    return (
        f"{listed} and {what[-1]}; what {' and '.join(what)} give stays an input of the equations"
    )


def _switch(one: SwitchPort) -> str:
    """Both ways of a switch: what it gives, what it keeps at zero, and what changes it over."""
    given, received = one.port.given, one.port.received
    free = f"it gives {given} = 0"
    holds = f"it keeps {received} = 0 by what {given} that takes"
    on, off = (holds, free) if one.held == "on" else (free, holds)
    what = "an ideal switch" if one.gap is None else "a stop"
    text = (
        f"{one.name}: {what}; on, {on}, and turns off as {plain(one.off)} rises above zero; "
        f"off, {off}, and turns on as {plain(one.on)} rises above zero"
    )
    text += "".join(map(_reset, one.switch.resets))
    if not one.side:
        return text
    least, most = ("negative", "positive") if one.side > 0 else ("positive", "negative")
    if one.gap is not None:
        return f"{text}; {_bound(one)}"
    return f"{text}; so {received} is never {least} and {given} never {most}"


def _reset(one: Reset) -> str:
    """What a state becomes."""
    when = "at each impact" if one.event == "hit" else f"as it turns {one.event}"
    return f"; {when} {one.state} becomes {plain(one.value)}"


def _bound(one: SwitchPort) -> str:
    """What a stop sees to."""
    pushes = one.side if one.gives == "effort" else -one.side
    never = "positive" if pushes > 0 else "negative"
    text = f"so {plain(one.gap)} is never negative and {one.port.element.effort} never {never}"
    bounce = one.switch.restitution
    if not bounce:
        return text
    return f"{text}, and what meets it is thrown back with {plain(bounce)} times its speed"


def junctions_step(
    strokes: Strokes, causal: CausalEquations, signals: Sequence[Assignment], reduction: Reduction
) -> Step:
    """Junctions and two-ports in causal order; what a junction hands on in one line."""
    lines: list[Equation] = []
    known = {line.symbol for line in signals}
    handed: dict[tuple[Hashable, sp.Expr], list[sp.Symbol]] = {}
    for line in signals:
        if line.kind == "transfer":
            handed.setdefault((line.node, line.right), []).append(line.symbol)
    for line in signals:
        if line.kind == "balance":
            lines.append(equation(line.symbol, split(line.right, known), node=line.node))
        elif line.kind == "transfer" and (names := handed.pop((line.node, line.right), None)):
            lines.append(equation(*names, split(line.right, known), node=line.node))
    title = "Junctions, transformers and gyrators, in causal order"
    given, received = _other_names(strokes, causal, signals, reduction)
    return Step("junctions", title, (), (*given, *lines, *received))


def _other_names(
    strokes: Strokes, causal: CausalEquations, signals: Sequence[Assignment], reduction: Reduction
) -> tuple[list[Equation], list[Equation]]:
    """What ports give and receive, where a bond has it under another name or with the other sign."""
    symbols = {(line.bond, line.variable): line.symbol for line in signals}
    known = set(symbols.values())
    ports = {port.element.name: port for port in reduction.structure.ports}

    def bonds(signal: int) -> sp.Symbol:
        return symbols[strokes.declared[signal // 2], "flow" if signal % 2 else "effort"]

    given, received = [], []
    for signal, (node, sign) in causal.given.items():
        name = strokes.names[node]
        own = [(sp.Integer(sign), ports[name].given)]
        given.append(equation(bonds(signal), own, node=name))
    for node, (signal, sign) in causal.received.items():
        name = strokes.names[node]
        if ports[name].received not in known:
            known.add(ports[name].received)
            own = [(sp.Integer(sign), bonds(signal))]
            received.append(equation(ports[name].received, own, node=name))
    return given, received

"""The equations that a bond graph states node by node: storages, laws, junctions and two-ports."""

from collections.abc import Hashable, Sequence

import sympy as sp

from bondgraph.causality.assignments import Assignment
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import CausalEquations
from bondgraph.equations import StateEquations
from bondgraph.explaining.momenta import Momenta
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.nodes.elements import OTHER
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.reduce.sorting import Reduction, detects
from bondgraph.show.sums import rate, signed_terms, split
from bondgraph.show.ways import rubbing, switching


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
            right = signed_terms(law.expression)
            lines.append(equation(port.given, right, node=port.element.name))
        elif isinstance(law, DryFriction):
            sentences.append(rubbing(port, law))
    switches = [one for one in equations.switches if not one.port.element.of_signals]
    sentences += map(switching, switches)
    return Step("laws", _title_of_laws(equations), tuple(sentences), tuple(lines))


def _title_of_laws(equations: StateEquations) -> str:
    laws = [port for port in equations.ports if port.element.law is not None]
    kinds = (
        ("laws", [port for port in laws if not port.element.of_signals]),
        ("switches", [one for one in equations.switches if not one.port.element.of_signals]),
    )
    what = [word for word, there in kinds if there]
    if not what:
        return "Resistances and detectors"
    listed = ", ".join(["Resistances", "detectors", *what[:-1]])
    return (
        f"{listed} and {what[-1]}; what {' and '.join(what)} give stays an input of the equations"
    )


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

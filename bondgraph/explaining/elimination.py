"""What ports receive, with loops of bonds and resistances solved: every signal over states and inputs."""

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.exact import combined
from bondgraph.algebra.tidy import tidy
from bondgraph.causality.assignments import Assignment
from bondgraph.causality.signals import CausalEquations, causal_groups
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.reduce.record import Reading
from bondgraph.reduce.resistances import ResistiveGroup, resistive_groups
from bondgraph.reduce.sorting import Reduction, detects
from bondgraph.show.statements import reading_sum
from bondgraph.show.sums import Term

LARGEST_TIDIED = 100
"""Entries of graphs with more ports are shown as they were derived."""


def reading_terms(reduction: Reduction, reading: Reading) -> list[Term]:
    """A reading as a sum over states, inputs and their rates, entries as a person would write them."""
    terms = reading_sum(reduction.names, reduction.inputs, reading)
    return [(_tidied(reduction, entry), signal) for entry, signal in terms]


def row_terms(reduction: Reduction, row: Mapping[int, sp.Expr]) -> list[Term]:
    """A row over what the ports give, as a sum; detectors give nothing and are left out."""
    ports = reduction.structure.ports
    shown = (at for at in sorted(row) if not detects(ports[at]))
    return [(_tidied(reduction, row[at]), ports[at].given) for at in shown]


def _tidied(reduction: Reduction, entry: sp.Expr) -> sp.Expr:
    return tidy(entry) if len(reduction.structure.ports) <= LARGEST_TIDIED else entry


def loops_step(
    reduction: Reduction, causal: CausalEquations, signals: Sequence[Assignment]
) -> Step:
    """Signals of bonds that follow from one another by ratios alone, solved together."""
    found = {(line.bond, line.variable): line for line in signals}
    declared = [*reduction.structure.bonds]
    lines: list[Equation] = []
    sentences = []
    for group in causal_groups(causal.terms):
        if len(group) == 1:
            continue
        members = [found[declared[s // 2], "flow" if s % 2 else "effort"] for s in group]
        sentences.append(f"one loop: {', '.join(str(line.symbol) for line in members)}")
        for line in members:
            row = reduction.structure.bonds[line.bond][line.variable == "flow"]
            lines.append(equation(line.symbol, row_terms(reduction, row), node=line.node))
    title = "Loops of bonds, each solved for its signals"
    return Step("loops", title, tuple(sentences), tuple(lines))


def received_step(
    reduction: Reduction, shown: Iterable[tuple[sp.Symbol, Mapping[int, sp.Expr]]]
) -> Step:
    """``w = S z``: what every port receives from what all ports give, and the outputs."""
    structure = reduction.structure
    lines: dict[tuple[sp.Expr, sp.Expr], Equation] = {}
    pairs = [
        (port.received, row, port.element.name)
        for port, row in zip(structure.ports, structure.rows, strict=True)
    ]
    for symbol, row, node in [*pairs, *((symbol, row, None) for symbol, row in shown)]:
        line = equation(symbol, row_terms(reduction, row), node=node)
        lines.setdefault((line.left, line.right), line)
    title = "Put into one another: what every port receives from what the ports give"
    return Step("received", title, (), tuple(lines.values()))


def resistances_step(reduction: Reduction) -> Step:
    """What linear resistances give, over states and inputs; those that see one another solved together."""
    lines: list[Equation] = []
    sentences = []
    for group in resistive_groups(reduction):
        if group.is_loop:
            sentences.append(f"{_names(reduction, group)} see one another: solved together")
        for port, law in zip(group.ports, group.laws, strict=True):
            one = reduction.structure.ports[port]
            rows = ((reduction.structure.rows[group.ports[at]], law[at]) for at in sorted(law))
            seen = row_terms(reduction, combined(rows))
            solved = reading_terms(reduction, reduction.columns[port])
            lines.append(equation(one.given, seen, solved, node=one.element.name))
    title = "Resistances: what they give, over states and inputs"
    return Step("resistances", title, tuple(sentences), tuple(lines))


def _names(reduction: Reduction, group: ResistiveGroup) -> str:
    return ", ".join(str(reduction.structure.ports[i].element.name) for i in group.ports)

"""`explain`: how a bond graph becomes ``A x' = J x + B u + E u'``, step by step."""

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from bondgraph.causality.assign import assign_causality
from bondgraph.causality.assignments import assignments
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.signals import causal_equations
from bondgraph.derive import state_equations
from bondgraph.equations import StateEquations
from bondgraph.explaining.dependence import balances_step, dependent_step
from bondgraph.explaining.elimination import loops_step, received_step, resistances_step
from bondgraph.explaining.inertias import inertia_step
from bondgraph.explaining.layout import MOST_LINES
from bondgraph.explaining.momenta import momenta
from bondgraph.explaining.primitives import junctions_step, laws_step, storages_step
from bondgraph.explaining.records import Step, numbered
from bondgraph.explaining.signals_told import signals_step, without_signals
from bondgraph.explaining.strokes_told import causality_step
from bondgraph.explaining.text import text_of
from bondgraph.explaining.typesetting import latex_of, markdown_of
from bondgraph.explaining.whole import whole_steps
from bondgraph.reduce.junction import junction_structure
from bondgraph.reduce.opened import opened


@dataclass(frozen=True)
class Explanation:
    """A derivation: its steps in order, and the equations it ends with.

    Shown as text by ``print``, as formulas in a notebook. A step of more than ``limit`` lines shows its
    first few; ``limit=None`` shows everything.
    """

    steps: tuple[Step, ...]
    result: StateEquations

    def text(self, limit: int | None = MOST_LINES) -> str:
        """Aligned text for a terminal."""
        return text_of(self.steps, self.result, limit)

    def latex(self, limit: int | None = MOST_LINES) -> str:
        """The body of a LaTeX document: paragraphs and ``align*`` environments of amsmath."""
        return latex_of(self.steps, self.result, limit)

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        count = sum(len(step.equations) + len(step.formulas) for step in self.steps)
        return f"<Explanation: {len(self.steps)} steps, {count} equations>"

    def _repr_markdown_(self) -> str:
        return markdown_of(self.steps, self.result, MOST_LINES)


def explain(
    graph: Any, outputs: Iterable[Hashable] | None = None, inputs: Iterable[str] = ()
) -> Explanation:
    """The derivation of a declared or causal graph, as the engine decided it.

    Who imposes what; what functions, states and controllers make of signals; storages, laws and junctions
    as equations, switches in both of their ways; what
    every port receives, loops and resistances solved; dependent storages differentiated and put in; A,
    and the result. ``outputs`` and ``inputs`` as for `derive`, whose errors it raises.

    Raises what `derive` raises.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> g.add_edges_from([("u", "loop"), ("loop", "L"), ("loop", "R")])
    >>> explanation = explain(g)
    >>> explanation.steps[-1].equations[0].left, explanation.steps[-1].equations[0].right
    (L*i', -R*i + u)
    """
    causal = graph if isinstance(graph, CausalGraph) else assign_causality(graph)
    result = state_equations(opened(junction_structure(causal), inputs), outputs)
    return Explanation(tuple(numbered(_steps(causal, result))), result)


def _steps(causal: CausalGraph, result: StateEquations) -> Iterator[Step]:
    reduction, strokes, signals = result.reduction, causal.assignment, assignments(causal)
    taken = {*(line.symbol for line in signals), *result.signals, *result.parameters}
    for part in (*result.laws.values(), *(c for one in result.switches for c in one.read)):
        taken |= part.free_symbols
    held = momenta(reduction, taken)
    shown = [(name, result.signals[name]) for name in result.outputs]
    powers = (
        storages_step(reduction, held),
        laws_step(result, signals),
        junctions_step(strokes, causal_equations(strokes), signals, reduction),
        loops_step(reduction, causal_equations(strokes), signals),
        received_step(reduction, shown),
        resistances_step(reduction),
    )
    yield causality_step(causal, signals, reduction)
    yield signals_step(result)
    for step in powers:
        yield without_signals(step, reduction.structure.elements)
    yield dependent_step(reduction, held)
    yield balances_step(reduction, held, shown)
    yield inertia_step(result)
    yield from whole_steps(result)

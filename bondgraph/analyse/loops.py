"""`loops`: what in a graph acts back on itself at once, by name, each with its gain."""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, determinant
from bondgraph.algebra.factored import factored
from bondgraph.causality.assign import assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.signals import causal_equations, causal_groups, loop_rows
from bondgraph.causality.vanishing import MOST
from bondgraph.reduce.inertia import inertia
from bondgraph.reduce.junction import junction_structure
from bondgraph.reduce.ports import reduce_ports
from bondgraph.reduce.resistances import resistive_groups
from bondgraph.reduce.sorting import Reduction, field_row


@dataclass(frozen=True)
class Loop:
    """Elements that determine one another at once, or a storage that a source rules.

    ``kind``: "bonds", efforts and flows that follow from one another by ratios alone; "resistances" that
    see one another; "storages", states and the dependent storages behind them; "source", a dependent
    storage whose momentum or charge an input rules, so that its rate enters as ``E u'``.

    ``gain``: what a signal comes back as when it has gone round: of a loop with several signals
    ``1 - det(1 - W)``, of "storages" ``1 - det A / det M`` with M the states' own values, of a "source"
    what the storage adds to the source per unit of its input's rate. At gain 1 a loop is singular (a
    "source" never is). None where the determinant would be too long to read.
    """

    kind: Literal["bonds", "resistances", "storages", "source"]
    nodes: tuple[Hashable, ...]
    gain: sp.Expr | None


def loops(graph: Any) -> tuple[Loop, ...]:
    """The loops of a declared or causal graph: those of bonds first, then resistances, storages, sources.

    Raises what `derive` raises up to the reduction; a graph with a loop of gain 1 is refused there.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("battery", "U"), bg.One("wire"), bg.R("R_1", "R_1"), bg.Zero("node"),
    ...                   bg.R("R_2", "R_2"), bg.R("R_3", "R_3")])
    >>> g.add_edges_from([("battery", "wire"), ("wire", "R_1"), ("wire", "node"), ("node", "R_2"),
    ...                   ("node", "R_3")])
    >>> loops(g)
    (Loop(kind='resistances', nodes=('R_1', 'R_2', 'R_3'), gain=-R_1*(R_2 + R_3)/(R_2*R_3)),)
    """
    causal = graph if isinstance(graph, CausalGraph) else assign_causality(graph)
    reduction = reduce_ports(junction_structure(causal))
    found = [*_of_bonds(causal), *_of_resistances(reduction)]
    return (*found, *_of_storages(reduction), *_of_sources(reduction))


def _of_bonds(causal: CausalGraph) -> Iterator[Loop]:
    strokes = causal.assignment
    equations = causal_equations(strokes)
    for group in causal_groups(equations.terms):
        if len(group) > 1:
            bonds = sorted({signal // 2 for signal in group})
            ends = dict.fromkeys(end for bond in bonds for end in strokes.declared[bond])
            yield Loop("bonds", tuple(ends), _gain(loop_rows(equations, group)))


def _of_resistances(reduction: Reduction) -> Iterator[Loop]:
    ports = reduction.structure.ports
    for group in resistive_groups(reduction):
        if group.is_loop:
            names = dict.fromkeys(
                ports[i].element.owner or ports[i].element.name for i in group.ports
            )
            yield Loop("resistances", tuple(names), _gain(group.inside))


def _of_storages(reduction: Reduction) -> Iterator[Loop]:
    """States coupled by dependent storages, one loop for each set that hangs together."""
    structure, ports = reduction.structure, reduction.structure.ports
    behind: nx.Graph[int] = nx.Graph()
    for d in reduction.dependent:
        behind.add_edges_from((d, i) for i in structure.rows[d] if i in reduction.columns_of_states)
    A, _ = inertia(reduction)
    for members in nx.connected_components(behind):
        block = sorted(reduction.columns_of_states[i] for i in members - {*reduction.dependent})
        own = [_own_row(reduction, state, block) for state in block]
        rows = [{block.index(j): entry for j, entry in A[i].items() if j in block} for i in block]
        gain = None
        if len(block) <= MOST:
            gain = factored(1 - determinant(rows) / determinant(own))
        names = dict.fromkeys(
            ports[i].element.owner or ports[i].element.name for i in sorted(members)
        )
        yield Loop("storages", tuple(names), gain)


def _own_row(reduction: Reduction, state: int, block: Sequence[int]) -> Row:
    """What a state's own storage, or its field, holds per unit of the states."""
    columns: Mapping[int, int] = reduction.columns_of_states
    row = field_row(reduction, reduction.states[state])
    return {
        block.index(columns[i]): value for i, value in row if i in columns and columns[i] in block
    }


def _of_sources(reduction: Reduction) -> Iterator[Loop]:
    structure, ports = reduction.structure, reduction.structure.ports
    for d in reduction.dependent:
        for i, ratio in structure.rows[d].items():
            if i in reduction.imposed:
                values = dict(field_row(reduction, d)) if not ports[d].element.law else {}
                gain = sp.cancel(values[d] * ratio**2) if d in values else None
                yield Loop("source", (ports[i].element.name, ports[d].element.name), gain)


def _gain(rows: Sequence[FixedRow]) -> sp.Expr | None:
    return None if len(rows) > MOST else factored(1 - determinant(rows))

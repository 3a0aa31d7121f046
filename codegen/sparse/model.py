"""`sparse_model`: the matrices of a large linear graph in numbers, sparse, straight along the causal order.

Nothing here has a closed form, so nothing grows with products of ratios: a train of ten thousand gears
costs what ten thousand masses on springs cost. Causality is decided exactly, as everywhere.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import scipy

from bondgraph.causality.assign import assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.lines import variable_of
from bondgraph.declare.names import energy_name, named_by
from bondgraph.errors import StructureError
from bondgraph.nodes.laws import ExpressionLaw
from codegen.inputs.signals import Constant
from codegen.numbers.arrays import read_only
from codegen.sparse.signal_rows import Row, SignalRows, matrix
from codegen.sparse.valued import valued_graph


@dataclass(frozen=True)
class SparseModel:
    """``A x' = J x + B u + E u'``, ``y = F x + D u + H x' + K u'`` in numbers, as scipy's csr arrays.

    The arrays are read-only. ``known``: the inputs that constant laws and sources give, by name.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: scipy.sparse.csr_array
    J: scipy.sparse.csr_array
    B: scipy.sparse.csr_array
    E: scipy.sparse.csr_array
    F: scipy.sparse.csr_array
    D: scipy.sparse.csr_array
    H: scipy.sparse.csr_array
    K: scipy.sparse.csr_array
    known: Mapping[str, Constant]
    #: What independent storages hold, ``p_m`` and ``q_C``: the state, and how much of it one of that is.
    held: Mapping[str, tuple[str, float]] = field(default_factory=lambda: MappingProxyType({}))


def sparse_model(
    graph: Any, parameters: Mapping[str, object], outputs: Iterable[Hashable] = ()
) -> SparseModel:
    """The equations of a declared or causal graph with numbers for its parameters.

    ``outputs``: nodes, as for `derive`: of a one-port the variable it receives, of a junction its
    common one. Linear storages and resistances with constant values, and constant laws.

    Raises what `assign_causality` raises at these numbers, `AlgebraicLoopError` for loops that they make
    singular, decided exactly; `ParameterError` for missing parameters; `StructureError` for values that
    change and other laws; `SingularStorageError` for storages that may cancel one another.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("damper", "b")])
    >>> g.add_edges_from([("force", "mass"), ("mass", "m"), ("mass", "damper")])
    >>> model = sparse_model(g, {"m": 2, "b": 3}, outputs=["mass"])
    >>> model.A.toarray(), model.J.toarray(), model.B.toarray(), model.F.toarray()
    (array([[2.]]), array([[-3.]]), array([[1.]]), array([[1.]]))
    """
    declared = graph.graph if isinstance(graph, CausalGraph) else graph
    causal = assign_causality(valued_graph(declared, parameters))
    return _assembled(SignalRows(causal.assignment), outputs)


def _assembled(rows: SignalRows, outputs: Iterable[Hashable]) -> SparseModel:
    """The matrices, dependent storages folded in."""
    n, m, elements = len(rows.states), len(rows.inputs), rows.strokes.elements
    names, shown = _shown(rows, outputs)
    values = [float(elements[node].constant) for node in rows.states]
    received = matrix([rows.received(node) for node in rows.states], 2 * (n + m))
    seen = matrix(shown, 2 * (n + m))
    rates, last = n + m, 2 * n + m
    return SparseModel(
        tuple(rows.given(node).name for node in rows.states),
        tuple(name.name for name in rows.inputs),
        tuple(names),
        A=_fixed(scipy.sparse.diags_array(values, shape=(n, n)) - received[:, rates:last]),
        J=_fixed(received[:, :n]),
        B=_fixed(received[:, n:rates]),
        E=_fixed(received[:, last:]),
        F=_fixed(seen[:, :n]),
        D=_fixed(seen[:, n:rates]),
        H=_fixed(seen[:, rates:last]),
        K=_fixed(seen[:, last:]),
        known=_known(rows),
        held=_held(rows),
    )


def _fixed(made: Any) -> scipy.sparse.csr_array:
    """A matrix whose arrays nobody can write to."""
    fixed = scipy.sparse.csr_array(made)
    fixed.sort_indices()
    for part in (fixed.data, fixed.indices, fixed.indptr):
        read_only(part)
    return fixed


def _known(rows: SignalRows) -> Mapping[str, Constant]:
    """The inputs that laws give."""
    elements = [rows.strokes.elements[node] for node in rows.sources]
    return MappingProxyType({
        e.given.name: Constant(float(e.law.expression))
        for e in elements
        if e.given is not None and isinstance(e.law, ExpressionLaw)
    })  # fmt: skip


def _held(rows: SignalRows) -> Mapping[str, tuple[str, float]]:
    """Momenta and displacements of the states' storages, by names that nothing else has."""
    elements = rows.strokes.elements
    taken = {name.name for element in elements for name in named_by(element)}
    found = {}
    for node in rows.states:
        element = elements[node]
        name = energy_name(element, taken)
        found[name.name] = (rows.given(node).name, float(element.constant))
    return MappingProxyType(found)


def _shown(signals: SignalRows, outputs: Iterable[Hashable]) -> tuple[list[str], list[Row]]:
    """The outputs' names and rows."""
    names: list[str] = []
    rows: list[Row] = []
    strokes = signals.strokes
    for name in outputs:
        if name not in signals.node:
            raise StructureError(f"output {name!r} is not a node of the graph")
        node = signals.node[name]
        element = strokes.elements[node]
        if element.one_port:
            other = "flow" if strokes.gives(node) == "effort" else "effort"
            names.append(str(variable_of(element, other)))
            rows.append(signals.received(node))
        elif element.kind.joins:
            flow = element.kind.common == "flow"
            names.append(str(element.flow if flow else element.effort))
            rows.append(signals.rows[2 * strokes.at[node][0] + flow])
        else:
            raise StructureError(f"output {name!r} is a two-port; name one of its neighbours")
    return names, rows

"""The whole way from a declared graph to its equations, one stage after the other.

networkx.DiGraph        the user's: nodes carry `kind`, `value`, ...; edges are bonds
  validate              a frozen graph, checked                        `StructureError`
  assign_causality      `CausalGraph`: strokes, each with its reason   `CausalityError`
  junction_structure    `JunctionStructure`: sparse, skew-symmetric    `AlgebraicLoopError`
  state_equations       `StateEquations`: A J B E F D G, laws          `DependentSourceError`
"""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import sympy as sp

from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.tidy import tidy_matrices
from bondgraph.causality.assign import assign_causality
from bondgraph.declare.validate import graph_of
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element
from bondgraph.reduce.impulses import bound_by_switches, check_impulses
from bondgraph.reduce.inertia import check_regular, inertia
from bondgraph.reduce.inverses import by_inverses, with_inverses, with_states_told
from bondgraph.reduce.junction import junction_structure
from bondgraph.reduce.opened import opened
from bondgraph.reduce.outputs import named_signals, shown_signals
from bondgraph.reduce.ports import reduce_ports
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.readings import check_laws
from bondgraph.reduce.resets import check_resets
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.starts import check_starts
from bondgraph.reduce.structure import JunctionStructure, PortRow
from bondgraph.reduce.switches import check_switches, switch_ports


def derive(
    graph: Any, outputs: Iterable[Hashable] | None = None, inputs: Iterable[str] = ()
) -> StateEquations:
    """The equations of a declared graph, with causality assigned and dependent storages resolved.

    ``outputs``: nodes whose signal the rows of F, D and G show: of a one-port the variable it
    receives, of a junction its common variable; left out, all open ports. ``inputs``: names in values
    that change in time as given from outside: the opening of a valve, a mass that is filled. An inertia or
    a compliance whose value reads an input has its momentum or displacement as its state, ``p_m`` of ``m``.

    Raises the `BondGraphError` of the stage that refuses.

    >>> import bondgraph as bg
    >>> import networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F_0"), bg.One("mass"), bg.I("m", "m", flow="v"),
    ...                   bg.C("spring", "1/k", effort="F_s"), bg.R("damper", "b")])
    >>> g.add_edges_from([("force", "mass"), ("mass", "m"), ("mass", "spring"), ("mass", "damper")])
    >>> equations = derive(g, outputs=["damper"])
    >>> equations.states, equations.J, equations.B
    ((v, F_s), Matrix([
    [-b, -1],
    [ 1,  0]]), Matrix([
    [1],
    [0]]))
    """
    return state_equations(opened(junction_structure(assign_causality(graph)), inputs), outputs)


def state_equations(
    structure: JunctionStructure, outputs: Iterable[Hashable] | None = None
) -> StateEquations:
    """Fold resistances and dependent storages into A, J, B, E and the outputs' F, D, G.

    With the ports' laws ``w_x = M_x x'``, ``z_d = (M_d w_d)'``, ``z_r = L w_r`` this gives
    ``A = M_x + S_xd M_d S_xd^T``.

    A switch is a port like an open one: what it gives is an input, what it receives a reading.

    Raises `SingularStorageError` if A is singular, `DependentSourceError` if a law would have to be
    differentiated, `StructureError` for an output that does not exist.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L"), ("loop", "R")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L", flow="i"), bg.R("R", "R")])
    >>> state_equations(junction_structure(assign_causality(g))).J
    Matrix([[-R]])
    """
    return _equations(structure, lambda reduction, _: shown_signals(reduction.structure, outputs))


def derive_again(
    equations: StateEquations, elements: Mapping[Hashable, Element], inputs: Iterable[str] = ()
) -> StateEquations:
    """The equations of the same graph with other elements at some of its nodes, showing the same signals.

    ``inputs``: more names in values that are inputs. Each node keeps its ports and the names of its
    variables; causality is assigned anew.

    Raises what `derive` raises.
    """
    kept = equations.reduction.structure
    graph = graph_of(
        {**kept.elements, **elements}, zip(kept.ends, kept.bonds, strict=True), kept.tables
    )
    names = [*(name.name for name in kept.opened), *inputs]
    return _equations(
        opened(junction_structure(assign_causality(graph)), names),
        lambda _, signals: [(symbol, signals[symbol]) for symbol in equations.outputs],
    )


def _reduced(structure: JunctionStructure) -> Reduction:
    """The ports reduced, those states by inverses, too, that switches bind by impulses."""
    found = reduce_ports(with_states_told(structure))
    bound = with_inverses(structure, bound_by_switches(found))
    return found if bound is structure else _reduced(by_inverses(bound))


Shown = list[tuple[sp.Symbol, PortRow]]
"""Signals by name, as rows over ports."""


def _equations(
    structure: JunctionStructure, show: Callable[[Reduction, Mapping[sp.Symbol, PortRow]], Shown]
) -> StateEquations:
    """The equations of a junction structure; ``show``: the outputs, told the named signals."""
    reduction = _reduced(by_inverses(structure))
    structure, ports = reduction.structure, reduction.structure.ports
    A, balances = inertia(reduction)
    states = reduction.names
    check_regular(reduction, A)
    signals = named_signals(reduction)
    shown = show(reduction, signals)
    rows = [(ports[port].received, structure.rows[port]) for port in reduction.imposed]
    readings = {symbol: reduction.reading(row) for symbol, row in [*rows, *shown]}
    resolved_rows = [resolved(A, balances, readings[symbol]) for symbol, _ in shown]
    imposed = tuple(ports[port] for port in reduction.imposed)
    E = [row.K for row in balances]
    laws = {port.element.name: port.element.law for port in imposed if port.element.law is not None}
    check_laws(laws, signals, imposed, E, readings, structure.states_of_laws)
    check_starts(reduction)
    switches = switch_ports(reduction, signals)
    check_switches(switches, reduction.inputs, E, readings)
    check_impulses(switches, reduction, A, readings)
    check_resets(switches, reduction)
    n, m = len(states), len(reduction.inputs)
    parts: list[tuple[Sequence[FixedRow], int]] = [
        (A, n), ([row.F for row in balances], n), ([row.D for row in balances], m), (E, m),
        ([row.F for row in resolved_rows], n), ([row.D for row in resolved_rows], m),
        ([row.K for row in resolved_rows], m),
    ]  # fmt: skip
    matrices = tidy_matrices(parts)
    shown_names = tuple(symbol for symbol, _ in shown)
    named = dict(zip("AJBEFDG", matrices, strict=True))
    detectors = [port for port in ports if port.element.integral is not None]
    return StateEquations(
        states, reduction.inputs, shown_names, **named,
        integrals=MappingProxyType({port.element.integral: port.received for port in detectors}),
        laws=MappingProxyType(laws), ports=imposed, readings=MappingProxyType(readings),
        signals=MappingProxyType(signals), switches=switches, reduction=reduction,
    )  # fmt: skip


def check_derived(given: object) -> None:
    """Refuse what is no equations where these are asked for: a graph is derived first.

    >>> check_derived("a > b")
    Traceback (most recent call last):
        ...
    bondgraph.errors.StructureError: this takes equations, what bondgraph.derive(graph) returns, not a str
    """
    if not isinstance(given, StateEquations):
        raise StructureError(
            "this takes equations, what bondgraph.derive(graph) returns, not a "
            f"{type(given).__name__}"
        )

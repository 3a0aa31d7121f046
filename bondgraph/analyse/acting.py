"""Which inputs act on slips or on how fast these change: what does not is no matter of which ports hold."""

from collections.abc import Iterable

import networkx as nx
import sympy as sp

from bondgraph.equations import StateEquations


def acting(equations: StateEquations, slips: Iterable[sp.Symbol]) -> set[sp.Symbol]:
    """The inputs that act on these readings at once, or on their rates by way of the storages.

    By structure alone: an entry counts whatever its value. An input whose rate counts, as one that drives
    a dependent storage, acts.
    """
    columns = {j for _, j in equations.E.todok()}
    columns |= {j for reading in equations.readings.values() for j in reading.K}
    moved: set[int] = set()
    for reading in (equations.readings[name] for name in slips):
        columns |= set(reading.D)
        moved |= {*reading.F, *reading.H}
    joined: nx.Graph[int] = nx.Graph()
    joined.add_nodes_from(range(len(equations.states)))
    joined.add_edges_from(equations.A.todok())
    reached = set().union(*(nx.node_connected_component(joined, state) for state in moved))
    columns |= {j for i, j in equations.B.todok() if i in reached}
    return {equations.inputs[j] for j in columns}

"""A model over a table whose values are zero when it is written, and what it does with others."""

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg

Array = np.ndarray

POINTS, VALUES = (-2.0, 0.0, 1.0, 3.0), (-4.0, 0.0, 1.0, 3.0)
NUMBERS = {"m": 1.0}
START, PUSH = {"v": -1.0}, {"P": 4.0}
END = 2.5


def dragged(outside: str = "hold", values: tuple[float, ...] = (0.0,) * 4) -> bg.StateEquations:
    """A mass that is pushed over a table of its speed."""
    drag = bg.LookupTable("drag", POINTS, values, outside=outside)
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.R("b", flow="w", law="drag(w)"),
    ]
    graph = bond_graph(nodes, "push>n>m n>b")
    graph.graph["tables"] = [drag]
    return bg.derive(graph)


def speed(t: Array) -> Array:
    """Under `VALUES`: 2 v below zero, v above, held from 3 on; an exponential to each corner."""
    p = PUSH["P"]
    first = 0.5 * np.log1p(2 / p)
    second = first + np.log(p / (p - 3))
    below = p / 2 - (1 + p / 2) * np.exp(-2 * t)
    between = -p * np.expm1(-(t - first))
    return np.where(t < first, below, np.where(t < second, between, 3 + (p - 3) * (t - second)))


LEAVES = 0.5 * np.log1p(0.5) + np.log(4)
"""The time [s] at which the table ends, at a speed of 3."""


def mapped(method: str, *axes: Array) -> bg.StateEquations:
    """A mass whose rate is a table of its speed, or of that and an input; all values are zero."""
    zeros = np.zeros([len(axis) for axis in axes])
    table = bg.LookupTable("map", *axes, zeros, method=method)
    graph = nx.DiGraph(tables=[table])
    call = "map(v)" if len(axes) == 1 else "map(v, u)"
    graph.add_nodes_from(
        [bg.Se("s", call), bg.One("n"), bg.I("m", 1, flow="v"), bg.Se("more", "u")]
    )
    graph.add_edges_from([("s", "n"), ("n", "m"), ("more", "n")])
    return bg.derive(graph)

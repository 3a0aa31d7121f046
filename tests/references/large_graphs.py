"""Graphs with many states, each value a symbol of its own."""

from __future__ import annotations

import random

import networkx as nx

import bondgraph as bg


def coupled_shafts(seed: int, shafts: int, masses: int, moving: bool = False) -> nx.DiGraph[str]:
    """Shafts in a row, damped against one another, and masses that ratios hang on one to three of them.

    Each shaft has an inertia, a damper and a torque; the masses are dependent storages, so that A couples
    what they hang on. ``moving``: shafts have angles, and half the ratios are sines of them.
    """
    rng = random.Random(seed)
    graph: nx.DiGraph[str] = nx.DiGraph()
    for k in range(shafts):
        graph.add_nodes_from([bg.One(f"shaft{k}"), bg.I(f"J{k}", f"J{k}", flow=f"w{k}"),
                              bg.R(f"b{k}", f"b{k}"), bg.Se(f"T{k}", f"T{k}")])  # fmt: skip
        graph.add_edges_from(
            [(f"shaft{k}", f"J{k}"), (f"shaft{k}", f"b{k}"), (f"T{k}", f"shaft{k}")]
        )
        if moving:
            graph.add_nodes_from([bg.Df(f"angle{k}", integrate=f"theta{k}")])
            graph.add_edge(f"shaft{k}", f"angle{k}")
        if k:
            graph.add_nodes_from([bg.Zero(f"slip{k}"), bg.R(f"c{k}", f"c{k}")])
            nx.add_path(graph, [f"shaft{k - 1}", f"slip{k}", f"shaft{k}"])
            graph.add_edge(f"slip{k}", f"c{k}")
    for d in range(masses):
        graph.add_nodes_from(
            [bg.Zero(f"sum{d}"), bg.One(f"end{d}"), bg.I(f"m{d}", f"m{d}", priority=-1)]
        )
        nx.add_path(graph, [f"sum{d}", f"end{d}", f"m{d}"])
        for k in rng.sample(range(shafts), min(shafts, rng.choice([1, 2, 2, 3]))):
            turns = f"*sin(theta{k})" if moving and rng.random() < 0.5 else ""
            graph.add_nodes_from([bg.TF(f"n{d}_{k}", f"n{d}_{k}{turns}")])
            nx.add_path(graph, [f"shaft{k}", f"n{d}_{k}", f"sum{d}"])
    return graph


def ring_of_capacitors(count: int, resistance: str) -> nx.DiGraph[str]:
    """Capacitors in a ring, one of them dependent, and a resistor from each node; ``resistance`` of {}."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    for k in range(count):
        graph.add_nodes_from([bg.Zero(f"n{k}"), bg.R(f"r{k}", resistance.format(k)), bg.One(f"j{k}"),
                              bg.C(f"c{k}", f"C{k}", effort=f"v{k}")])  # fmt: skip
    for k in range(count):
        graph.add_edges_from([(f"n{k}", f"r{k}"), (f"n{k}", f"j{k}"), (f"j{k}", f"c{k}"),
                              (f"j{k}", f"n{(k + 1) % count}")])  # fmt: skip
    return graph

"""Random bond graphs with switches and controlled junctions in them, linear and in numbers."""

from __future__ import annotations

import random

import networkx as nx

from references.random_graphs import random_graph


def random_switched(seed: int, most: int = 3, bonds: int = 14) -> nx.DiGraph[str]:
    """A random graph in which one to ``most`` ports are switches instead, or junctions controlled.

    Every switch is on or off as an input of its own says, ``g_<node>``. Values are small fractions.
    """
    rng = random.Random(seed)
    while True:
        graph = random_graph(rng, rng.randint(3, bonds), mesh=0.4, symbols=False)
        ports = [n for n, data in graph.nodes(data=True) if data["kind"] in ("I", "C", "R")]
        joints = [n for n, data in graph.nodes(data=True) if data["kind"] in ("Zero", "One")]
        if ports:
            break
    rng.shuffle(ports)
    rng.shuffle(joints)
    count = rng.randint(1, most)
    controlled = joints[: rng.choice([0, 0, 1])]
    for name in ports[: max(1, count - len(controlled))]:
        graph.nodes[name].clear()
        graph.nodes[name].update(kind="Sw", on=f"g_{name}")
    for name in controlled:
        graph.nodes[name]["on"] = f"g_{name}"
    return graph

"""Bond graphs to test with: random ones, and chains of any length."""

from __future__ import annotations

import random
from collections.abc import Iterator
from fractions import Fraction
from itertools import count

import networkx as nx

#: One-ports and how often they are drawn; "open" is an R without a value.
PORT_WEIGHTS = {"I": 25, "C": 25, "R": 18, "open": 12, "Se": 11, "Sf": 9}


def random_graph(
    rng: random.Random, bonds: int, mesh: float = 0.3, symbols: bool = True
) -> nx.DiGraph[str]:
    """A random connected bond graph of about `bonds` bonds, drawn from `rng` alone.

    A tree of junctions, each with at least two bonds; the rest of the bonds are links between
    junctions with probability `mesh`, which close meshes, and otherwise one-ports. TF and GY
    stand in links, meshes and before ports, at times two in a row. Up to four bonds the graph
    may also be two one-ports with TF and GY in between. Bonds are drawn in either direction,
    nodes and bonds are declared in random order. Values are symbols "v0", "v1", ..., all
    different, or with `symbols=False` small fractions; moduli may be negative. Sources have
    the input "u_<node>", open ports no value and a random `gives`.
    """
    graph: nx.DiGraph[str] = nx.DiGraph()
    serial = count()
    if bonds < 2 or (bonds < 5 and rng.random() < 0.2):
        ends = _new_port(rng, graph, serial), _new_port(rng, graph, serial)
        _link(rng, graph, serial, *ends, two_ports=max(bonds, 1) - 1)
    else:
        _grow(rng, graph, serial, bonds, mesh)
    _give_values(rng, graph, symbols)
    return _shuffled(rng, graph)


def chain(n: int) -> nx.DiGraph[str]:
    """A force on n masses in a row, each with a damper and followed by a spring.

    Se -> 1(I, R) -> 0(C) -> 1(I, R) -> 0(C) ...: 5 n bonds, every value a symbol of its own.
    """
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_node("force", kind="Se", value="u")
    last = "force"
    for k in range(n):
        for name, kind, value in (("I", "I", "m"), ("R", "R", "b"), ("C", "C", "c")):
            graph.add_node(f"{name}{k}", kind=kind, value=f"{value}{k}")
        graph.add_node(f"one{k}", kind="One")
        graph.add_node(f"zero{k}", kind="Zero")
        nx.add_path(graph, [last, f"one{k}", f"zero{k}", f"C{k}"])
        graph.add_edges_from([(f"one{k}", f"I{k}"), (f"one{k}", f"R{k}")])
        last = f"zero{k}"
    return graph


def _grow(
    rng: random.Random, graph: nx.DiGraph[str], serial: Iterator[int], bonds: int, mesh: float
) -> None:
    """Junctions as a tree, ports until each has two bonds, then meshes and ports at random."""
    junctions: list[str] = []
    for _ in range(max(1, round(bonds * rng.uniform(0.15, 0.4)))):
        before = rng.choice(junctions) if junctions else None
        new = _new_junction(rng, graph, serial, before)
        junctions.append(new)
        if before is not None:
            _link(rng, graph, serial, before, new, two_ports=_few(rng, 0.15))
    for junction in junctions:
        while graph.degree(junction) < 2:
            port = _new_port(rng, graph, serial)
            _link(rng, graph, serial, junction, port, two_ports=_few(rng, 0.05))
    while graph.number_of_edges() < bonds:
        if len(junctions) > 1 and rng.random() < mesh:
            ends, two_ports = rng.sample(junctions, 2), _few(rng, 0.4)
            if two_ports or not (graph.has_edge(*ends) or graph.has_edge(*ends[::-1])):
                _link(rng, graph, serial, ends[0], ends[1], two_ports)
                continue
        port = _new_port(rng, graph, serial)
        _link(rng, graph, serial, rng.choice(junctions), port, two_ports=_few(rng, 0.05))


def _few(rng: random.Random, probability: float) -> int:
    """0, 1 or 2, each next one with the given probability."""
    return 0 if rng.random() >= probability else 1 + (rng.random() < probability)


def _new_junction(
    rng: random.Random, graph: nx.DiGraph[str], serial: Iterator[int], before: str | None
) -> str:
    """A junction, four times out of five of the other kind than its neighbour."""
    kind = rng.choice(["Zero", "One"])
    if before is not None and rng.random() < 0.6:
        kind = "One" if graph.nodes[before]["kind"] == "Zero" else "Zero"
    name = f"{kind.lower()}_{next(serial)}"
    graph.add_node(name, kind=kind)
    return name


def _new_port(rng: random.Random, graph: nx.DiGraph[str], serial: Iterator[int]) -> str:
    (drawn,) = rng.choices(list(PORT_WEIGHTS), list(PORT_WEIGHTS.values()))
    name = f"{drawn}_{next(serial)}"
    if drawn == "open":
        graph.add_node(name, kind="R", gives=rng.choice(["effort", "flow"]))
    else:
        graph.add_node(name, kind=drawn)
    return name


def _link(
    rng: random.Random,
    graph: nx.DiGraph[str],
    serial: Iterator[int],
    first: str,
    second: str,
    two_ports: int,
) -> None:
    """Bonds from one node to another through new TF and GY, all in one random direction."""
    path = [first]
    for _ in range(two_ports):
        kind = "TF" if rng.random() < 0.65 else "GY"
        path.append(f"{kind}_{next(serial)}")
        graph.add_node(path[-1], kind=kind)
    path.append(second)
    nx.add_path(graph, path if rng.random() < 0.5 else path[::-1])


def _give_values(rng: random.Random, graph: nx.DiGraph[str], symbols: bool) -> None:
    serial = count()
    for node, data in graph.nodes.items():
        kind = data["kind"]
        if kind in ("Se", "Sf"):
            data["value"] = f"u_{node}"
        elif kind not in ("Zero", "One") and "gives" not in data:
            sign = rng.choice([1, 1, -1]) if kind in ("TF", "GY") else 1
            number = sign * Fraction(rng.randint(1, 9), rng.randint(1, 4))
            data["value"] = f"v{next(serial)}" if symbols else number


def _shuffled(rng: random.Random, graph: nx.DiGraph[str]) -> nx.DiGraph[str]:
    """The same graph, nodes and bonds declared in random order."""
    nodes, edges = list(graph.nodes(data=True)), list(graph.edges)
    rng.shuffle(nodes)
    rng.shuffle(edges)
    shuffled: nx.DiGraph[str] = nx.DiGraph()
    shuffled.add_nodes_from(nodes)
    shuffled.add_edges_from(edges)
    return shuffled

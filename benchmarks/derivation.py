"""How time and memory to derive grow with a graph's size, every value a symbol of its own.

A chain and a tree of masses, springs and dampers, a square mesh of them, and a train of gears whose
inertias are all dependent but one. Prints, for each size, the median time of several derivations, the peak
of what Python allocated in one more, and the growth exponent between neighbouring sizes.
Run it alone on the machine: ``python benchmarks/derivation.py [largest number of storages]``.
"""

import gc
import math
import statistics
import sys
import time
import tracemalloc
from collections.abc import Callable

import networkx as nx

import bondgraph as bg

Graph = nx.DiGraph

SIZES = (20, 100, 400, 1000, 2000, 4000)
LARGEST = {"chain": 4000, "tree": 4000, "mesh": 4000, "gears": 100}
"""In storages. The closed form of a gear train's A has one entry of ever more products."""


def _mass(graph: Graph, k: int) -> str:
    """A mass with a damper on its junction."""
    graph.add_nodes_from([bg.One(f"mass_{k}"), bg.I(f"m_{k}", f"m_{k}"), bg.R(f"b_{k}", f"b_{k}")])
    graph.add_edges_from([(f"mass_{k}", f"m_{k}"), (f"mass_{k}", f"b_{k}")])
    return f"mass_{k}"


def _spring(graph: Graph, k: int, one: str, other: str) -> None:
    """A spring between two masses."""
    graph.add_nodes_from([bg.Zero(f"joint_{k}"), bg.C(f"c_{k}", f"c_{k}")])
    graph.add_edges_from([(one, f"joint_{k}"), (f"joint_{k}", f"c_{k}"), (f"joint_{k}", other)])


def _driven() -> Graph:
    graph: Graph = nx.DiGraph()
    graph.add_nodes_from([bg.Se("drive", "u")])
    graph.add_edge("drive", _mass(graph, 0))
    return graph


def chain(storages: int) -> Graph:
    """Each mass on a spring to the one before."""
    graph = _driven()
    for k in range(1, storages // 2):
        _spring(graph, k, f"mass_{k - 1}", _mass(graph, k))
    return graph


def tree(storages: int) -> Graph:
    """Each mass on a spring to its parent in a binary tree."""
    graph = _driven()
    for k in range(1, storages // 2):
        _spring(graph, k, f"mass_{(k - 1) // 2}", _mass(graph, k))
    return graph


def mesh(storages: int) -> Graph:
    """A square of masses, each on springs to its neighbours: three storages a mass."""
    graph = _driven()
    side = max(round(math.sqrt(storages / 3)), 2)
    for k in range(1, side * side):
        _mass(graph, k)
        if k % side:
            _spring(graph, 2 * k, f"mass_{k - 1}", f"mass_{k}")
        if k >= side:
            _spring(graph, 2 * k + 1, f"mass_{k - side}", f"mass_{k}")
    return graph


def gears(storages: int) -> Graph:
    """Inertias in a row of gears: one state, all others dependent."""
    graph = _driven()
    for k in range(1, storages):
        graph.add_nodes_from([bg.TF(f"gear_{k}", f"n_{k}")])
        graph.add_edges_from([(f"mass_{k - 1}", f"gear_{k}"), (f"gear_{k}", _mass(graph, k))])
    return graph


def median_time(build: Callable[[int], Graph], size: int) -> float:
    """The median time [s] of a derivation, of at least three."""
    times: list[float] = []
    while len(times) < 3 or (sum(times) < 1.0 and len(times) < 20):
        graph = build(size)
        gc.collect()
        begin = time.perf_counter()
        bg.derive(graph, outputs=[])
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def peak_memory(build: Callable[[int], Graph], size: int) -> float:
    """The largest amount of memory [MB] that Python held for one derivation and its result."""
    graph = build(size)
    gc.collect()
    tracemalloc.start()
    bg.derive(graph, outputs=[])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / 1e6


def main() -> None:
    """Print one table per kind of graph."""
    most = int(sys.argv[1]) if len(sys.argv) > 1 else SIZES[-1]
    median_time(chain, 20)
    for build in (chain, tree, mesh, gears):
        sizes = [n for n in SIZES if n <= min(most, LARGEST[build.__name__])]
        times = [median_time(build, n) for n in sizes]
        print(f"{build.__name__}: {' '.join((build.__doc__ or '').split())}")
        print(f"{'storages':>9} {'bonds':>7} {'time [s]':>10} {'peak [MB]':>10} {'exponent':>9}")
        for at, (n, seconds) in enumerate(zip(sizes, times, strict=True)):
            growth = ""
            if at:
                growth = f"{math.log(seconds / times[at - 1]) / math.log(n / sizes[at - 1]):.2f}"
            bonds, peak = build(n).number_of_edges(), peak_memory(build, n)
            print(f"{n:>9} {bonds:>7} {seconds:>10.4f} {peak:>10.1f} {growth:>9}")
        if 100 in sizes and sizes[-1] > 100:
            first = times[sizes.index(100)]
            overall = math.log(times[-1] / first) / math.log(sizes[-1] / 100)
            print(f"growth exponent from 100 to {sizes[-1]} storages: {overall:.2f}\n")


if __name__ == "__main__":
    main()

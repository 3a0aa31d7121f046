"""How the time to derive grows: chains of n inertias, resistances and springs, every value a symbol.

Prints, for each n, the median time of several derivations and the growth exponent between
neighbouring sizes. Run it alone on the machine: ``python benchmarks/derivation.py [largest n]``.
"""

import gc
import math
import statistics
import sys
import time

import networkx as nx

import bondgraph as bg

SIZES = (10, 20, 50, 100, 200, 500, 1000, 2000)


def chain(n: int) -> "nx.DiGraph[str]":
    """``Se -> 1(I, R) -> 0(C) -> 1(I, R) -> ...``, 3 n elements, 5 n bonds."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([bg.Se("drive", "u")])
    before = "drive"
    for k in range(n):
        graph.add_nodes_from(
            [
                bg.One(f"mass_{k}"),
                bg.I(f"m_{k}", f"m_{k}"),
                bg.R(f"b_{k}", f"b_{k}"),
                bg.Zero(f"joint_{k}"),
                bg.C(f"c_{k}", f"c_{k}"),
            ]
        )
        graph.add_edges_from(
            [
                (before, f"mass_{k}"),
                (f"mass_{k}", f"m_{k}"),
                (f"mass_{k}", f"b_{k}"),
                (f"mass_{k}", f"joint_{k}"),
                (f"joint_{k}", f"c_{k}"),
            ]
        )
        before = f"joint_{k}"
    return graph


def median_time(n: int) -> float:
    """The median time [s] of a derivation of the chain of n, of at least three."""
    times: list[float] = []
    while len(times) < 3 or (sum(times) < 1.0 and len(times) < 20):
        graph = chain(n)
        gc.collect()
        begin = time.perf_counter()
        equations = bg.derive(graph, outputs=[])
        times.append(time.perf_counter() - begin)
        assert len(equations.states) == 2 * n
    return statistics.median(times)


def main() -> None:
    """Print the table."""
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else SIZES[-1]
    median_time(5)
    sizes = [n for n in SIZES if n <= largest]
    times = [median_time(n) for n in sizes]
    print(f"{'n':>6} {'states':>7} {'bonds':>7} {'time [s]':>10} {'exponent':>9}")
    for at, (n, seconds) in enumerate(zip(sizes, times, strict=True)):
        growth = ""
        if at:
            growth = f"{math.log(seconds / times[at - 1]) / math.log(n / sizes[at - 1]):.2f}"
        print(f"{n:>6} {2 * n:>7} {5 * n:>7} {seconds:>10.4f} {growth:>9}")
    if 50 in sizes and sizes[-1] > 50:
        first = times[sizes.index(50)]
        overall = math.log(times[-1] / first) / math.log(sizes[-1] / 50)
        print(f"growth exponent from n = 50 to n = {sizes[-1]}: {overall:.2f}")


if __name__ == "__main__":
    main()

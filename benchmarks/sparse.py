"""How time and memory of sparse models and of their runs grow with a graph's size, in numbers.

The chains, trees, meshes and gear trains of `derivation`, every value a parameter with a number. Prints, for
each size, the time to assign causality and assemble the matrices (`sparse_model`), the peak of what Python
allocated in that, the nonzero entries of A and J, and of a run from rest with a force the time with both
methods, each with the growth exponent from the size before. A run lasts 1 s where the fastest masses on
springs turn by about 60 rad/s.
Memory of factors, which SuperLU keeps, is not counted. Run it alone on the machine, with one thread:
``OPENBLAS_NUM_THREADS=1 python benchmarks/sparse.py [largest number of storages]``.
"""

import gc
import math
import random
import sys
import time
import tracemalloc
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np
from derivation import chain, gears, mesh, tree

from codegen import SparseModel, run_sparse, sparse_model

if TYPE_CHECKING:
    Graph = nx.DiGraph[Any]
else:
    Graph = nx.DiGraph

SIZES = (1000, 2000, 5000, 10000)
TIMES = np.linspace(0.0, 1.0, 11)
METHODS = ("Radau", "DOP853")
RANGES = {"m": (0.8, 1.2), "b": (0.1, 0.3), "c": (8e-4, 1.2e-3), "n": (0.95, 1.05)}
"""Least and largest values: kg, N s/m, m/N, ratios."""


def numbers(graph: Graph) -> dict[str, object]:
    """A number for every parameter, the same in every run."""
    rng = random.Random(0)
    names = [data["value"] for _, data in graph.nodes(data=True) if data.get("value")]
    return {name: round(rng.uniform(*RANGES[name[0]]), 4) for name in names if name != "u"}


def assembled(graph: Graph) -> tuple[SparseModel, float]:
    """The model and the time [s] it took."""
    parameters = numbers(graph)
    gc.collect()
    begin = time.perf_counter()
    model = sparse_model(graph, parameters)
    return model, time.perf_counter() - begin


def peak_memory(work: Callable[[], object]) -> float:
    """The largest amount of memory [MB] that Python held in some work, its result included."""
    gc.collect()
    tracemalloc.start()
    work()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / 1e6


def run_time(model: SparseModel, method: str) -> float:
    """The time [s] of a run from rest."""
    begin = time.perf_counter()
    run_sparse(model, TIMES, inputs={"u": 1.0}, method=method, rtol=1e-6, atol=1e-9)
    return time.perf_counter() - begin


def growth(values: list[float], sizes: list[int], at: int) -> str:
    """The exponent from the size before to this one."""
    if not at:
        return ""
    return f"{math.log(values[at] / values[at - 1]) / math.log(sizes[at] / sizes[at - 1]):.2f}"


def measured(build: Callable[[int], Graph], n: int) -> list[float]:
    """Storages, nonzero entries, memory of model and run [MB], times [s] of model and runs."""
    graph = build(n)
    model, seconds = assembled(graph)
    peak = peak_memory(lambda: sparse_model(graph, numbers(graph)))
    run_peak = peak_memory(lambda: run_time(model, METHODS[0]))
    runs = [run_time(model, method) for method in METHODS]
    return [n, model.A.nnz + model.J.nnz, peak, run_peak, seconds, *runs]


def main() -> None:
    """Print one table per kind of graph."""
    most = int(sys.argv[1]) if len(sys.argv) > 1 else SIZES[-1]
    sizes = [n for n in SIZES if n <= most] or [most]
    assembled(chain(20))
    for build in (chain, tree, mesh, gears):
        print(f"{build.__name__}: {' '.join((build.__doc__ or '').split())}")
        print(
            f"{'storages':>9} {'nnz':>7} {'model [MB]':>11} {'run [MB]':>9}"
            + "".join(f" {name + ' [s]':>12} {'exponent':>8}" for name in ("model", *METHODS))
        )
        rows: list[list[float]] = []
        for at, n in enumerate(sizes):
            rows.append(measured(build, n))
            _, nnz, peak, run_peak, *_ = rows[-1]
            times = [
                f" {rows[-1][k]:>12.3f} {growth([row[k] for row in rows], sizes, at):>8}"
                for k in (4, 5, 6)
            ]
            print(f"{n:>9} {nnz:>7.0f} {peak:>11.1f} {run_peak:>9.1f}" + "".join(times), flush=True)
        print()


if __name__ == "__main__":
    main()

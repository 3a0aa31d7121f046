"""How much longer a derivation takes than writing the same equations down.

The chain of ``derivation.py``, every value a symbol of its own. ``derive`` goes from the declared graph to
`StateEquations`; ``write`` makes the same symbols and puts the same A, J, B, E, F, D and G, known
beforehand, entry by entry into dictionaries and from there into sympy's immutable sparse matrices.
Both are run in turns, sympy's cache emptied before each; prints medians of processor time, the ratio of the
two, and growth exponents: ``python benchmarks/writing.py [largest number of storages]``.
"""

import gc
import math
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

import sympy as sp
from derivation import chain
from sympy.core.cache import clear_cache

import bondgraph as bg

SIZES = (20, 100, 400, 1000, 2000, 4000, 10_000)
MOST_ROUNDS, LEAST_ROUNDS, ENOUGH = 15, 3, 8.0
"""Rounds for each size go on until they have taken so many seconds."""

Entries = dict[tuple[int, int], sp.Expr]


def written(storages: int) -> list[sp.ImmutableSparseMatrix]:
    """The chain's matrices, states in the order masses and springs were declared in.

    A mass: ``m_k v_k' = -b_k v_k + F_k - F_(k+1)``, the first with the drive; a spring:
    ``c_k F_k' = v_(k-1) - v_k``.
    """
    masses = storages // 2
    n = 2 * masses - 1
    one, minus = sp.Integer(1), -sp.Integer(1)
    A: Entries = {}
    J: Entries = {}
    for k in range(masses):
        # The states are m_0, m_1, c_1, m_2, c_2 ...
        mass = 2 * k - 1 if k else 0
        A[mass, mass] = sp.Symbol(f"m_{k}")
        J[mass, mass] = -sp.Symbol(f"b_{k}")
        if k:
            spring, before = mass + 1, max(mass - 2, 0)
            A[spring, spring] = sp.Symbol(f"c_{k}")
            J[spring, before], J[spring, mass] = one, minus
            J[before, spring], J[mass, spring] = minus, one
    B: Entries = {(0, 0): one}
    parts = [(n, n, A), (n, n, J), (n, 1, B), (n, 1, {}), (0, n, {}), (0, 1, {}), (0, 1, {})]
    return [sp.ImmutableSparseMatrix(rows, columns, entries) for rows, columns, entries in parts]


def timed(work: Callable[[], Any]) -> float:
    """The processor's time [s] for one run."""
    clear_cache()
    gc.collect()
    begin = time.process_time()
    work()
    return time.process_time() - begin


def medians(storages: int) -> tuple[float, float]:
    """The median times to derive and to write down, run in turns."""
    derive: list[float] = []
    write: list[float] = []
    while len(derive) < LEAST_ROUNDS or (sum(derive) < ENOUGH and len(derive) < MOST_ROUNDS):
        graph = chain(storages)
        derive.append(timed(lambda graph=graph: bg.derive(graph, outputs=[])))  # type: ignore[misc]
        write.append(timed(lambda: written(storages)))
    return statistics.median(derive), statistics.median(write)


def check(storages: int) -> None:
    """Both are the same equations."""
    found = bg.derive(chain(storages), outputs=[])
    for name, matrix in zip("AJBEFDG", written(storages), strict=True):
        derived = getattr(found, name)
        if type(derived) is not type(matrix) or derived != matrix:
            raise SystemExit(f"{name} is written down otherwise than derived")


def exponent(times: dict[int, float], fewer: int, more: int) -> float:
    """The growth exponent between two sizes."""
    return math.log(times[more] / times[fewer]) / math.log(more / fewer)


def main() -> None:
    """Print the table, then the exponents over the whole range."""
    most = int(sys.argv[1]) if len(sys.argv) > 1 else SIZES[-1]
    sizes = [n for n in SIZES if n <= most]
    for n in sizes[:2]:
        check(n)
    derive: dict[int, float] = {}
    write: dict[int, float] = {}
    print(f"{'storages':>9} {'derive [s]':>11} {'write [s]':>10} {'ratio':>7} {'exponents':>13}")
    for at, n in enumerate(sizes):
        derive[n], write[n] = medians(n)
        growth = ""
        if at:
            growth = " ".join(f"{exponent(t, sizes[at - 1], n):6.2f}" for t in (derive, write))
        ratio = derive[n] / write[n]
        print(f"{n:>9} {derive[n]:>11.4f} {write[n]:>10.5f} {ratio:>7.1f} {growth:>13}", flush=True)
    if sizes[-1] > 100:
        both = (exponent(derive, 100, sizes[-1]), exponent(write, 100, sizes[-1]))
        print(f"growth exponents from 100 to {sizes[-1]} storages: {both[0]:.2f}, {both[1]:.2f}")


if __name__ == "__main__":
    main()

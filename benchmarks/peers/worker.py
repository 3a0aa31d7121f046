"""One peer, one graph: ``python -I worker.py SCRIPT SECONDS``, the graph as JSON on standard input.

Prints, after the word RESULT, the median time and the peak memory of a derivation and the numbers that its
result has for the graph's values, or what went wrong.
"""

import gc
import importlib.util
import json
import signal
import statistics
import sys
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import sympy as sp
from sympy.core.cache import clear_cache

RECURSION = 20_000


class TimeLimitError(BaseException):
    """Not an `Exception`: a peer that catches those should not catch this."""


class UnresolvedError(ValueError):
    """The equations hold more than states, inputs and values."""


@contextmanager
def limit(seconds: float) -> Iterator[None]:
    def stop(*_: Any) -> None:
        raise TimeLimitError

    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def load(script: str) -> Any:
    spec = importlib.util.spec_from_file_location("the_peer", script)
    if spec is None or spec.loader is None:
        raise ImportError(script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def measured(peer: Any, spec: dict[str, Any], seconds: float) -> tuple[Any, dict[str, Any]]:
    """A derivation's result, and the median time of one to three, sympy's cache emptied before each.

    What Python allocated is traced in one more, unless that would take too long.
    """
    times: list[float] = []
    while not times or (len(times) < 3 and sum(times) < seconds / 6):
        model = peer.build(spec)
        clear_cache()
        gc.collect()
        with limit(seconds):
            begin = time.perf_counter()
            result = peer.derive(model)
            times.append(time.perf_counter() - begin)
    peak = None
    if times[0] < seconds / 12:
        model = peer.build(spec)
        clear_cache()
        gc.collect()
        tracemalloc.start()
        peer.derive(model)
        peak = tracemalloc.get_traced_memory()[1] / 1e6
        tracemalloc.stop()
    return result, {"time": statistics.median(times), "peak": peak}


def coefficients(expr: Any, known: set[str], numbers: dict[str, float]) -> dict[str, float]:
    """The numbers by which a linear expression holds the known names."""
    expr = sp.sympify(expr)
    expr = expr.xreplace(
        {s: sp.Float(numbers[s.name]) for s in expr.free_symbols if s.name in numbers}
    )
    names = sorted(expr.free_symbols, key=str)
    if left := [str(name) for name in names if str(name) not in known]:
        raise UnresolvedError(f"{', '.join(left[:3])} left in the equations")
    value = sp.lambdify(names, expr, modules="math")
    at_zero = value(*[0.0] * len(names))
    found = {"": at_zero} if abs(at_zero) > 1e-9 else {}
    for k, name in enumerate(names):
        found[str(name)] = value(*[float(j == k) for j in range(len(names))]) - at_zero
    return found


def numeric(relations: dict[str, Any], numbers: dict[str, float]) -> dict[str, Any]:
    """The relations with numbers for the values: each row from name to coefficient."""
    known = {name for key in ("x", "dx", "u") for name in relations[key]}
    rows = []
    for terms in relations["rows"]:
        row: dict[str, float] = {}
        for name, expr in terms.items():
            for inner, value in coefficients(expr, known, numbers).items():
                at = inner or name
                row[at] = row.get(at, 0.0) + value
        rows.append(row)
    output = {k: coefficients(v, set(), numbers)[""] for k, v in relations["output"].items()}
    return {**relations, "rows": rows, "output": output}


def run(script: str, seconds: float) -> Iterator[dict[str, Any]]:
    """What is known so far, more each time."""
    sys.setrecursionlimit(RECURSION)
    spec = json.load(sys.stdin)
    peer = load(script)
    known: dict[str, Any] = {}
    try:
        result, known = measured(peer, spec, seconds)
        yield known
        with limit(seconds):
            relations = numeric(peer.relations(result, spec), spec["numbers"])
        yield {**known, "relations": relations}
    except TimeLimitError:
        yield {**known, "over": seconds}
    except UnresolvedError as error:
        yield {**known, "wrong": str(error)}
    except Exception as error:  # noqa: BLE001 - whatever a peer raises is what the table shows
        first = (str(error).strip() or "no message").splitlines()[0]
        yield {**known, "error": f"{type(error).__name__}: {first}"}


if __name__ == "__main__":
    for known in run(sys.argv[1], float(sys.argv[2])):
        print("RESULT", json.dumps(known), flush=True)

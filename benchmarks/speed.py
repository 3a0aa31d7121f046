"""How fast and how exactly the paper's figures run, side by side.

``python benchmarks/speed.py``: for each figure every way to run it, from C written by hand for Fig. 11 to
integrators that know no events and take a tanh for dry friction. Milliseconds are the median of calls taken
in turns, so that a busy machine slows all of them alike; the ratio is to the C backend. Errors are to exact
integrations that share no code with the toolkit: the largest of any state over its range, and of any event.
"""

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent / "floor")]

import floor  # noqa: E402
from accuracy import FIGURES, Outcome, errors, reference  # noqa: E402
from contenders import PATIENCE, Contender, contenders  # noqa: E402

import codegen  # noqa: E402
from codegen.sweeps.job import Job, batch_of  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402

ROUNDS, FEW = 61, 3
"""Turns, and turns of what is slow; what crawls is called once."""

CRAWLS, SLOW, SHORT = 5.0, 0.1, 5e-3
"""Seconds of a call from which it does; and up to which calls are repeated."""

BASE = "Simulator.run, C backend"

RUNS, SWEEPS = 10_000, 3
TIMES = np.linspace(0.0, 1.0, 1001)

Call = Callable[[], object]


def main() -> None:
    """Measure and print."""
    threads = os.environ.get("OPENBLAS_NUM_THREADS", "as many as it likes")
    print(f"{os.cpu_count()} cores; threads of BLAS: {threads}")
    with tempfile.TemporaryDirectory() as folder:
        for figure in FIGURES:
            print_figure(figure, contenders(figure, Path(folder)))


def print_figure(figure: str, ways: dict[str, Contender]) -> None:
    """One figure's table."""
    expected = reference(figure)
    medians, outcomes = measured(ways)
    title = f"{figure}, {FIGURES[figure]}"
    print(f"\n{title:<40}{'ms per run':>12}{'ratio':>10}{'error':>10}{'event [s]':>11}")
    for name in ways:
        if name not in medians:
            print(f"{name:<40}{f'over {1e3 * PATIENCE:g}':>12}")
            continue
        seconds = medians[name]
        worst, late = errors(outcomes[name], expected)
        when = "none" if late is None else f"{late:.1e}"
        ratio = seconds / medians[BASE]
        print(f"{name:<40}{1e3 * seconds:>12.5g}{ratio:>10.3g}{worst:>10.1e}{when:>11}", flush=True)


def measured(ways: dict[str, Contender]) -> tuple[dict[str, float], dict[str, Outcome]]:
    """Median seconds of a run of each and what it found; the first call only warms up what is not slow."""
    times: dict[str, list[float]] = {}
    lasted, outcomes = dict[str, float](), dict[str, Outcome]()
    for name, way in ways.items():
        start = time.perf_counter()
        try:
            found = way.call()
        except TimeoutError:
            continue
        lasted[name] = time.perf_counter() - start
        times[name] = [lasted[name] / way.runs] if lasted[name] > SLOW else []
        outcomes[name] = way.outcome(found)
    for turn in range(ROUNDS):
        for name, seconds in lasted.items():
            way = ways[name]
            if seconds > CRAWLS or (seconds > SLOW and turn >= FEW - 1):
                continue
            repeats = max(1, round(SHORT / seconds))
            times[name].append(seconds_of(way.call, repeats) / way.runs)
    return {name: statistics.median(found) for name, found in times.items()}, outcomes


def seconds_of(call: Call, repeats: int) -> float:
    """Seconds of one call, of so many in a row."""
    start = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - start) / repeats


def sweep_rates(folder: Path) -> dict[str, float]:
    """Runs per second of each sweep, the median of a few."""
    calls: dict[str, Call] = {}
    for threads in (1, 2):
        for name, call in sweep_calls(floor.build(folder), threads).items():
            calls[f"{name}, threads: {threads}"] = call
    times: dict[str, list[float]] = {name: [] for name in calls}
    for turn in range(SWEEPS + 1):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            if turn:
                times[name].append(time.perf_counter() - start)
    return {name: RUNS / statistics.median(found) for name, found in times.items()}


def sweep_calls(library: floor.ctypes.CDLL, threads: int) -> dict[str, Call]:
    """The same sweep by the floor, by the loop in C, and by `sweep`."""
    case = prepared("alsd", "fig11")
    family = codegen.Family(case.equations, case.parameters, case.laws, backend="c")
    measures = {"peak": codegen.peak("tau_k1"), "lock": codegen.first_event("clutch", "stick")}
    stiffness, torque = floor.grid(RUNS)
    both = codegen.Table(k=stiffness, torque=torque)
    given = (TIMES, measures, case.initial)
    quiet = {"workers": threads, "progress": False}
    loop = batch_of(Job(family, ("k",), *given, case.inputs))
    if loop is None:
        raise RuntimeError("there is no loop in C for the sweep")
    parts = [[(k,) for k in part.tolist()] for part in np.array_split(stiffness, threads)]
    pool = ThreadPoolExecutor(threads)

    def demand(values: Mapping[str, float]) -> dict[str, codegen.Signal]:
        return {**case.inputs, "tau_h": codegen.Lag(codegen.Step(0.5, values["torque"]), 0.04)}

    one = codegen.Table(k=stiffness)
    return {
        "floor": lambda: floor.sweep(library, stiffness, torque, threads),
        "loop in C": lambda: list(pool.map(loop, parts)),
        "sweep": lambda: codegen.sweep(family, one, *given, case.inputs, **quiet),
        "sweep, inputs by run": lambda: codegen.sweep(family, both, *given, demand, **quiet),
    }


if __name__ == "__main__":
    main()

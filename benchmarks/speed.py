"""How fast and how exactly the paper's figures run, side by side.

``python benchmarks/speed.py``: for each figure every way to run it, from C written by hand for Fig. 11 to
integrators that know no events and take a tanh for dry friction. Milliseconds are the median of calls taken
in turns, so that a busy machine slows all of them alike; the ratio is to the C backend. Errors are to exact
integrations that share no code with the toolkit: the largest of any state over its range, and of any event.
``sweeps.py`` beside this file measures many runs at once.
"""

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent / "floor")]

from accuracy import FIGURES, Outcome, errors, reference  # noqa: E402
from contenders import PATIENCE, Contender, contenders  # noqa: E402

ROUNDS, FEW = 61, 3
"""Turns, and turns of what is slow; what crawls is called once."""

CRAWLS, SLOW, SHORT = 5.0, 0.1, 5e-3
"""Seconds of a call from which it does; and up to which calls are repeated."""

BASE = "Simulator.run, C backend"


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


if __name__ == "__main__":
    main()

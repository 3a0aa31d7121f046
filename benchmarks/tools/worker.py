"""One tool, one row: ``python -I worker.py SCRIPT ROW SECONDS``, what is asked as JSON on standard input.

A script has ``ROWS``, from a row's name to three functions: *prepare* makes of what is asked a model that
is ready, *run* runs it, *told* makes of both what the row compares. ``CANNOT`` has the reasons for rows
that it has not. Prints, after the word RESULT, what is known so far, in seconds of a processor, so that a
busy machine changes little: ``first``, all until the first run is done, with what is imported and compiled;
``prepare``, the median of preparing again; ``anew``, of preparing and running again, with all imported and
what a tool keeps on a disk there; ``again``, of other runs, on one core; ``compiled``, what preparing and
running took the first time more than another run; ``answer``.
"""

import gc
import importlib.util
import json
import os
import resource
import statistics
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

PREPARED, RUNS = 3, 15
"""At most."""

OVER = 99
"""The exit status of one that takes too long."""


def load(script: str) -> Any:
    spec = importlib.util.spec_from_file_location("the_tool", script)
    if spec is None or spec.loader is None:
        raise ImportError(script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def spent() -> float:
    """Seconds of a processor that this process and those that it started took."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def many(call: Callable[[], Any], most: int, seconds: float) -> tuple[Any, list[float]]:
    """The last result and what each of so many calls took, or of as many as are begun in the time.

    Before each sympy's cache is emptied.
    """
    found, times, begin = None, list[float](), time.perf_counter()
    while not times or (len(times) < most and time.perf_counter() - begin < seconds):
        if "sympy.core.cache" in sys.modules:
            sys.modules["sympy.core.cache"].clear_cache()
        gc.collect()
        before = spent()
        found = call()
        times.append(spent() - before)
    return found, times


def on_one_core() -> None:
    """All threads that there are, where the system can say so."""
    if hasattr(os, "sched_setaffinity"):
        core = min(os.sched_getaffinity(0))
        for thread in os.listdir("/proc/self/task"):
            os.sched_setaffinity(int(thread), {core})


def watch(seconds: float) -> None:
    """End the process once it has taken so many of a processor.

    The system's own limit of these would make its clocks coarse.
    """
    while time.process_time() < seconds:
        time.sleep(0.2)
    os._exit(OVER)


def run(tool: Any, row: str, seconds: float) -> Iterator[dict[str, Any]]:
    """What is known so far, more each time."""
    prepare, go, told = tool.ROWS[row]
    spec = json.load(sys.stdin)
    known: dict[str, Any] = {}
    try:
        # Once from nothing, then as often as there is time, once what is imported late is there.
        begin = spent()
        ready = prepare(spec)
        prepared = spent() - begin
        found = go(ready)
        first = spent() - begin
        known |= {"first": spent(), "compiled": first}
        yield known
        known |= {"prepare": prepared, "anew": first}
        if first < seconds / 5:
            for key, call in (
                ("prepare", lambda: prepare(spec)),
                ("anew", lambda: go(prepare(spec))),
            ):
                _, times = many(call, PREPARED, seconds / 20)
                known[key] = statistics.median(times)
        yield known
        on_one_core()
        found, times = many(lambda: go(ready), RUNS, seconds / 20)
        known["again"] = statistics.median(times)
        known["compiled"] -= known["again"]
        yield known
        yield {**known, "answer": told(spec, ready, found)}
    except Exception as error:  # noqa: BLE001 - whatever a tool raises is what the table shows
        first = (str(error).strip() or "no message").splitlines()[0]
        yield {**known, "error": f"{type(error).__name__}: {first}"}


def main(script: str, row: str, seconds: str) -> None:
    """Run and print."""
    sys.setrecursionlimit(20_000)
    threading.Thread(target=watch, args=(float(seconds),), daemon=True).start()
    tool = load(script)
    if row in tool.CANNOT:
        print("RESULT", json.dumps({"cannot": tool.CANNOT[row]}), flush=True)
        return
    for known in run(tool, row, float(seconds)):
        print("RESULT", json.dumps(known), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])

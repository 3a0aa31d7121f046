"""How time and memory of runs grow with samples, and with events: linearly is the promise.

``python benchmarks/many.py``. Each run is in a process of its own, after a short one that compiles what is
needed: seconds of the processor, and by how much the run raised the largest memory that the process had.
``time`` and ``memory`` are exponents, from line to line of a case: 1 is linear. ``python benchmarks/many.py
CASE BACKEND COUNT`` is one run, as JSON.
"""

import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

import bondgraph as bg  # noqa: E402
from codegen import Result, Simulator, Square, Streamed, simulator  # noqa: E402

Run = Callable[[int], Result | Streamed]
"""A run of so many samples or events."""


class Case(NamedTuple):
    """``made``: a run for a backend; ``counts``: for each backend how many of ``what`` are asked for."""

    made: Callable[[str], Run]
    what: str
    counts: dict[str, tuple[int, ...]]


def mass(*more: object, wire: str, parameters: dict[str, float], backend: str) -> Simulator:
    """A mass that a force drives, and what else is at it."""
    nodes = [bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"), *more]
    equations = bg.derive(bg.graph(nodes, "force > j > m", *wire.split("; ")))
    return simulator(equations, parameters, backend=backend)


def oscillator(backend: str) -> Simulator:
    """A mass on a spring and a damper."""
    return mass(
        bg.C("k", "1/k", effort="F_k"), bg.R("b", "b"), wire="j > k; j > b",
        parameters={"m": 2, "k": 800, "b": 4}, backend=backend,
    )  # fmt: skip


def even(backend: str) -> Run:
    """Samples at one distance, of one second."""
    ready = oscillator(backend)
    return lambda count: ready.run(np.linspace(0, 1, count), {"v": 1.0}, {"F": 0})


def uneven(backend: str) -> Run:
    """Samples anywhere in one second."""
    ready, chance = oscillator(backend), np.random.default_rng(0)
    return lambda count: ready.run(np.sort(chance.random(count)), {"v": 1.0}, {"F": 0})


def driven(backend: str) -> Run:
    """Dry friction on a mass that a square wave drives to and fro: two crossings a period."""
    ready = mass(
        bg.R("r", law=bg.DryFriction("h")),
        wire="j > r",
        parameters={"m": 1, "h": 1},
        backend=backend,
    )
    wave = Square(1, -2, 2)
    return lambda count: ready.run([0, count / 2], {"v": 0.0}, {"F": wave})


def silent(backend: str) -> Run:
    """The same without events kept."""
    ready = mass(
        bg.R("r", law=bg.DryFriction("h")),
        wire="j > r",
        parameters={"m": 1, "h": 1},
        backend=backend,
    )
    wave = Square(1, -2, 2)
    return lambda count: ready.run([0, count / 2], {"v": 0.0}, {"F": wave}, events=False)


def switched(backend: str) -> Run:
    """A buck converter, its switch by a sine's sign, its diode by what it carries: four events a period."""
    nodes = [
        bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t)"), bg.Zero("n"),
        bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
        bg.C("c", "C", effort="v"), bg.R("r", "R"),
    ]  # fmt: skip
    graph = bg.graph(nodes, "src > s > q", "s > n > d", "n > l > L", "l > o > c", "o > r")
    numbers = {"E": 24.0, "L": 1e-3, "C": 1e-4, "R": 5.0, "w": 4e4 * np.pi}
    ready = simulator(bg.derive(graph), numbers, backend=backend)
    return lambda count: ready.run([0, count / 8e4])


def curved(backend: str) -> Run:
    """Dry friction on a mass on a spring that stiffens: located events, about four a period."""
    ready = mass(
        bg.C("k", effort="F_k", law="k*q_k + c*q_k**3"), bg.R("r", law=bg.DryFriction("h")),
        wire="j > k; j > r", parameters={"m": 1, "k": 40, "c": 10, "h": 1}, backend=backend,
    )  # fmt: skip
    wave = Square(1, -2, 2)
    return lambda count: ready.run([0, count / 2], {"v": 0.0}, {"F": wave})


def controlled(backend: str) -> Run:
    """A speed that a sampled PI law holds: so many instants, at whose ends nothing else happens."""
    law = bg.Controller(
        "pi", every=0.01, reads=["v"], states={"z": 0.0}, update={"z": "z + (1 - v)"},
        gives={"push": "2*(1 - v) + z/10"},
    )  # fmt: skip
    nodes = [
        bg.Se("force", "1*push"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("b", "b"), law
    ]  # fmt: skip
    equations = bg.derive(bg.graph(nodes, "force > j > m", "j > b"))
    ready = simulator(equations, {"m": 1, "b": 1}, backend=backend)
    return lambda count: ready.run([0, count / 100])


def chain(backend: str) -> Simulator:
    """Five masses in a row on springs: ten signals are asked for."""
    nodes: list[object] = [bg.Se("force", "F")]
    bonds = ["force > j0"]
    for k in range(5):
        nodes += [bg.One(f"j{k}"), bg.I(f"m{k}", "m", flow=f"v{k}"), bg.R(f"b{k}", "b")]
        nodes += [bg.C(f"k{k}", "1/k", effort=f"F{k}")]
        bonds += [f"j{k} > m{k}", f"j{k} > b{k}", f"z{k} > k{k}" if k else "j0 > k0"]
        if k:
            nodes.append(bg.Zero(f"z{k}"))
            bonds.append(f"j{k - 1} > z{k} > j{k}")
    return simulator(
        bg.derive(bg.graph(nodes, *bonds)), {"m": 1, "b": 0.1, "k": 40}, backend=backend
    )


TEN = tuple(f"{kind}{k}" for kind in "vF" for k in range(5))


def kept(backend: str) -> Run:
    """A run of ten states, in memory."""
    ready, wave = chain(backend), Square(1, -2, 2)
    return lambda count: ready.run(np.linspace(0, 10, count), inputs={"F": wave})


def streamed(ending: str) -> Callable[[str], Run]:
    """The same, its ten states written to a file."""

    def made(backend: str) -> Run:
        ready, wave = chain(backend), Square(1, -2, 2)

        def run(count: int) -> Streamed:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / f"run{ending}"
                times = np.linspace(0, 10, count)
                return ready.stream(path, times, inputs={"F": wave}, signals=TEN)

        return run

    return made


TURNS, ENOUGH = 5, 2.0
"""So many runs are taken, unless they have taken so many seconds."""

SAMPLES = (125_000, 250_000, 500_000, 1_000_000)
EVENTS = {"c": (10_000, 100_000, 1_000_000), "numpy": (1_000, 10_000, 100_000)}
CASES = {
    "even": Case(even, "samples", {"numpy": SAMPLES, "c": SAMPLES}),
    "uneven": Case(uneven, "samples", {"numpy": SAMPLES, "c": SAMPLES}),
    "driven": Case(driven, "events", EVENTS),
    "silent": Case(silent, "events", {"c": EVENTS["c"], "numpy": (1_000, 10_000)}),
    "switched": Case(switched, "events", EVENTS),
    "curved": Case(curved, "events", {"c": EVENTS["c"], "numpy": (300, 1_000, 3_000)}),
    "kept": Case(kept, "samples", {"numpy": SAMPLES, "c": SAMPLES}),
    "csv": Case(streamed(".csv"), "samples", {"numpy": SAMPLES, "c": SAMPLES}),
    "parquet": Case(streamed(".parquet"), "samples", {"numpy": SAMPLES, "c": SAMPLES}),
    "controlled": Case(controlled, "instants", EVENTS),
}


def one(case: str, backend: str, count: int) -> None:
    """Some runs, more where they are short: seconds of the quickest, megabytes of the first, events."""
    run, found, more = CASES[case].made(backend), list[float](), 0.0
    run(100)
    before = peak()
    while len(found) < TURNS and sum(found) < ENOUGH:
        begin = time.process_time()
        done = run(count)
        found.append(time.process_time() - begin)
        more = more if len(found) > 1 else peak() - before
        events = done.events if isinstance(done, Streamed) else len(done.events)
        backend = done.backend
        del done
    told = (min(found), more, events, backend)
    print(json.dumps(dict(zip(("seconds", "megabytes", "events", "backend"), told, strict=True))))


def peak() -> float:
    """The largest memory that this process has had [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def exponent(before: float, after: float, counts: tuple[int, int]) -> str:
    """Of the growth from one count to another; blank where there was too little to tell."""
    if min(before, after) <= 0:
        return ""
    return f"{math.log(after / before) / math.log(counts[1] / counts[0]):.2f}"


def table(name: str, case: Case, backend: str) -> None:
    """A case's lines."""
    last: tuple[int, dict[str, float]] | None = None
    for count in case.counts[backend]:
        command = [sys.executable, __file__, name, backend, str(count)]
        found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        seconds, memory = found["seconds"], found["megabytes"]
        grown = ["", ""]
        if last is not None:
            both = last[0], count
            grown = [
                exponent(last[1][part], found[part], both) for part in ("seconds", "megabytes")
            ]
        asked = f"{count:,} {case.what}"
        print(
            f"{f'{name}, {backend}':<20}{asked:>20}{found['events']:>10}{seconds:>10.3f}{grown[0]:>7}"
            f"{memory:>10.1f}{grown[1]:>8}",
            flush=True,
        )
        assert found["backend"] == backend, found
        last = count, found


def main() -> None:
    """Every case by each backend."""
    print(f"{'':<20}{'asked':>20}{'events':>10}{'seconds':>10}{'time':>7}{'MB':>10}{'memory':>8}")
    for name, case in CASES.items():
        for backend in case.counts:
            table(name, case, backend)


if __name__ == "__main__":
    if len(sys.argv) == 4:
        one(sys.argv[1], sys.argv[2], int(sys.argv[3]))
    else:
        main()

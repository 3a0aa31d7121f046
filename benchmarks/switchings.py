"""Runs with many events, side by side: a pulsed converter beside exact steps by hand; chains with friction.

``python benchmarks/switchings.py``. The converter switches 4,000 times in 0.1 s by time alone, its diode as
often. Milliseconds of the processor are the median of runs taken in turns; ratios are to what is written by
hand in the same language, which knows that the current never ends. Of chains of masses with friction at
each: events per second, of ten masses and of a hundred.
"""

import ctypes
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import networkx as nx
import numpy as np
import scipy.linalg

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

import bondgraph as bg  # noqa: E402
from codegen import Simulator, Sine, simulator  # noqa: E402

TURNS = 5
FLAGS = "-O3 -march=native -std=c99 -Wall -Wextra -Werror"
HALVES, EACH = 4000, 4
P = {"E": 24.0, "L": 1e-3, "C": 1e-4, "R": 5.0, "w": 4e4 * np.pi}
HALF = np.pi / P["w"]
"""A half period [s]."""

Run = Callable[[], tuple[float, int]]
"""A run; the voltage at its end and how many events it had."""


def converter() -> bg.StateEquations:
    """A buck converter, its switch by a sine's sign."""
    g = nx.DiGraph()
    g.add_nodes_from([
        bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t)"), bg.Zero("n"),
        bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
        bg.C("c", "C", effort="v"), bg.R("r", "R"),
    ])  # fmt: skip
    for path in ("src s q", "s n d", "n l L", "l o c", "o r"):
        nx.add_path(g, path.split())
    return bg.derive(g)


def by_hand() -> tuple[float, int]:
    """Exact steps in numpy; samples and events are kept."""
    on = np.array([[0, -1 / P["L"], P["E"] / P["L"]],
                   [1 / P["C"], -1 / (P["R"] * P["C"]), 0], [0, 0, 0]])  # fmt: skip
    off = on.copy()
    off[0, 2] = 0
    steps = [scipy.linalg.expm(M * HALF) for M in (on, off)]
    z, rows, events = np.array([0.0, 0.0, 1.0]), np.zeros((HALVES // EACH + 1, 2)), []
    for k in range(HALVES):
        z = steps[k % 2] @ z
        if z[0] < 0:
            raise ValueError("the current ends")
        events += [((k + 1) * HALF, "q"), ((k + 1) * HALF, "d")]
        if (k + 1) % EACH == 0:
            rows[(k + 1) // EACH] = z[:2]
    return float(rows[-1, 1]), len(events)


def in_c(folder: Path) -> Run:
    """The same in C."""
    library = folder / "buck.so"
    command = [
        os.environ.get("CC", "cc"),
        *shlex.split(os.environ.get("CFLAGS", FLAGS)),
        "-shared",
        "-fPIC",
    ]
    source = Path(__file__).parent / "floor" / "buck_floor.c"
    subprocess.run([*command, str(source), "-o", str(library), "-lm"], check=True)
    function = ctypes.CDLL(str(library)).buck_run
    p = np.array([P["E"], P["L"], P["C"], P["R"], HALF])
    rows, events = np.zeros((HALVES // EACH + 1, 2)), np.zeros(2 * HALVES)
    pointers = [
        array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for array in (p, rows, events)
    ]

    def run() -> tuple[float, int]:
        done = function(pointers[0], HALVES, EACH, *pointers[1:])
        return float(rows[-1, 1]), 2 * done

    return run


def engine_of(ready: Simulator) -> Run:
    """The exact engine in C alone, without what Python does around it."""
    times = HALF * EACH * np.arange(HALVES // EACH + 1)
    signals = ready.sources(0.0, float(times[-1]))
    assert ready.engine is not None
    prepared = ready.engine.prepare(times, np.zeros(2), signals, ready.closed.program.before(()))
    status = prepared.call()
    library, arguments = prepared.engine.library, prepared.arguments

    def run() -> tuple[float, int]:
        assert library.ex_run(*arguments) == status
        return float(prepared.rows[-1, 1]), prepared.task.count

    return run


def whole(ready: Simulator) -> Run:
    """A run with all that it records."""
    times = HALF * EACH * np.arange(HALVES // EACH + 1)

    def run() -> tuple[float, int]:
        done = ready.run(times)
        return float(done["v"][-1]), len(done.events)

    return run


def pulses(folder: Path) -> None:
    """The converter's table."""
    equations = converter()
    in_numpy, compiled = (simulator(equations, P, backend=name) for name in ("numpy", "c"))
    ways = {
        "numpy by hand": by_hand, "Simulator.run, numpy": whole(in_numpy), "C by hand": in_c(folder),
        "the exact engine in C": engine_of(compiled), "Simulator.run, C backend": whole(compiled),
    }  # fmt: skip
    times: dict[str, list[float]] = {name: [] for name in ways}
    for turn in range(TURNS + 1):
        for name, run in ways.items():
            start = time.process_time()
            voltage, events = run()
            if turn:
                times[name].append(time.process_time() - start)
            assert abs(voltage - 11.99984359365) < 1e-8, (name, voltage)
            assert abs(events - 2 * HALVES) <= 2, (name, events)
    medians = {name: statistics.median(found) for name, found in times.items()}
    print(f"{f'{HALVES} switchings by time':<40}{'ms per run':>12}{'ratio':>10}")
    for name, seconds in medians.items():
        base = "numpy by hand" if "numpy" in name else "C by hand"
        print(f"{name:<40}{1e3 * seconds:>12.5g}{seconds / medians[base]:>10.3g}")


def chain(count: int, backend: str = "numpy") -> Simulator:
    """Masses in a row, springs between, each rubbing on the ground."""
    g = nx.DiGraph()
    g.add_nodes_from([bg.Se("force", "F")])
    for i in range(count):
        g.add_nodes_from([bg.One(f"j{i}"), bg.I(f"m{i}", "m", flow=f"v{i}"), bg.R(f"b{i}")])
        g.add_edges_from([(f"j{i}", f"m{i}"), (f"j{i}", f"b{i}")])
    for i in range(count - 1):
        g.add_nodes_from([bg.Zero(f"z{i}"), bg.C(f"k{i}", "1/k")])
        g.add_edges_from([(f"j{i}", f"z{i}"), (f"z{i}", f"k{i}"), (f"z{i}", f"j{i + 1}")])
    g.add_edge("force", "j0")
    friction = {f"b{i}": bg.DryFriction("N") for i in range(count)}
    return simulator(bg.derive(g), {"m": 2.0, "k": 50.0, "N": 1.0}, friction, backend=backend)


def chains() -> None:
    """Events per second of chains whose masses begin at speeds of their own."""
    print(f"\n{'masses with friction':<24}{'events':>8}{'of them':>34}{'per second':>12}{'ten':>8}")
    for backend in ("numpy", "c"):
        rates: list[float] = []
        for count, end in ((10, 8.0), (100, 0.6)):
            ready, asked = chain(count, backend), {"F": Sine(60, 1)}
            start = {f"v{i}": 0.4 * float(np.sin(1 + 2.7 * i * i)) for i in range(count)}
            for method in ("auto", "DOP853"):  # what either needs is compiled
                ready.run([0.0, 1e-3], start, asked, method)
            begin = time.process_time()
            events = ready.run(np.linspace(0, end, 31), start, asked).events
            rates.append(len(events) / (time.process_time() - begin))
            kinds = [event.kind for event in events]
            told = ", ".join(f"{kinds.count(kind)} {kind}" for kind in ("stick", "slip", "cross"))
            of_ten = rates[0] / rates[-1]
            print(
                f"{f'{count}, {backend}':<24}{len(events):>8}{told:>34}{rates[-1]:>12.4g}{of_ten:>8.3g}"
            )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        pulses(Path(made))
    chains()

"""A drive cycle of 1800 s over a map of 17 by 12 points, in C: generated, and written by hand.

``python benchmarks/cycle.py``: a car whose driver asks for torque by how far it is behind the cycle, given at
each second; the motor's map is over its speed and that demand. By hand there is DOP853 from second to second
with a bilinear lookup, in C for this one car (`floor/cycle_floor.c`): its steps are shorter at the map's
corners, which it does not know. Exported C and the engine locate them. All keep speeds at whole seconds, and
have errors over the range of the speed, to the engine at tight tolerances; by hand there are the tolerance of
the others and the loosest at which the error is no larger than theirs. Milliseconds of the processor are
medians of calls in turns.
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
from ctypes import POINTER, c_double, c_int
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent)]

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from codegen.tuning import TUNING  # noqa: E402

ROUNDS, TIGHT = 15, 1e-13
SECONDS = 1800
FLAGS = "-O3 -march=native -std=c99"
NUMBERS = {"n": 18.0, "k": 0.4, "m": 1500.0, "c_0": 12.0, "c_1": 0.4}
DOUBLES = POINTER(c_double)

Array = np.ndarray[Any, np.dtype[np.float64]]


def wanted() -> Array:
    """The speeds of the cycle at whole seconds [m/s]: stretches of 20 s, and a driver's unrest on them."""
    rng, t = np.random.default_rng(1), np.arange(SECONDS + 1.0)
    knots = np.arange(0.0, SECONDS + 1, 20)
    speeds = np.clip(np.cumsum(rng.normal(0, 4, len(knots))) + 12, 0, 33)
    speeds[[0, -1]] = 0.0
    return np.clip(np.interp(t, knots, speeds) + 0.2 * np.sin(t / 3), 0, None)


def motor() -> tuple[Array, Array, Array]:
    """Speeds [rad/s], demands, and the torque there [N m]."""
    w, u = np.linspace(0, 800, 17), np.linspace(0, 1, 12)
    W, U = np.meshgrid(w, u, indexing="ij")
    brakes = 15 * (1 - U) * (W / 800) ** 0.5 * (1 + W / 1600)
    return w, u, 220 * U**0.8 * (1 - 0.3 * (W / 800) ** 2) - brakes


def car() -> bg.StateEquations:
    """A car behind its motor, a driver's demand, and the air."""
    cycle = bg.LookupTable("cycle", np.arange(SECONDS + 1.0), wanted())
    graph: nx.DiGraph[Any] = nx.DiGraph(tables=[cycle, bg.LookupTable("map", *motor())])
    graph.add_nodes_from(
        [
            bg.Se("motor", "n*map(n*v, k*(cycle(t) - v))"),
            bg.One("car"),
            bg.I("m", "m", flow="v"),
            bg.R("air", law="(c_0 + c_1*f_air)*f_air"),
        ]
    )
    graph.add_edges_from([("motor", "car"), ("car", "m"), ("car", "air")])
    return bg.derive(graph)


class _Car(ctypes.Structure):
    """``cycle_car`` of the C by hand."""

    _fields_ = [
        ("speeds", c_double * 17),
        ("demands", c_double * 12),
        ("torque", c_double * (17 * 12)),
        *((name, c_double) for name in NUMBERS),
    ]


def _library(folder: Path, name: str, sources: list[Path]) -> ctypes.CDLL:
    compiler = shlex.split(os.environ.get("CC", "cc"))
    flags = shlex.split(os.environ.get("CFLAGS", FLAGS))
    built = folder / name
    command = [*compiler, *flags, "-shared", "-fPIC", "-I", folder, *sources, "-lm", "-o", built]
    subprocess.run(command, check=True)
    return ctypes.CDLL(str(built))


def exported(folder: Path, equations: bg.StateEquations) -> tuple[Callable[[float], Array], Any]:
    """A call of exported C at a tolerance; how many corners it came to."""
    for name, text in codegen.to_c(equations, NUMBERS).items():
        (folder / name).write_text(text, encoding="utf-8")
    sources = [*sorted(folder.glob("*.c")), HERE / "floor" / "cycle_run.c"]
    library, count = _library(folder, "run.so", sources), c_int()
    times, speeds = np.arange(SECONDS + 1.0), np.empty(SECONDS + 1)

    def run(tolerance: float) -> Array:
        status = library.cycle_run(
            times.ctypes.data_as(DOUBLES), len(times), c_double(tolerance),
            speeds.ctypes.data_as(DOUBLES), ctypes.byref(count),
        )  # fmt: skip
        assert status == 0, status
        return speeds

    return run, count


def by_hand(folder: Path) -> Callable[[float], Array]:
    """A call of C by hand at a tolerance."""
    library = _library(folder, "hand.so", [HERE / "floor" / "cycle_floor.c"])
    numbers = [np.ctypeslib.as_ctypes(np.ascontiguousarray(one.ravel())) for one in motor()]
    one, cycle, speeds = _Car(*numbers, *NUMBERS.values()), wanted(), np.empty(SECONDS + 1)

    def run(tolerance: float) -> Array:
        library.cycle_by_hand(
            ctypes.byref(one), len(cycle), cycle.ctypes.data_as(DOUBLES), c_double(tolerance),
            speeds.ctypes.data_as(DOUBLES),
        )  # fmt: skip
        return speeds

    return run


def main() -> None:
    """Measure and print."""
    equations, times = car(), np.arange(SECONDS + 1.0)
    simulator = codegen.simulator(equations, NUMBERS, backend="c")
    right = simulator.run(times, {"v": 0.0}, method="DOP853", rtol=TIGHT, atol=TIGHT)["v"]

    def error(found: Array) -> float:
        return float(np.abs(found - right).max() / np.ptp(right))

    def engine(tolerance: float) -> Array:
        return simulator.run(
            times, {"v": 0.0}, method="DOP853", rtol=tolerance, atol=0.1 * tolerance
        )["v"]

    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        run, corners = exported(folder, equations)
        hand, usual = by_hand(folder), TUNING.rtol
        least = error(run(usual))
        closer = next(
            10.0 ** (-half / 4) for half in range(40, 61) if error(hand(10.0 ** (-half / 4))) <= least
            or half == 60
        )  # fmt: skip
        calls = {
            "C by hand, as exact": (hand, closer),
            "C by hand, the same tolerance": (hand, usual),
            "exported C": (run, usual),
            "Simulator.run, C backend": (engine, usual),
        }
        lasted: dict[str, list[float]] = {name: [] for name in calls}
        for _ in range(ROUNDS):
            for name, (call, tolerance) in calls.items():
                began = time.process_time()
                call(tolerance)
                lasted[name].append(1e3 * (time.process_time() - began))
        first = statistics.median(lasted["C by hand, as exact"])
        print(f"{'':<32}{'tolerance':>10}{'error':>10}{'ms':>8}{'ratio':>8}")
        for name, (call, tolerance) in calls.items():
            took = statistics.median(lasted[name])
            off = error(call(tolerance))
            print(f"{name:<32}{tolerance:>10.1e}{off:>10.1e}{took:>8.2f}{took / first:>8.2f}")
        print(f"corners that exported C located: {corners.value}")


if __name__ == "__main__":
    main()

"""The floor for generated code: Fig. 11 in hand-specialised C, stepped exactly.

Builds ``fig11_floor.c``, checks it against the independent reference of the tests and prints its
times. ``python benchmarks/floor/floor.py``; ``CC`` and ``CFLAGS`` change the compiler and its options.
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
from ctypes import POINTER, Structure, byref, c_double, c_int, c_long
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "tests"))

from references import fig11 as reference  # noqa: E402

Array = npt.NDArray[np.float64]

SAMPLES, STEP, CAPACITY = 1001, 1e-3, 64
STATES = ("omega_1", "omega_2", "tau_k1", "tau_k2", "omega_t1", "omega_t2")
COLUMNS = (*STATES, "tau_f", "omega_f")
KINDS = {0: "stick", 1: "cross", 2: "slip"}
FLAGS = "-O3 -march=native -ffp-contract=fast -std=c99 -Wall -Wextra -Wpedantic -Werror"
DOUBLES = POINTER(c_double)


class Parameters(Structure):
    """``fig11_parameters``."""

    _fields_ = [(name, c_double) for name in reference.Parameters.__dataclass_fields__]


class Controller(Structure):
    """``fig11_controller``."""

    _fields_ = [
        *((name, c_double) for name in ("gain", "reset", "wanted", "start")),
        ("every", c_int),
    ]


class Event(Structure):
    """``fig11_event``."""

    _fields_ = [("time", c_double), ("mode", c_int), ("kind", c_int)]


@dataclass(frozen=True)
class Run:
    """Rows as ``COLUMNS`` name them, and events as (time, kind)."""

    rows: Array
    events: tuple[tuple[float, str], ...]


def parameters(**overrides: float) -> Parameters:
    """The figure's numbers in C, with some replaced."""
    values = reference.Parameters(**overrides)
    return Parameters(*astuple(values))


def build(folder: Path) -> ctypes.CDLL:
    """Compile the library into a folder and load it."""
    library = folder / "fig11_floor.so"
    compiler = shlex.split(os.environ.get("CC", "gcc"))
    flags = shlex.split(os.environ.get("CFLAGS", FLAGS))
    source = str(HERE / "fig11_floor.c")
    ending = ["-shared", "-fPIC", "-o", str(library), source, "-lm", "-pthread"]
    subprocess.run([*compiler, *flags, *ending], check=True)
    loaded = ctypes.CDLL(str(library))
    loaded.fig11_prepare.restype = None
    loaded.fig11_drive_rhs.restype = c_double
    return loaded


def simulate(library: ctypes.CDLL, samples: int = SAMPLES, **overrides: float) -> Run:
    """One run with the exponentials built anew."""
    rows, events = np.empty((samples, len(COLUMNS))), (Event * CAPACITY)()
    given = byref(parameters(**overrides))
    count = library.fig11_run_anew(given, c_double(STEP), samples, _at(rows), events, CAPACITY)
    if not 0 <= count <= CAPACITY:
        raise RuntimeError(f"fig11_run_anew returned {count}")
    return Run(rows, tuple((event.time, KINDS[event.kind]) for event in events[:count]))


def errors(run: Run, expected: reference.Reference) -> tuple[Array, Array]:
    """Per column the largest error over its range, and each event's error [s]."""
    columns = np.column_stack([expected.states, expected.tau_f, expected.omega_f])
    if [kind for _, kind in run.events] != [kind for _, kind in expected.events]:
        raise RuntimeError(f"events differ: {run.events} and {expected.events}")
    late = [a - b for (a, _), (b, _) in zip(run.events, expected.events, strict=True)]
    spans = np.maximum(np.ptp(columns, axis=0), 1e-300)
    return np.abs(run.rows - columns).max(axis=0) / spans, np.array(late)


def median_time(call: Callable[[], object], repeats: int) -> float:
    """The median seconds of a call, after a few to warm up."""
    times = []
    for repeat in range(repeats + 3):
        start = time.perf_counter()
        call()
        if repeat >= 3:
            times.append(time.perf_counter() - start)
    return statistics.median(times)


def run_times(library: ctypes.CDLL, repeats: int = 5000) -> tuple[float, float, float]:
    """Seconds of a run built anew, of one from a ready context, and of a call that does nothing.

    The third is what ctypes adds to each of the first two.
    """
    rows, events = np.empty((SAMPLES, len(COLUMNS))), (Event * CAPACITY)()
    out, given, step = _at(rows), byref(parameters()), c_double(STEP)
    context = ctypes.create_string_buffer(1 << 14)
    library.fig11_prepare(given, step, context)
    anew, ready = library.fig11_run_anew, library.fig11_run
    return (
        median_time(lambda: anew(given, step, SAMPLES, out, events, CAPACITY), repeats),
        median_time(lambda: ready(context, SAMPLES, out, events, CAPACITY), repeats),
        median_time(lambda: ready(context, 1, out, events, CAPACITY), repeats),
    )


def rhs_time(library: ctypes.CDLL, calls: int = 1_000_000) -> float:
    """Seconds per right-hand side, each with an Euler step that feeds it back."""
    given, dt = byref(parameters()), c_double(1e-6)
    return median_time(lambda: library.fig11_drive_rhs(given, c_long(calls), dt), 21) / calls


def sweep(
    library: ctypes.CDLL, stiffness: Array, torque: Array, threads: int
) -> tuple[Array, Array]:
    """Peak halfshaft torque and instant of lock of each run."""
    count = stiffness.size
    peak, lock = np.empty(count), np.empty(count)
    arrays = [_at(values) for values in (stiffness, torque, peak, lock)]
    given = byref(parameters())
    failed = library.fig11_sweep_threads(given, c_double(STEP), SAMPLES, count, *arrays, threads)
    if failed:
        raise RuntimeError(f"{failed} runs of the sweep failed")
    return peak, lock


def sweep_rate(library: ctypes.CDLL, threads: int, count: int = 4000) -> float:
    """Runs per second, each with its own stiffness and clutch torque."""
    stiffness, torque = grid(count)
    return count / median_time(lambda: sweep(library, stiffness, torque, threads), 15)


def grid(count: int) -> tuple[Array, Array]:
    """Stiffnesses and clutch torques of a sweep."""
    torque = 600.0 + 800.0 * (0.618 * np.arange(count, dtype=np.float64) % 1.0)
    return np.linspace(4300.0, 17200.0, count), np.asarray(torque, dtype=np.float64)


def _at(values: Array) -> object:
    return values.ctypes.data_as(DOUBLES)


def report(library: ctypes.CDLL) -> None:
    """Print accuracy and times."""
    run = simulate(library)
    wrong, late = errors(run, reference.fig11())
    print(f"{'signal':<10}largest error over range")
    for name, error in zip(COLUMNS, wrong, strict=True):
        print(f"{name:<10}{error:.1e}")
    for (instant, kind), error in zip(run.events, late, strict=True):
        print(f"{kind} at {instant:.13f} s, {error:+.1e} s from the reference")
    anew, ready, empty = (1e3 * seconds for seconds in run_times(library))
    print(f"\n{anew:.5f} ms per run of {SAMPLES} samples, exponentials built anew")
    print(f"{ready:.5f} ms per run, exponentials kept")
    print(f"{empty:.5f} ms of each are the call through ctypes")
    print(f"{1e9 * rhs_time(library):.2f} ns per right-hand side, with an Euler step")
    for threads in (1, 2):
        rate = sweep_rate(library, threads)
        print(f"{rate:,.0f} runs per second in a sweep, {threads} thread(s)")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        report(build(Path(folder)))

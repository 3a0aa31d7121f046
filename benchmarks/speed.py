"""How fast Fig. 11 runs: the hand-written floor, the C engine, the numpy loop, side by side.

``python benchmarks/speed.py``: each line the median of many runs, taken in turns so that a busy machine
slows all of them alike, and its ratio to the floor's with exponentials built anew.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent / "floor")]

import floor  # noqa: E402

import codegen  # noqa: E402
from codegen.arguments import initial_values, signals_for  # noqa: E402
from codegen.c_backend import Prepared, Status  # noqa: E402
from differentials.model import model  # noqa: E402
from differentials.scenarios import (  # noqa: E402
    _initial,
    _inputs,
    _parameters,
    scenarios,
)

ROUNDS, FEW = 41, 3
TIMES = np.linspace(0.0, 1.0, 1001)

Call = Callable[[], object]


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        calls = {**floor_calls(Path(folder)), **engine_calls()}
        medians = measured(calls)
    base = medians["floor, anew"]
    print(f"{'Fig. 11, 1001 samples':<44}{'ms per run':>12}{'ratio':>10}")
    for name, seconds in medians.items():
        print(f"{name:<44}{1e3 * seconds:>12.5f}{seconds / base:>10.2f}")


def measured(calls: dict[str, tuple[Call, int]]) -> dict[str, float]:
    """Median seconds of each, where a call makes so many runs; slow ones are called less often."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for turn in range(ROUNDS):
        for name, (call, runs) in calls.items():
            repeats = 1 if runs > 1 else 50 if name.startswith(("engine", "floor")) else 1
            if repeats == 1 and runs == 1 and turn >= FEW:
                continue
            start = time.perf_counter()
            for _ in range(repeats):
                call()
            times[name].append((time.perf_counter() - start) / (repeats * runs))
    return {name: statistics.median(found) for name, found in times.items()}


def floor_calls(folder: Path) -> dict[str, tuple[Call, int]]:
    """The hand-written run, through ctypes."""
    library = floor.build(folder)
    rows, events = np.empty((1001, len(floor.COLUMNS))), (floor.Event * floor.CAPACITY)()
    given, step = floor.byref(floor.parameters()), floor.c_double(floor.STEP)
    context = floor.ctypes.create_string_buffer(1 << 14)
    library.fig11_prepare(given, step, context)
    out, capacity = floor._at(rows), floor.CAPACITY
    return {
        "floor, anew": (
            lambda: library.fig11_run_anew(given, step, 1001, out, events, capacity), 1,
        ),
        "floor, kept": (lambda: library.fig11_run(context, 1001, out, events, capacity), 1),
    }  # fmt: skip


def engine_calls() -> dict[str, tuple[Call, int]]:
    """The C engine, alone, through cffi and with all of Python around it; and the numpy loop."""
    case, full = scenarios["fig11"], model("alsd")
    values = _parameters(full, case, {})
    fast, slow = (
        codegen.simulator(full.equations, values, laws=full.laws, backend=backend)
        for backend in ("c", "numpy")
    )
    initial, inputs = _initial(full, case, values, fast), _inputs(full, case)
    ready = prepared(fast, initial, inputs)
    if ready.call() != Status.OK:
        raise RuntimeError("the engine did not run")
    return {
        "engine in C, anew": (lambda: often(ready, 50, 1), 50),
        "engine in C, kept": (lambda: often(ready, 50, 0), 50),
        "engine through cffi, anew": (lambda: often(ready, 1, 1), 1),
        "engine through cffi, kept": (lambda: often(ready, 1, 0), 1),
        "Simulator.run, backend c": (lambda: fast.run(TIMES, initial, inputs), 1),
        "Simulator.run, backend numpy": (lambda: slow.run(TIMES, initial, inputs), 1),
    }


def often(ready: Prepared, repeats: int, anew: int) -> None:
    """Runs in one call of the engine."""
    if ready.engine.library.bg_run_often(*ready.arguments, repeats, anew) != Status.OK:
        raise RuntimeError("the engine did not run")


def prepared(
    simulator: codegen.Simulator, initial: dict[str, float], inputs: dict[str, codegen.Signal]
) -> Prepared:
    """A run of the engine, ready to be started."""
    if simulator.engine is None:
        raise RuntimeError("the simulator has no engine")
    signals = signals_for(inputs, simulator.inputs)
    given = np.array([signal(0.0) for signal in signals])
    start = simulator.vector(0.0, initial_values(initial, simulator.states), given)
    return simulator.engine.prepare(TIMES, start, signals)


if __name__ == "__main__":
    main()

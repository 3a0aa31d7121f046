"""How fast Fig. 11 runs: the hand-written floor, the C engine, the numpy loop, side by side.

``python benchmarks/speed.py``: each line the median of many runs, taken in turns so that a busy machine
slows all of them alike, and its ratio to the floor's with exponentials built anew. ``sweeps.py`` beside
this file measures many runs at once.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent / "floor")]

import floor  # noqa: E402

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from codegen.engine.runs import Prepared, Status  # noqa: E402
from codegen.runs.arguments import initial_values, signals_for  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402

ROUNDS, FEW = 41, 3
TIMES = np.linspace(0.0, 1.0, 1001)

WIDTH = 0.01
"""Of the tanh [rad/s] that stands for dry friction where an integrator knows no events."""

Call = Callable[[], object]


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        calls = {**floor_calls(Path(folder)), **engine_calls(), **scipy_calls()}
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
    case = prepared("alsd", "fig11")
    arguments = (case.equations, case.parameters, case.laws)
    fast, slow = (codegen.simulator(*arguments, backend=backend) for backend in ("c", "numpy"))
    initial, inputs = case.initial, case.inputs
    ready = engine_run(fast, initial, inputs)
    if ready.call() != Status.OK:
        raise RuntimeError("the engine did not run")
    return {
        "engine in C, anew": (lambda: often(ready, 50, 1), 50),
        "engine in C, kept": (lambda: often(ready, 50, 0), 50),
        "engine through cffi, anew": (lambda: often(ready, 1, 1), 1),
        "engine through cffi, kept": (lambda: often(ready, 1, 0), 1),
        "Simulator.run, backend c": (lambda: fast.run(TIMES, initial, inputs), 1),
        "Simulator.run, backend numpy": (lambda: slow.run(TIMES, initial, inputs), 1),
        "event loop over scipy's DOP853": (
            lambda: slow.run(TIMES, initial, inputs, method="DOP853"), 1,
        ),
    }  # fmt: skip


def scipy_calls() -> dict[str, tuple[Call, int]]:
    """What people do without a toolkit: friction as a tanh, one lambdified function, an integrator."""
    case = prepared("alsd", "fig11")
    smooth = {**case.laws, "clutch": f"tau_h*tanh(omega_f/{WIDTH})"}
    rates = bg.explicit(case.equations, laws=smooth)
    names = [*rates, sp.Symbol("tau_e"), sp.Symbol("tau_h")]
    numbers = {sp.Symbol(name): value for name, value in case.parameters.items()}
    function = sp.lambdify(names, [rate.subs(numbers) for rate in rates.values()], modules="math")
    start = [case.initial.get(str(state), 0.0) for state in rates]
    engine, clutch = (case.inputs[name] for name in ("tau_e", "tau_h"))

    def rate(t: float, x: np.ndarray) -> list[float]:
        return function(*x.tolist(), engine(t), clutch(t))

    def run(method: str) -> Call:
        return lambda: solve_ivp(
            rate, (0.0, 1.0), start, method=method, t_eval=TIMES, rtol=1e-8, atol=1e-8
        )

    return {f"tanh friction, scipy's {method}": (run(method), 1) for method in ("LSODA", "DOP853")}


def often(ready: Prepared, repeats: int, anew: int) -> None:
    """Runs in one call of the engine."""
    if ready.engine.library.bg_run_often(*ready.arguments, repeats, anew) != Status.OK:
        raise RuntimeError("the engine did not run")


def engine_run(
    simulator: codegen.Simulator, initial: Mapping[str, float], inputs: Mapping[str, codegen.Signal]
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

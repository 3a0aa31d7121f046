"""How fast sweeps of Fig. 11 run: the hand-written floor's, the loop in C alone, and `sweep`.

``python benchmarks/sweeps.py``: runs per second on one and on two threads, each the median of some
rounds in which all take turns, their ratios to the floor's, and what two threads gain. Every run has its
own stiffness and clutch torque, and gives the peak torque of a halfshaft and the instant of lock. The
torque is a parameter of the model, or the size of an input, or part of an input that a function makes.
Beside that, the same sweep of a model that is not affine: events located, steps controlled;
`magic.py` beside this file has its floors.
"""

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

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from codegen.sweeps.job import Job  # noqa: E402
from codegen.sweeps.measuring import batch_of  # noqa: E402
from differentials.laws import magic_formula_tire  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402

RUNS, BY_INPUT, LOCATED, ROUNDS = 10_000, 2_000, 100, 15
TIMES = np.linspace(0.0, 1.0, 1001)
MEASURES = {"peak": codegen.peak("tau_k1"), "lock": codegen.first_event("clutch", "stick")}
ENGAGING = codegen.Lag(codegen.Step(0.5, 1.0), 0.04)
"""The share of its torque [1] that the clutch has."""

FLOOR = "floor"

Call = tuple[Callable[[], object], int]
"""What to call, and how many runs it makes."""


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = floor.build(Path(folder))
        check(library)
        calls = {threads: sweep_calls(library, threads) for threads in (1, 2)}
        times = measured(calls)
    print(f"{'Fig. 11, 1001 samples':<22}", end="")
    print("".join(f"{head:>14}" for head in ("1 thread", "2 threads", "gain")), "   in runs per s")
    for name in calls[1]:
        rates = [median_rate(times[threads], calls[threads], name) for threads in (1, 2)]
        cells = "".join(f"{rate:>14,.0f}" for rate in rates)
        print(f"{name:<22}{cells}{median_gain(times, name):>14.3f}")
    print("over the floor's")
    for name in calls[1]:
        shares = "".join(f"{share(times[n], calls[n], name):>14.3f}" for n in (1, 2))
        gains = median_gain(times, name) / median_gain(times, FLOOR)
        print(f"{name:<22}{shares}{gains:>14.3f}")
    one, two = (located_rate(threads) for threads in (1, 2))
    print(
        f"{'magic formula tires':<22}{one:>14,.0f}{two:>14,.0f}{two / one:>14.3f}   in runs per s"
    )


def located_rate(threads: int) -> float:
    """Runs per second with tires that are not affine."""
    case = prepared("alsd", "fig11", laws={f"tire_{i}": magic_formula_tire(i) for i in (1, 2)})
    laws = {**case.laws, "clutch": bg.DryFriction("torque*s_h")}
    parameters = {**case.parameters, "torque": 1000.0}
    family = codegen.Family(case.equations, parameters, laws, backend="c")
    inputs = {"tau_e": case.inputs["tau_e"], "s_h": ENGAGING}
    stiffness, torque = floor.grid(LOCATED)
    table, seconds = codegen.Table(k=stiffness, torque=torque), []
    for _ in range(4):
        start = time.perf_counter()
        codegen.sweep(
            family, table, TIMES, MEASURES, case.initial, inputs, workers=threads, progress=False
        )
        seconds.append(time.perf_counter() - start)
    return LOCATED / statistics.median(seconds[1:])


def measured(calls: dict[int, dict[str, Call]]) -> dict[int, dict[str, list[float]]]:
    """Seconds of each call, round after round; one round before is left out."""
    times: dict[int, dict[str, list[float]]] = {n: {m: [] for m in calls[n]} for n in calls}
    for turn in range(ROUNDS + 1):
        for name in calls[1]:
            for threads, some in calls.items():
                start = time.perf_counter()
                some[name][0]()
                if turn:
                    times[threads][name].append(time.perf_counter() - start)
    return times


def median_rate(times: dict[str, list[float]], calls: dict[str, Call], name: str) -> float:
    """Runs per second."""
    return calls[name][1] / statistics.median(times[name])


def share(times: dict[str, list[float]], calls: dict[str, Call], name: str) -> float:
    """The median of the rates' ratios to the floor's of the same round."""
    scale = calls[name][1] / calls[FLOOR][1]
    pairs = zip(times[FLOOR], times[name], strict=True)
    return scale * statistics.median(base / own for base, own in pairs)


def median_gain(times: dict[int, dict[str, list[float]]], name: str) -> float:
    """How many times as fast two threads are in the same round."""
    pairs = zip(times[1][name], times[2][name], strict=True)
    return statistics.median(one / two for one, two in pairs)


def sweep_calls(library: floor.ctypes.CDLL, threads: int) -> dict[str, Call]:
    """The same sweep by the floor, by the loop in C and by `sweep`; and one with inputs by run."""
    stiffness, torque = floor.grid(RUNS)
    table = codegen.Table(k=stiffness, torque=torque)
    few = codegen.Table(k=stiffness[:BY_INPUT], torque=torque[:BY_INPUT])
    quiet = {"workers": threads, "progress": False}
    model, by_input = clutch_model("torque*s_h"), clutch_model("tau_h")
    start, engine = model[1], model[2]
    loop = batch_of(Job(model[0], table.names, TIMES, MEASURES, start, engine))
    if loop is None:
        raise RuntimeError("there is no loop in C for the sweep")
    parts = np.array_split(np.column_stack([stiffness, torque]), threads)
    pool = ThreadPoolExecutor(threads)

    sized = {
        "tau_e": engine["tau_e"],
        "tau_h": codegen.Swept("torque", codegen.Lag(codegen.Step(0.5, 1.0), 0.04)),
    }

    def demand(values: Mapping[str, float]) -> dict[str, codegen.Signal]:
        return {
            "tau_e": engine["tau_e"],
            "tau_h": codegen.Lag(codegen.Step(0.5, values["torque"]), 0.04),
        }

    given = (TIMES, MEASURES, start)
    return {
        FLOOR: (lambda: floor.sweep(library, stiffness, torque, threads), RUNS),
        "loop in C": (lambda: list(pool.map(loop, parts)), RUNS),
        "sweep": (lambda: codegen.sweep(model[0], table, *given, engine, **quiet), RUNS),
        "sweep, inputs sized": (
            lambda: codegen.sweep(by_input[0], table, *given, sized, **quiet), RUNS,
        ),
        "sweep, inputs by run": (
            lambda: codegen.sweep(by_input[0], few, *given, demand, **quiet), BY_INPUT,
        ),
    }  # fmt: skip


def clutch_model(level: str) -> tuple[codegen.Family, Mapping[str, float], dict[str, object]]:
    """The model with a clutch of this friction level, its initial values and inputs."""
    case = prepared("alsd", "fig11")
    laws = {**case.laws, "clutch": bg.DryFriction(level)}
    inputs: dict[str, object] = {"tau_e": case.inputs["tau_e"], "s_h": ENGAGING}
    parameters = {**case.parameters, "torque": 1000.0} if "torque" in level else case.parameters
    return codegen.Family(case.equations, parameters, laws, backend="c"), case.initial, inputs


def check(library: floor.ctypes.CDLL) -> None:
    """Refuse to compare what does not give the same."""
    stiffness, torque = floor.grid(50)
    peak, lock = floor.sweep(library, stiffness, torque, 1)
    model, start, inputs = clutch_model("torque*s_h")
    table = codegen.Table(k=stiffness, torque=torque)
    found = codegen.sweep(model, table, TIMES, MEASURES, start, inputs, progress=False)
    for name, expected in (("peak", peak), ("lock", lock)):
        if not np.allclose(found[name], expected, rtol=1e-9, atol=1e-12, equal_nan=True):
            raise RuntimeError(f"the sweep and the floor differ in {name}")


if __name__ == "__main__":
    main()

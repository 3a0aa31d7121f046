"""How fast sweeps of Fig. 11 run in numpy: runs by themselves, runs side by side, and the loop in C.

``python benchmarks/beside.py``: milliseconds per run on one core, each the median of some rounds in which
all take turns, and the median ratio to runs by themselves. Every run has its own stiffness and clutch
torque, and gives the peak torque of a halfshaft and the instant of lock. The torque is a parameter of the
model, or the size of an input. Beside that, as many samples as two, and a measure of one's own.
"""

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT)]

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from codegen.sweeps.job import Job  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402

RUNS, ALONE, ROUNDS = 400, 20, 9
TIMES = np.linspace(0.0, 1.0, 1001)
MEASURES: dict[str, Any] = {
    "peak": codegen.peak("tau_k1"), "lock": codegen.first_event("clutch", "stick")
}  # fmt: skip
ENGAGING = codegen.Lag(codegen.Step(0.5, 1.0), 0.04)
"""The share of its torque [1] that the clutch has."""

Call = tuple[Callable[[], object], int]
"""What to call, and how many runs it makes."""


def main() -> None:
    """Measure and print."""
    calls = ways()
    seconds: dict[str, list[float]] = {name: [] for name in calls}
    for turn in range(ROUNDS + 1):
        for name, (call, runs) in calls.items():
            start = time.perf_counter()
            call()
            if turn:
                seconds[name].append((time.perf_counter() - start) / runs)
    base = seconds[next(iter(calls))]
    print(f"{'Fig. 11, one core':<42}{'ms per run':>12}{'times as fast':>15}")
    for name, own in seconds.items():
        ratio = statistics.median(one / other for one, other in zip(base, own, strict=True))
        print(f"{name:<42}{1e3 * statistics.median(own):>12.4g}{ratio:>15.3g}")


def ways() -> dict[str, Call]:
    """Every way to run it, by name."""
    case = prepared("alsd", "fig11")
    rng = np.random.default_rng(1)
    stiffness = float(case.parameters["k"]) * rng.uniform(0.5, 2.0, RUNS)
    table = codegen.Table(k=stiffness, torque=rng.uniform(500.0, 1500.0, RUNS))
    engine = case.inputs["tau_e"]
    given = {"tau_e": engine, "s_h": ENGAGING}
    sized = {"tau_e": engine, "tau_h": codegen.Swept("torque", ENGAGING)}
    by_level, by_input = (
        {backend: family(case, level, backend) for backend in ("numpy", "c")}
        for level in ("torque*s_h", "tau_h")
    )
    job = Job(by_level["numpy"], table.names, TIMES, MEASURES, case.initial, given)
    few = [table.row(at) for at in range(ALONE)]

    def swept(
        model: codegen.Family, inputs: dict[str, Any], times: Any = TIMES, measures: Any = MEASURES
    ) -> Call:
        fixed = {"workers": 0, "progress": False}
        arguments = (model, table, times, measures, case.initial, inputs)
        return lambda: codegen.sweep(*arguments, **fixed), RUNS

    own = {**MEASURES, "own": mean_torque}
    return {
        "numpy, runs by themselves": (lambda: [job.run(row) for row in few], ALONE),
        "numpy, sweep": swept(by_level["numpy"], given),
        "numpy, sweep, inputs sized": swept(by_input["numpy"], sized),
        "numpy, sweep, two samples": swept(by_level["numpy"], given, TIMES[[0, -1]]),
        "numpy, sweep, a measure of one's own": swept(by_level["numpy"], given, TIMES, own),
        "C, sweep": swept(by_level["c"], given),
    }  # fmt: skip


def family(case: Any, level: str, backend: str) -> codegen.Family:
    """The model with a clutch of this friction level."""
    laws = {**case.laws, "clutch": bg.DryFriction(level)}
    parameters = {**case.parameters, "torque": 1000.0} if "torque" in level else case.parameters
    return codegen.Family(case.equations, parameters, laws, backend)


def mean_torque(result: codegen.Result) -> float:
    """The mean torque of the clutch."""
    return float(np.mean(result["tau_f"]))


if __name__ == "__main__":
    main()

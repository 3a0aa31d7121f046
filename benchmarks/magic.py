"""Fig. 11 with magic formula tires, by the toolkit beside C written by hand for this one model.

``python benchmarks/magic.py``: one run with all its samples, then 1,000 runs of which the peak torque of a
halfshaft and the instant of lock are kept, each with its own stiffness and clutch torque, all on one core.
By hand there are DOP853, at the tolerance with which it is as exact as is asked for, exponential steps, and
these of eight runs at once. Milliseconds of the processor are medians of calls taken in turns. Errors are to
scipy at tight tolerances, for some pairs of stiffness and torque: the largest of any state over its range, at
any sample; of a sweep that of the peak.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent), str(Path(__file__).parent / "floor")]

import floor  # noqa: E402
import magic_floor as by_hand  # noqa: E402
import nonlinear  # noqa: E402
from sweeps import ENGAGING, MEASURES, TIMES  # noqa: E402

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from codegen.engine.located import LocatedRuns  # noqa: E402

ROUNDS, RUNS, FEW = 7, 1000, 20
"""Turns; runs of a sweep; single runs in one call."""

PAIRS = ((8600, 1000), (4300, 600), (17200, 1400), (6000, 1300), (15000, 900), (17200, 600))
"""Stiffnesses and torques whose errors are looked at: the figure's, and corners of the sweep."""

TOLERANCE, LIMIT = 3e-10, 1e-6
"""Of DOP853 by hand; what every way by hand is at least as exact as."""

Array = by_hand.Array


@dataclass(frozen=True)
class Way:
    """A call, how many runs it makes, its error, and seconds that it tells instead of its own."""

    call: Callable[[], Any]
    runs: int
    error: float
    told: list[float] | None = None


class Timed(LocatedRuns):
    """Runs that tell how long calls of C took."""

    def __init__(self, runs: LocatedRuns) -> None:
        super().__init__(runs.model, runs.library)
        self.seconds = [0.0]

    def call(self, *given: Any) -> Any:
        start = time.process_time()
        found = super().call(*given)
        self.seconds[0] += time.process_time() - start
        return found


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = by_hand.build(Path(folder))
        expected = [exact(k, torque) for k, torque in PAIRS]
        single, many = singles(library, expected), sweeps(library, expected)
        times = measured({**single, **many})
    floors = times["exponential, a sweep"], times["eight at once, a sweep"]
    print(
        f"{'Fig. 11, magic formula tires':<34}{'ms a run':>10}{'/ scalar':>10}{'/ SIMD':>10}",
        end="",
    )
    print(f"{'error':>10}")
    for name, way in {**single, **many}.items():
        ratios = "".join(f"{times[name] / one:>10.2f}" for one in floors)
        print(f"{name:<34}{times[name]:>10.4f}{ratios}{way.error:>10.1e}", flush=True)


def case_of(k: float, torque: float) -> nonlinear.Case:
    """The figure with this stiffness and this torque of the clutch."""
    case, demand = nonlinear.tires(), codegen.Lag(codegen.Step(0.5, float(torque)), 0.04)
    parameters = {**case.parameters, "k": float(k)}
    return replace(case, parameters=parameters, inputs={**case.inputs, "tau_h": demand})


def exact(k: float, torque: float) -> Array:
    """Its states, in `by_hand.STATES`' order."""
    hand = nonlinear.ByHand(case_of(k, torque))
    states = hand.run(nonlinear.TIGHT, nonlinear.TIGHT)
    return states[:, [hand.names.index(name) for name in by_hand.STATES]]


def singles(library: Any, expected: list[Array]) -> dict[str, Way]:
    """One run with all its samples; the largest error of all pairs."""
    case = case_of(*PAIRS[0])
    simulator = codegen.simulator(case.equations, case.parameters, case.laws, backend="c")
    if simulator.located is None:
        raise RuntimeError("the simulator has no C")
    timed = Timed(simulator.located)
    inside = replace(simulator, located=timed)
    k, torque = (np.full(FEW, float(one)) for one in PAIRS[0])
    found = [toolkit_states(*pair) for pair in PAIRS]
    wrong = max(map(nonlinear.errors, found, expected))

    def hand(tolerance: float) -> Way:
        def call() -> by_hand.Runs:
            return by_hand.one_by_one(library, k, torque, tolerance, keep=True)

        pairs = by_hand.one_by_one(library, *columns(), tolerance, keep=True)
        return Way(call, FEW, checked(pairs, expected))

    def run(of: codegen.Simulator) -> Callable[[], Any]:
        return lambda: [of.run(case.times, case.initial, case.inputs) for _ in range(FEW)]

    return {
        "DOP853 by hand": hand(TOLERANCE),
        "exponential by hand": hand(by_hand.EXPONENTIAL),
        "Simulator.run, its C part": Way(run(inside), FEW, wrong, timed.seconds),
        "Simulator.run, C backend": Way(run(simulator), FEW, wrong),
    }


def columns() -> tuple[Array, Array]:
    """Stiffnesses and torques of the pairs."""
    k, torque = np.array(PAIRS, dtype=np.float64).T
    return k, torque


def checked(runs: by_hand.Runs, expected: list[Array]) -> float:
    """The largest error of a state; refused where it is more than a floor may have."""
    if runs.rows is None:
        raise RuntimeError("no samples were kept")
    states = runs.rows[:, :, : len(by_hand.STATES)]
    worst = max(map(nonlinear.errors, states, expected))
    if not worst < LIMIT:
        raise RuntimeError(f"by hand there are errors of {worst:.1e} of range")
    return worst


def toolkit_states(k: float, torque: float) -> Array:
    """The states that a run of the toolkit has."""
    case = case_of(k, torque)
    simulator = codegen.simulator(case.equations, case.parameters, case.laws, backend="c")
    run = simulator.run(case.times, case.initial, case.inputs)
    return np.column_stack([run[name] for name in by_hand.STATES])


def sweeps(library: Any, expected: list[Array]) -> dict[str, Way]:
    """Many runs, of which peak and lock are kept; their errors are the pairs' peaks'."""
    peaks = np.array([np.abs(states[:, 2]).max() for states in expected])
    grid, pairs = floor.grid(RUNS), columns()
    toolkit = toolkit_sweep()
    hand = {
        "DOP853": lambda k, t: by_hand.one_by_one(library, k, t, TOLERANCE),
        "exponential": lambda k, t: by_hand.one_by_one(library, k, t, by_hand.EXPONENTIAL),
        "eight at once": lambda k, t: by_hand.at_once(library, k, t),
    }
    checked(by_hand.at_once(library, *pairs, keep=True), expected)

    def way(call: Callable[[Array, Array], Any], peak: Array) -> Way:
        return Way(lambda: call(*grid), RUNS, float(np.abs(peak / peaks - 1).max()))

    rows = {f"{name}, a sweep": way(call, call(*pairs).peak) for name, call in hand.items()}
    agree(hand["eight at once"](*grid), toolkit(*grid))
    return {**rows, "codegen.sweep": way(toolkit, toolkit(*pairs)["peak"])}


def toolkit_sweep() -> Callable[[Array, Array], Any]:
    """`codegen.sweep` on one core, of stiffnesses and torques."""
    case = nonlinear.tires()
    laws = {**case.laws, "clutch": bg.DryFriction("torque*s_h")}
    parameters = {**case.parameters, "torque": 1000.0}
    family = codegen.Family(case.equations, parameters, laws, backend="c")
    given = (TIMES, MEASURES, case.initial, {"tau_e": case.inputs["tau_e"], "s_h": ENGAGING})

    def call(k: Array, torque: Array) -> Any:
        table = codegen.Table(k=k, torque=torque)
        return codegen.sweep(family, table, *given, workers=1, progress=False)

    return call


def agree(runs: by_hand.Runs, found: Any) -> None:
    """Refuse to compare what does not give the same."""
    for name, expected in (("peak", runs.peak), ("lock", runs.lock)):
        if not np.allclose(found[name], expected, rtol=1e-6, atol=0.0, equal_nan=True):
            raise RuntimeError(f"the sweep and C by hand differ in {name}")


def measured(ways: dict[str, Way]) -> dict[str, float]:
    """Median milliseconds of the processor for a run of each."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for turn in range(ROUNDS + 1):
        for name, way in ways.items():
            before = way.told[0] if way.told else 0.0
            start = time.process_time()
            way.call()
            took = way.told[0] - before if way.told else time.process_time() - start
            if turn:
                times[name].append(1e3 * took / way.runs)
    return {name: statistics.median(found) for name, found in times.items()}


if __name__ == "__main__":
    main()

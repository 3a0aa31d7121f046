"""Fig. 11's differential in a closed loop with a sampled controller, beside the same written by hand in C.

``python benchmarks/controlled.py``: a PI sets the clutch's level every 10 ms by the difference of the wheels'
speeds, so that the clutch sticks and slips 74 times in a second. Microseconds of the processor are the median
of calls taken in turns; the ratio is to C by hand, which shares no code with the engine and makes its
exponentials anew in each run. Differences are to what that finds: the largest of a state over its range, and
of an event. Then how both grow: ten times the samples in the same second, and ten seconds.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent / "floor")]

import floor  # noqa: E402
from contenders import OFTEN, engine_run, often  # noqa: E402

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from differentials.laws import coulomb_clutch  # noqa: E402
from differentials.scenarios import Prepared as Case  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402
from differentials.topologies import graph  # noqa: E402

PERIOD, TURNS, LIKE = 0.01, 41, 1e-9
"""Of the controller [s]; calls of each; differences that a run may have."""

LENGTHS = ((1.0, 1e-3), (1.0, 1e-4), (10.0, 1e-3))
"""Seconds of a run, and between samples."""

PI = {"Kp": 20.0, "Ki": 200.0, "want": 1.0, "T_a": 0.04}
START = 600.0
"""The level before the first instant [N m]."""

Way = tuple[Callable[[], object], int]
"""A call, and how many runs it makes."""


def loop(seconds: float, step: float) -> Case:
    """The case: the clutch's level follows with a lag what the controller demands."""
    case, wrong = prepared("alsd", "fig11"), "(omega_2 - omega_1 - want)"
    pi = bg.Controller(
        "pi", every=PERIOD, reads=["omega_1", "omega_2"], states={"z": START},
        update={"z": f"z + {PERIOD}*Ki*{wrong}"}, gives={"demand": f"Kp*{wrong} + z"},
    )  # fmt: skip
    controlled = graph("alsd", halfshafts=True).copy()
    controlled.add_nodes_from([pi, bg.State("tau_h", "(demand - tau_h)/T_a", start=START)])
    return replace(
        case, equations=bg.derive(controlled, outputs=["clutch"]),
        parameters={**case.parameters, **PI}, laws={**case.laws, "clutch": coulomb_clutch("tau_h")},
        inputs={"tau_e": case.inputs["tau_e"]}, initial={**case.initial, "z": START, "tau_h": START},
        times=np.arange(round(seconds / step) + 1) * step,
    )  # fmt: skip


@dataclass(frozen=True)
class ByHand:
    """The same in C by hand: ``call`` runs it and tells how many events it had, ``read`` what it found."""

    call: Callable[[], int]
    rows: floor.Array
    events: Sequence[floor.Event]

    def read(self) -> floor.Run:
        """A run's rows and events."""
        count = self.call()
        if not 0 <= count <= len(self.events):
            raise RuntimeError(f"fig11_run_closed returned {count}")
        found = self.events[:count]
        return floor.Run(self.rows, tuple((one.time, floor.KINDS[one.kind]) for one in found))


def by_hand(library: floor.ctypes.CDLL, samples: int, step: float) -> ByHand:
    """With room for as many events as there are samples."""
    rows, events = np.empty((samples, len(floor.COLUMNS))), (floor.Event * samples)()
    pi = floor.Controller(PI["Kp"], PI["Ki"], PI["want"], START, round(PERIOD / step))
    given = floor.byref(floor.parameters()), floor.byref(pi), floor.c_double(step)
    ending = samples, floor._at(rows), events, samples
    return ByHand(lambda: library.fig11_run_closed(*given, *ending), rows, events)


def compared(library: floor.ctypes.CDLL, seconds: float, step: float) -> None:
    """One length's table."""
    case = loop(seconds, step)
    hand = by_hand(library, case.times.size, step)
    run = codegen.simulator(case.equations, case.parameters, case.laws, backend="c")
    ready, found = engine_run(run, case), hand.read()
    track = ready.track(run.closed)
    ways: dict[str, Way] = {
        "C by hand": (partial(repeated, hand.call), OFTEN),
        "C engine, anew": (partial(often, ready, 1), OFTEN),
        "C engine, kept": (partial(often, ready, 0), OFTEN),
        "Simulator.run, C backend": (
            lambda: run.run(case.times, case.initial, case.inputs, events=False),
            1,
        ),
    }
    apart = differences(found, dict(zip(run.states, track.vectors.T, strict=True)), track.events)
    print(f"\n{seconds:g} s, a sample each {1e3 * step:g} ms: {len(found.events)} events, ", end="")
    print("differences {:.1e} of range, {:.1e} s".format(*apart))
    medians = measured(ways)
    for name, took in medians.items():
        print(f"{name:<28}{1e6 * took:>12.4g} us{took / medians['C by hand']:>8.2f}", flush=True)


def differences(
    found: floor.Run, states: dict[str, floor.Array], events: tuple[codegen.Event, ...]
) -> tuple[float, float]:
    """The largest of a state over its range, and of an event [s]; refused where events are others."""
    if len(events) != len(found.events):
        raise RuntimeError(f"{len(events)} events, by hand {len(found.events)}")
    columns = zip(floor.STATES, found.rows.T, strict=False)
    apart = max(float(np.abs(states[name] - by).max() / np.ptp(by)) for name, by in columns)
    late = max(abs(one.time - by) for one, (by, _) in zip(events, found.events, strict=True))
    if max(apart, late) > LIKE:
        raise RuntimeError(f"runs differ: {apart:.1e} of range, {late:.1e} s")
    return apart, late


def measured(ways: dict[str, Way]) -> dict[str, float]:
    """Median seconds of the processor for a run of each."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(TURNS):
        for name, (call, runs) in ways.items():
            start = time.process_time()
            call()
            times[name].append((time.process_time() - start) / runs)
    return {name: statistics.median(found) for name, found in times.items()}


def repeated(call: Callable[[], object]) -> None:
    """As many runs as one call of the engine makes."""
    for _ in range(OFTEN):
        call()


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = floor.build(Path(folder))
        for seconds, step in LENGTHS:
            compared(library, seconds, step)


if __name__ == "__main__":
    main()

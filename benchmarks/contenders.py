"""The ways to run one of the paper's figures that `speed.py` puts side by side."""

import ctypes
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp
from accuracy import FIGURES, Outcome
from scipy.integrate import solve_ivp
from sksundae.cvode import CVODE

sys.path.insert(0, str(Path(__file__).parent / "floor"))

import floor

import bondgraph as bg
import codegen
from codegen.engine.runs import Prepared
from codegen.engine.status import Status
from codegen.runs.arguments import initial_values, signals_for
from differentials.prepared import Prepared as Case
from differentials.scenarios import prepared

OFTEN = 50
"""Runs in one call of the C engine."""

WIDTH = 0.01
"""Of the tanh [rad/s] that stands for dry friction where an integrator knows no events."""

LOOSE = 1e-8
"""Tolerances that such an integrator is given."""

PATIENCE = 20.0
"""How long [s] one may take; where a tanh makes clutches stiff explicit ones take minutes."""


@dataclass(frozen=True)
class Contender:
    """``call`` makes so many ``runs``; from what it returns ``outcome`` reads what they found.

    It raises `TimeoutError` where patience ends.
    """

    call: Callable[[], Any]
    outcome: Callable[[Any], Outcome]
    runs: int = 1


def contenders(figure: str, folder: Path) -> dict[str, Contender]:
    """Every way to run a figure, by name; the floor in C only where it was written by hand."""
    case = prepared(FIGURES[figure], figure)
    by_hand = by_floor(folder) if figure == "fig11" else {}
    return {**by_hand, **by_engine(case), **by_simulator(case), **by_tanh(case)}


def by_floor(folder: Path) -> dict[str, Contender]:
    """The hand-written run, through ctypes."""
    library = floor.build(folder)
    rows, events = np.empty((1001, len(floor.COLUMNS))), (floor.Event * floor.CAPACITY)()
    given, step = floor.byref(floor.parameters()), floor.c_double(floor.STEP)
    context = ctypes.create_string_buffer(1 << 14)
    library.fig11_prepare(given, step, context)
    ending = (1001, floor._at(rows), events, floor.CAPACITY)

    def anew() -> int:
        return int(library.fig11_run_anew(given, step, *ending))

    def kept() -> int:
        return int(library.fig11_run(context, *ending))

    def outcome(count: int) -> Outcome:
        times = tuple(event.time for event in events[:count])
        return Outcome(dict(zip(floor.COLUMNS, rows.T.copy(), strict=True)), times)

    return {f"C by hand, {run.__name__}": Contender(run, outcome) for run in (anew, kept)}


def by_engine(case: Case) -> dict[str, Contender]:
    """The C engine without Python around it, with the exponentials built anew and kept."""
    simulator = codegen.simulator(case.equations, case.parameters, case.laws, backend="c")
    ready = engine_run(simulator, case)

    def outcome(_: None) -> Outcome:
        track = ready.track(simulator.closed)
        columns = dict(zip(simulator.states, track.vectors.T, strict=True))
        return Outcome(columns, tuple(event.time for event in track.events))

    return {
        "C engine, anew": Contender(lambda: often(ready, 1), outcome, OFTEN),
        "C engine, kept": Contender(lambda: often(ready, 0), outcome, OFTEN),
    }


def engine_run(simulator: codegen.Simulator, case: Case) -> Prepared:
    """A run of the engine, started once so that its modes are there."""
    if simulator.engine is None:
        raise RuntimeError("the simulator has no engine")
    signals = signals_for(case.inputs, simulator.inputs)
    given = np.array([signal(0.0) for signal in signals])
    start = simulator.vector(0.0, initial_values(case.initial, simulator.states), given)
    ready = simulator.engine.prepare(case.times, start, signals)
    if ready.call() != Status.OK:
        raise RuntimeError("the engine did not run")
    return ready


def often(ready: Prepared, anew: int) -> None:
    """Runs in one call of the engine."""
    if ready.engine.library.ex_run_often(*ready.arguments, OFTEN, anew) != Status.OK:
        raise RuntimeError("the engine did not run")


def by_simulator(case: Case) -> dict[str, Contender]:
    """`Simulator.run` with all of Python around it: both backends, and the event loop's integrators."""
    return {
        "Simulator.run, C backend": by_method(case, "c", "auto"),
        "Simulator.run, C with located events": by_method(case, "c", "DOP853"),
        "Simulator.run, numpy backend": by_method(case, "numpy", "exact"),
        "Simulator.run, scipy's DOP853": by_method(case, "numpy", "DOP853"),
        "Simulator.run, SUNDIALS' CVODE": by_method(case, "numpy", "CVODE"),
    }


def by_method(case: Case, backend: str, method: str) -> Contender:
    """One of them."""
    simulator = codegen.simulator(case.equations, case.parameters, case.laws, backend=backend)

    def run() -> codegen.Result:
        return simulator.run(case.times, case.initial, case.inputs, method=method)

    def outcome(found: codegen.Result) -> Outcome:
        times = tuple(event.time for event in found.events)
        return Outcome({name: found[name] for name in found.states}, times)

    return Contender(run, outcome)


def by_tanh(case: Case) -> dict[str, Contender]:
    """What people do without a toolkit: friction as a tanh, one lambdified function, an integrator."""
    rates = bg.explicit(case.equations, laws=smoothed(case))
    names, signals = [str(state) for state in rates], list(case.inputs.values())
    numbers = {sp.Symbol(name): value for name, value in case.parameters.items()}
    function = sp.lambdify(
        [*rates, *map(sp.Symbol, case.inputs)], [rate.subs(numbers) for rate in rates.values()],
        modules="math", cse=True,
    )  # fmt: skip
    start = np.array([case.initial.get(name, 0.0) for name in names])
    times = case.times

    began = [0.0]

    def rate(t: float, x: np.ndarray) -> list[float]:
        if time.perf_counter() - began[0] > PATIENCE:
            raise TimeoutError
        return list(function(*x.tolist(), *(signal(t) for signal in signals)))

    def fill(t: float, x: np.ndarray, out: np.ndarray) -> None:
        out[:] = rate(t, x)

    def scipy_run(method: str) -> np.ndarray:
        began[0] = time.perf_counter()
        span = (times[0], times[-1])
        found = solve_ivp(rate, span, start, method=method, t_eval=times, rtol=LOOSE, atol=LOOSE)
        return found.y

    def cvode_run() -> np.ndarray:
        began[0] = time.perf_counter()
        solver = CVODE(fill, rtol=LOOSE, atol=LOOSE, max_num_steps=100_000)
        return solver.solve(times, start).y.T

    def outcome(found: np.ndarray) -> Outcome:
        return Outcome(dict(zip(names, found, strict=True)), None)

    return {
        "tanh friction, scipy's LSODA": Contender(lambda: scipy_run("LSODA"), outcome),
        "tanh friction, scipy's DOP853": Contender(lambda: scipy_run("DOP853"), outcome),
        "tanh friction, SUNDIALS' CVODE": Contender(cvode_run, outcome),
    }


def smoothed(case: Case) -> dict[object, object]:
    """The laws with a tanh of the slip for each dry friction."""
    slips = {port.element.name: port.received for port in case.equations.ports}
    return {
        node: law.level * sp.tanh(slips[node] / WIDTH) if isinstance(law, bg.DryFriction) else law
        for node, law in case.laws.items()
    }

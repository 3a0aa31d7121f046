"""Random graphs with laws, moving values and tables against all their bond equations at once.

Nothing of the toolkit is asked how: each element's equation is written down as it is drawn, junctions' sums
with the signs of their arrows, and all are solved together, with their slopes in time.
"""

import random
import re
import warnings
from collections.abc import Collection, Mapping

import numpy as np
import pytest
from oracles.exported import loaded
from references.nonlinear.drawn import Drawn, drawn
from references.nonlinear.genuine import reason
from references.nonlinear.judge import Judge, solved
from references.nonlinear.radau import Stuck, followed
from references.nonlinear.told import judged, pinned, summed, unknowns
from soak.families import seeds

import bondgraph as bg
from codegen import Result, Signal, Simulator, Sine, simulator, to_python

CLOSE, CLOSE_RUN, STEP = 1e-9, 1e-6, 1e-10
SLOPES = 1e-7
"""Of what a known source drives by its slope: sources are polynomials to 1e-10, piece by piece."""
LAST, SAMPLES = 1.0, 6


def _ready(made: Drawn, backend: str = "numpy") -> Simulator | None:
    """What runs a graph; None where it is refused, and rightly so."""
    try:
        equations = bg.derive(made.graph, outputs=[], inputs=made.inputs)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", bg.ModelWarning)
            return simulator(equations, made.parameters, backend=backend)
    except bg.BondGraphError as error:
        assert reason(made, error)  # noqa: PT017
        return None


def _begun(rng: random.Random, ready: Simulator) -> tuple[dict[str, Signal], dict[str, float]]:
    """Inputs that swing, and where states begin."""
    signals: dict[str, Signal] = {
        name: Sine(rng.uniform(0.5, 2), rng.uniform(0.3, 1), rng.uniform(0, 6))
        for name in ready.inputs
    }
    return signals, {name: rng.uniform(-1, 1) for name in ready.states}


@pytest.mark.parametrize("seed", seeds("nonlinear"))
def test_all_bond_equations_hold_at_an_instant_and_a_moment_later(seed: int) -> None:
    rng = random.Random(f"nonlinear {seed}")
    made = drawn(rng, rng.randint(4, 12))
    ready = _ready(made)
    if ready is None:
        return
    signals, states = _begun(rng, ready)
    t = rng.uniform(0, 2)
    judge = judged(made, signals)
    try:
        run = ready.run([t, t + 1e-7], states, signals)
    except bg.SimulationError as error:
        _check_refusal(made, judge, states, t, error)
        return
    z = unknowns(judge, run)[0]
    pins = pinned(made, judge, states, z)
    found = solved(judge, t, pins, z.copy())
    assert found.left < CLOSE
    assert found.told.all()
    size = 1 + np.abs(z[judge.held :]).max()
    told = SLOPES if _driven(made) else CLOSE
    assert np.abs(found.z - z)[judge.held :].max() < told * size
    _check_rates(made, ready, signals, states, t, found.z)


def _driven(made: Drawn) -> bool:
    """Whether a known source drives a dependent storage."""
    return any(made.graph.nodes[node]["kind"] in ("Se", "Sf") for node in made.driving)


def _check_rates(
    made: Drawn, ready: Simulator, signals: Mapping[str, Signal], states: Mapping[str, float],
    t: float, z: np.ndarray,
) -> None:  # fmt: skip
    """Of the simulator with inputs held, of exported Python with inputs that move."""
    x = [states[name] for name in ready.states]
    u = [signals[name](t) for name in ready.inputs]
    du = [signals[name].piece(0.0).derivative(t) for name in ready.inputs]
    closed = ready.closed
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bg.ModelWarning)
        module = loaded(to_python(closed.equations, made.parameters)).Model()
    for still, rates in ((True, ready.rhs(t, x, u)), (False, module.rhs(t, x, u, du))):
        judge = judged(made, signals, still)
        names = judge.written.names
        pins = {names[name]: value for name, value in states.items() if not summed(made, name)}
        for name in states:
            if summed(made, name):
                k = names[("f" if name[0] == "p" else "e") + name[1:]]
                pins[k] = float(z[k])
        found = solved(judge, t, pins, z.copy())
        for name, rate in zip(ready.states, rates, strict=True):
            if not summed(made, name):
                assert found.told_rates[names[name]], name
                right = found.rates[names[name]]
                told = SLOPES if _driven(made) else CLOSE
                assert rate == pytest.approx(
                    right, rel=told, abs=told * (1 + np.abs(found.z).max())
                )


@pytest.mark.parametrize("seed", seeds("nonlinear-runs"))
def test_whole_runs_are_those_of_all_bond_equations_integrated_at_once(seed: int) -> None:
    rng = random.Random(f"nonlinear run {seed}")
    made = drawn(rng, rng.randint(4, 11))
    ready = _ready(made, rng.choice(["numpy", "numpy", "c"]))
    if ready is None:
        return
    signals, states = _begun(rng, ready)
    judge, times = judged(made, signals), np.linspace(0, LAST, SAMPLES)
    try:
        run = ready.run(times, states, signals)
    except bg.SimulationError as error:
        _check_refusal(made, judge, states, 0.0, error)
        return
    _check_run(made, judge, states, run)


def _check_run(made: Drawn, judge: Judge, states: Mapping[str, float], run: Result) -> None:
    told = unknowns(judge, run)
    pins = pinned(made, judge, states, told[0])
    begin = solved(judge, 0.0, pins, told[0].copy())
    assert begin.left < CLOSE
    # At corners the judge's own steps are worst: where they do not show it, finer ones have to.
    levels = ((STEP, 1), (STEP / 100, 256))
    assert any(_near(judge, run, pins, begin.z, told, *level) for level in levels)


def _near(
    judge: Judge, run: Result, pins: Collection[int], begin: np.ndarray, told: np.ndarray,
    step: float, steps: int,
) -> bool:  # fmt: skip
    """Whether all that is told is near what the judge finds by so many steps, at least, of this tolerance."""
    right = np.array([
        solved(judge, t, {k: row[k] for k in pins}, row).z
        for t, row in zip(run.time, followed(judge, run.time, begin, step, steps), strict=True)
    ])  # fmt: skip
    off = np.abs(right - told)[:, judge.held :].max(axis=0)
    return bool((off < CLOSE_RUN * (1 + np.abs(right[:, judge.held :]).max(axis=0))).all())


def _check_refusal(
    made: Drawn, judge: Judge, states: Mapping[str, float], begin: float, error: Exception
) -> None:
    """A run that ends early: the judge gets no farther, from whatever it finds to begin with."""
    end = float(re.search(r"at t = ([-+.\de]+)", str(error))[1])  # type: ignore[index]
    draw = np.random.default_rng(1)
    for _ in range(8):
        z = draw.uniform(-1, 1, judge.size)
        try:
            pins = pinned(made, judge, states, z)
            found = solved(judge, begin, pins, z)
            if found.left > CLOSE:
                continue
            # What is asked for is no more than 1% of the run farther than where it ended.
            last = max(end, begin) + 0.01
            followed(judge, [begin, last], found.z, STEP)
        except (Stuck, ArithmeticError, ValueError, np.linalg.LinAlgError):
            continue
        raise AssertionError(str(error))

"""Loops of laws that rise have one solution: it is found, however far off it is."""

import random

import pytest
from oracles.exported import loaded
from references.nonlinear.ladders import Ladder, random_ladder

import bondgraph as bg
from codegen import to_python
from codegen.simulate import bare_simulator, with_engine

SEEDS = [*range(17), *range(18, 31)]
"""Without 17, whose rungs balance efforts of 1e40: no double tells their difference."""

SPEEDS = (3.0, -50.0, 100.0)


def _ladder(seed: int) -> Ladder:
    return random_ladder(random.Random(f"ladder {seed}"))


@pytest.mark.parametrize("seed", SEEDS)
def test_the_one_solution_of_a_loop_is_found_from_far_off(seed: int) -> None:
    ladder = _ladder(seed)
    equations = bg.derive(ladder.graph())
    # How many solutions there are is known, and not counted.
    ready = bare_simulator(equations, {}, None)
    module = loaded(to_python(equations, {})).Model()
    for speed in SPEEDS:
        right = pytest.approx(ladder.rate(speed), rel=1e-7, abs=1e-7)
        assert ready.rhs(0.0, [speed])[0] == right
    assert module.rhs(0.0, [speed])[0] == right


@pytest.mark.parametrize("seed", range(0, 30, 6))
def test_c_finds_it_as_numpy_does(seed: int) -> None:
    """From far off, and along a short run."""
    ladder = _ladder(seed)
    ready = bare_simulator(bg.derive(ladder.graph()), {}, None)
    in_c = with_engine(ready, "c")
    for speed in SPEEDS[:2]:
        times, begin = [0.0, 1e-6 / (1 + abs(ladder.rate(speed)))], {"f_m": speed}
        runs = [one.run(times, begin, rtol=1e-6, atol=1e-6) for one in (ready, in_c)]
        assert runs[1].backend == "c"
        assert runs[1]["f_m"] - speed == pytest.approx(runs[0]["f_m"] - speed, rel=1e-6, abs=1e-12)

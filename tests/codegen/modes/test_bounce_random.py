"""Random bodies with up to six stops move as the judge finds; momentum is conserved, energy does not grow."""

import numpy as np
import pytest
from oracles.stopped import run
from oracles.stopped_judged import complaints, sure, unbalanced
from oracles.stopped_random import random_line
from references.stops.impact import JammedError
from references.stops.motion import Machine
from soak.families import seeds

from bondgraph import SimulationError

TIMES = np.linspace(0.0, 4.0, 41)


TIGHT = {"rtol": 1e-13, "atol": 1e-14}
"""For located events: what bounces multiplies an integrator's errors."""

ROUTES = [("numpy", "auto", {}), ("c", "auto", {}), ("c", "DOP853", TIGHT)]


@pytest.mark.parametrize(("backend", "method", "settings"), ROUTES)
@pytest.mark.parametrize("seed", seeds("stops"))
def test_random_stops(seed: int, backend: str, method: str, settings: dict[str, float]) -> None:
    line = random_line(np.random.default_rng(seed))
    try:
        course = Machine(line).run(TIMES)
        upto = sure(line, TIMES, course, np.random.default_rng([seed, 1]))
    except JammedError:
        # A source presses what does not yield.
        with pytest.raises(SimulationError):
            run(line, TIMES, backend, method, **settings)
        return
    result = run(line, TIMES, backend, method, **settings)
    assert complaints(line, TIMES, result, course, upto) == []
    assert unbalanced(line, TIMES, result, backend) == []

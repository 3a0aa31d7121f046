"""Random drivelines and networks that switch, cut into random steps: the same as one run with inputs held."""

from collections.abc import Hashable, Mapping, Sequence

import numpy as np
import pytest
from oracles.drawings import Drawing
from oracles.drivelines import random_driveline
from references.switched.random_networks import random_switched
from soak.families import seeds

import bondgraph as bg
from codegen import (
    Event,
    Signal,
    Simulator,
    SwitchedSimulator,
    ZeroOrderHold,
    simulator,
    switched_simulator,
)

END, CUTS = 3.0, 17


def told(events: Sequence[Event]) -> list[tuple[Hashable, str]]:
    return [(event.port, event.kind) for event in events]


def check(
    ready: Simulator | SwitchedSimulator, initial: Mapping[str, float],
    inputs: Mapping[str, Signal], on: Sequence[Hashable],
    rng: np.random.Generator,
) -> None:  # fmt: skip
    """Steps against a run; what cannot run cannot be stepped."""
    times = np.array([0.0, *np.sort(rng.uniform(0.0, END, CUTS)), END])
    values = {name: [one(t) for t in times[:-1].tolist()] for name, one in inputs.items()}
    held = {name: ZeroOrderHold(times[:-1], row) for name, row in values.items()}
    try:
        run = ready.run(times, initial, held, initially_on=on)
    except bg.BondGraphError:
        run = None
    try:
        one = ready.stepper(initial, {n: row[0] for n, row in values.items()}, initially_on=on)
        events = list[Event]()
        for k, t in enumerate(times[1:].tolist()):
            now = one.advance(t - one.time, **{name: row[k] for name, row in values.items()})
            events += one.events
    except bg.BondGraphError:
        assert run is None
        return
    assert run is not None
    assert sorted(map(str, told(events))) == sorted(map(str, told(run.events)))
    times_of = sorted(e.time for e in run.events)
    assert sorted(e.time for e in events) == pytest.approx(times_of, abs=1e-9)
    for name in run.states:
        size = max(np.abs(run[name]).max(), 1e-6)
        assert abs(now[name] - run[name][-1]) <= 1e-9 * size, name


def drawn(seed: int, backend: str) -> None:
    rng = np.random.default_rng(seed)
    line = random_driveline(rng)
    check(simulator(bg.derive(line.graph()), {}, backend=backend), {}, line.inputs(), (), rng)
    drawing = Drawing(random_switched(np.random.default_rng(seed), 2, "DK"))
    ready = switched_simulator(drawing.graph(), {}, backend=backend)
    check(ready, drawing.initial(), drawing.inputs(), drawing.initially_on(), rng)


@pytest.mark.parametrize("seed", seeds("stepped"))
def test_random_steps_are_a_run(seed: int) -> None:
    drawn(seed, "numpy")


@pytest.mark.parametrize("seed", [0, 1])
def test_random_steps_in_c_are_a_run(seed: int) -> None:
    drawn(seed, "c")

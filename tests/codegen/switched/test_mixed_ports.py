"""Random networks of one to eight ports of every kind, drawn in every way, against the judge."""

import re
import shutil

import numpy as np
import pytest
from oracles.circuits import complaints, judged_as
from oracles.drawings import Drawing
from references.switched.random_networks import SPAN, random_mixed
from soak.families import seeds

import bondgraph as bg
from bondgraph.errors import SimulationError
from codegen import Result, simulator

TIMES = np.linspace(0.0, SPAN, 31)


def _drawn(seed: int) -> Drawing:
    """A network as a graph: each way of drawing one, and half of its switches as controlled junctions."""
    rng = np.random.default_rng(seed)
    network = random_mixed(rng)
    joints = frozenset(b.name for b in network.of("K", "G") if rng.random() < 0.5)
    return Drawing(network, seed % 2 == 1, seed % 3 == 0, joints)


def _run(drawing: Drawing, backend: str) -> Result:
    ready = simulator(bg.derive(drawing.graph()), {}, backend=backend)
    start = {name: value for name, value in drawing.initial().items() if name in ready.states}
    on = drawing.initially_on()
    return ready.run(TIMES, start, drawing.inputs(), initially_on=on)


def _check(seed: int, backend: str) -> None:
    """As the judge finds; where it finds no mode, neither does a run."""
    drawing = _drawn(seed)
    try:
        found = judged_as(drawing, TIMES)
    except AssertionError as error:
        pytest.skip(str(error))
    except RuntimeError as error:
        found, refused = None, str(error)
    if found is None:
        assert re.match("no mode is consistent|impulses without end", refused)
        with pytest.raises(SimulationError, match="no mode of the switches is consistent"):
            _run(drawing, backend)
        return
    result = _run(drawing, backend)
    assert result.backend == backend
    assert complaints(found, result) == []


@pytest.mark.parametrize("seed", seeds("mixed-ports"))
def test_random_networks(seed: int) -> None:
    _check(seed, "numpy")


NEIGHBOUR_HOLDS = 161
"""Friction beside a closed switch: where it breaks loose, the rate of its slip is not the whole rate."""

JOINED = 206
"""Two frictions that touch one another only by way of a diode that holds: what one does decides the other."""

LATCHED = 1107
"""A slider turns, by which two ports change over at once, beside a latch that as well might, unasked."""

UNTOUCHED = 1234
"""An impulse of 3e-2 at one port leaves at another, which it has no part in, 9e-17 of rounding."""

HELD = 360
"""A switch stops a current of 0.13 beside a diode that blocks a current of 2e-16, which is no impulse."""

BRIEF = 1518
"""A command that dips below zero for a millisecond, by 8e-9 where its powers of time are about 30."""


@pytest.mark.parametrize("seed", [JOINED, LATCHED, UNTOUCHED])
def test_networks_that_were_wrong(seed: int) -> None:
    _check(seed, "numpy")


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("seed", [NEIGHBOUR_HOLDS, LATCHED, HELD, BRIEF])
def test_networks_that_were_wrong_in_c(seed: int) -> None:
    _check(seed, "c")


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("seed", seeds("mixed-ports-in-c"))
def test_random_networks_in_c(seed: int) -> None:
    _check(seed, "c")

"""Networks drawn as bond graphs, electrically and mechanically: either way they are what the judge has."""

import numpy as np
import pytest
from oracles.circuits import Drawing, complaints, judged, switched
from references.switched.mechanisms import dog_beside_clutch, two_dogs
from references.switched.named import buck, opened_inductor, pulses
from references.switched.network import Branch, Network, Wave
from references.switched.random_networks import random_switched

from codegen import switched_simulator

WAYS = pytest.mark.parametrize("mechanical", [False, True], ids=["electrical", "mechanical"])

FRICTION = Network(2, (
    Branch("S", "S0", 0, 1, more=0.5, wave=Wave(0.3, ((1.1, -0.8),), 2.0, 0.4, 0.3)),
    Branch("C", "C0", 1, 0, 0.8, start=0.7), Branch("F", "F0", 1, 2, 0.6),
    Branch("C", "C1", 2, 0, 0.5), Branch("R", "R0", 2, 0, 2.0), Branch("D", "D0", 2, 0, more=0.2),
    Branch("I", "I0", 0, 2, wave=Wave(amplitude=0.4, frequency=0.7)),
))  # fmt: skip

NAMED: dict[str, tuple[Network, float]] = {
    "buck": (buck(10, 1e-4, 1e-4, 1, pulses(5e-5, 0.4, 2e-4), 4, 4), 2e-4),
    "opened-inductor": (opened_inductor(10, 1, 1, 2, 1), 3),
    "dog-beside-clutch": (dog_beside_clutch((1, 2, 3), (0, 0, 1), 1, 0.2, 1), 3),
    "friction": (FRICTION, 3),
}


@WAYS
@pytest.mark.parametrize("name", NAMED)
def test_named_networks(name: str, mechanical: bool) -> None:
    network, end = NAMED[name]
    times = np.linspace(0.0, end, 31)
    found = judged(network, times, mechanical)
    assert complaints(found, switched(network, times, mechanical), end) == []


@WAYS
@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_random_networks(seed: int, mechanical: bool) -> None:
    network, times = (
        random_switched(np.random.default_rng(seed), 2, "DK"),
        np.linspace(0.0, 3.0, 31),
    )
    found = judged(network, times, mechanical)
    assert complaints(found, switched(network, times, mechanical)) == []


def test_sources_may_be_expressions_of_time() -> None:
    network, times = random_switched(np.random.default_rng(1), 2, "DK"), np.linspace(0.0, 3.0, 31)
    drawing = Drawing(network, of_time=True)
    assert len(drawing.inputs()) < len(Drawing(network).inputs())
    ready = switched_simulator(drawing.graph(), {})
    run = ready.run(times, drawing.initial(), drawing.inputs(), drawing.initially_on())
    assert complaints(judged(network, times), run) == []


def test_a_closed_switch_is_off_where_voltages_are_speeds() -> None:
    network = two_dogs((1, 2), (1, 0), 0.5, (1, 2), (1.5, 2.5))
    assert Drawing(network).initially_on() == []
    assert Drawing(network, mechanical=True).initially_on() == ["K0", "K1"]
    kinds = dict(Drawing(network, mechanical=True).graph().nodes(data="kind"))
    assert (kinds["C0"], kinds["n1"], kinds["K0_way"]) == ("I", "One", "Zero")

"""Random networks with diodes against an oracle that knows nothing of bond graphs."""

import numpy as np
import pytest
from oracles.circuits import as_graph, complaints, judged
from references.diode_networks import Network, random_network
from soak.families import seeds

from codegen import Result, Sine, switched_simulator

TIMES = np.linspace(0.0, 3.0, 61)


def _run(network: Network) -> Result:
    inputs = {f"u_{b.name}": Sine(b.value, b.frequency, phase=b.phase) for b in network.of("S")}
    return switched_simulator(as_graph(network), {}).run(TIMES, inputs=inputs)


def _check(network: Network) -> None:
    assert complaints(judged(network, TIMES), _run(network)) == []


@pytest.mark.parametrize("seed", seeds("diodes"))
def test_diodes_with_resistances(seed: int) -> None:
    _check(random_network(np.random.default_rng(seed), ideal=False))


@pytest.mark.parametrize("seed", seeds("ideal-diodes"))
def test_ideal_diodes(seed: int) -> None:
    _check(random_network(np.random.default_rng(10_000 + seed), ideal=True))

"""Random networks with diodes against an oracle that knows nothing of bond graphs."""

import numpy as np
import pytest
from oracles.circuits import complaints, judged, switched
from references.switched.network import Network
from references.switched.random_networks import random_network
from soak.families import seeds

TIMES = np.linspace(0.0, 3.0, 61)


def _check(network: Network) -> None:
    assert complaints(judged(network, TIMES), switched(network, TIMES)) == []


@pytest.mark.parametrize("seed", seeds("diodes"))
def test_diodes_with_resistances(seed: int) -> None:
    _check(random_network(np.random.default_rng(seed), ideal=False))


@pytest.mark.parametrize("seed", seeds("ideal-diodes"))
def test_ideal_diodes(seed: int) -> None:
    _check(random_network(np.random.default_rng(10_000 + seed), ideal=True))

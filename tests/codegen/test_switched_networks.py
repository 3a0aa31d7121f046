"""Random networks with diodes against an oracle that knows nothing of bond graphs."""

import os

import numpy as np
import pytest
from references.diode_networks import Network, Oracle, random_network

from codegen import Result, Sine, switched_simulator

COUNT = int(os.environ.get("BONDGRAPH_RANDOM_DIODES", "20"))
MOMENT = 1e-5
TIMES = np.linspace(0.0, 3.0, 61)


def _run(network: Network) -> Result:
    inputs = {f"u_{b.name}": Sine(b.value, b.frequency, phase=b.phase) for b in network.of("S")}
    return switched_simulator(network.graph(), {}).run(TIMES, inputs=inputs)


def _check(network: Network) -> None:
    expected, events = Oracle(network).run(TIMES)
    result = _run(network)
    # From complete rest a diode turns on only after a moment, 1e-6 of the run.
    later = [event for event in result.events if event.time > MOMENT]
    found = sorted((event.port, event.kind) for event in later)
    assert found == sorted((name, kind) for _, name, kind in events)
    assert [e.time for e in later] == pytest.approx([time for time, *_ in events], abs=1e-6)
    for name, values in expected.items():
        size = max(np.abs(column).max() for column in expected.values())
        assert result[name] == pytest.approx(values, abs=1e-6 * size), name


@pytest.mark.parametrize("seed", range(COUNT))
def test_diodes_with_resistances(seed: int) -> None:
    _check(random_network(np.random.default_rng(seed), ideal=False))


@pytest.mark.parametrize("seed", range(COUNT))
def test_ideal_diodes(seed: int) -> None:
    _check(random_network(np.random.default_rng(10_000 + seed), ideal=True))

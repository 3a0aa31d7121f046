"""The judge of networks with diodes: a rectifier in closed form."""

import numpy as np
import pytest
from oracles.circuits import judged
from references.switched.network import Branch, Network, Wave

TIMES = np.linspace(0.0, 3.0, 61)


def test_a_half_wave_rectifier_into_a_resistance_and_a_coil() -> None:
    """u = sin(w t) on R = 1 and L = 1: i = (sin(w t) - w cos(w t) + w exp(-t))/(1 + w^2) until it is zero."""
    w = 2 * np.pi * 0.5
    parts = (
        Branch("S", "S0", 0, 1, more=1.0, wave=Wave(amplitude=1.0, frequency=0.5)),
        Branch("D", "D0", 1, 2),
        Branch("L", "L0", 2, 0, 1.0),
    )
    columns, events = judged(Network(2, parts), TIMES)

    def current(t: float) -> float:
        return float((np.sin(w * t) - w * np.cos(w * t) + w * np.exp(-t)) / (1 + w * w))

    off = next(t for t, _, kind in events if kind == "off")
    assert current(off) == pytest.approx(0.0, abs=1e-9)
    assert 1.0 < off < 2.0
    flowing = off > TIMES
    expected = [current(t) for t in TIMES[flowing]]
    assert columns["i_L0"][flowing] == pytest.approx(expected, abs=1e-9)
    after = (off < TIMES) & (TIMES < 2.0)
    assert np.abs(columns["i_L0"][after]).max() < 1e-12

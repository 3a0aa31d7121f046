"""The judge of networks with diodes: a rectifier in closed form, and faults that it must see."""

from dataclasses import dataclass

import numpy as np
import pytest
from oracles.circuits import Found, complaints, judged
from references.switched.network import Branch, Network, Wave
from references.switched.random_networks import random_network

from codegen import Event

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


@dataclass
class _Told:
    """What stands for a run: signals by name, and events."""

    signals: dict[str, np.ndarray]
    events: list[Event]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.signals[name]


@pytest.fixture(scope="module")
def found() -> Found:
    """A network whose diodes switch several times."""
    for seed in range(50):
        answer = judged(random_network(np.random.default_rng(seed), ideal=False), TIMES)
        if len(answer[1]) > 3:
            return answer
    raise AssertionError("no network of this family switches")


def _told(found: Found) -> _Told:
    columns, events = found
    return _Told({n: v.copy() for n, v in columns.items()}, [Event(*event) for event in events])


def test_the_judge_agrees_with_itself(found: Found) -> None:
    assert complaints(found, _told(found)) == []


def test_the_judge_sees_a_flipped_sign(found: Found) -> None:
    for name in found[0]:
        told = _told(found)
        told.signals[name] *= -1
        assert any(name in text for text in complaints(found, told))


def test_the_judge_sees_a_dropped_event(found: Found) -> None:
    for at in range(len(found[1])):
        told = _told(found)
        del told.events[at]
        assert any("events" in text for text in complaints(found, told))


def test_the_judge_sees_a_lost_joule(found: Found) -> None:
    """Voltages and currents that are a hundred-thousandth less from half of the run on."""
    told = _told(found)
    for values in told.signals.values():
        values[len(values) // 2 :] *= 1 - 1e-5
    assert complaints(found, told)

"""What a run of a network that switches may have wrong, and the judge sees: signs, events, energy."""

from dataclasses import dataclass

import numpy as np
import pytest
from oracles.circuits import Found, complaints, judged
from references.switched.random_networks import random_network, random_switched

from codegen import Event

TIMES = np.linspace(0.0, 3.0, 61)


@dataclass
class _Told:
    """What stands for a run: signals by name, and events."""

    signals: dict[str, np.ndarray]
    events: list[Event]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.signals[name]


def _with_diodes() -> Found:
    """A network whose diodes switch several times."""
    for seed in range(50):
        answer = judged(random_network(np.random.default_rng(seed), ideal=False), TIMES)
        if len(answer[1]) > 3:
            return answer
    raise AssertionError("no network of this family switches")


def _with_every_kind(mechanical: bool) -> Found:
    """A network whose diode, switch and friction all have events."""
    for seed in range(50):
        network = random_switched(np.random.default_rng(seed), 4)
        answer = judged(network, TIMES, mechanical)
        if {port[0] for _, port, _ in answer[1]} == {"D", "K", "F"}:
            return answer
    raise AssertionError("no network of this family has events of every kind")


@pytest.fixture(scope="module", params=["diodes", "electrical", "mechanical"])
def found(request: pytest.FixtureRequest) -> Found:
    """A network and its exact course."""
    kind = str(request.param)
    return _with_diodes() if kind == "diodes" else _with_every_kind(kind == "mechanical")


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


def test_the_judge_sees_an_event_of_another_kind_or_time(found: Found) -> None:
    turned = {"on": "off", "off": "on", "stick": "slip", "slip": "cross", "cross": "stick"}
    for at, (time, port, kind) in enumerate(found[1]):
        for other in (Event(time, port, turned[kind]), Event(time + 2e-6, port, kind)):
            told = _told(found)
            told.events[at] = other
            assert any("events" in text for text in complaints(found, told))


def test_the_judge_sees_a_lost_joule(found: Found) -> None:
    """Voltages and currents that are a hundred-thousandth less from half of the run on."""
    told = _told(found)
    for values in told.signals.values():
        values[len(values) // 2 :] *= 1 - 1e-5
    assert complaints(found, told)

"""The clutch as an environment: by hand, with a stand-in where gymnasium is missing."""

import importlib
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest


class Box:
    """What is told of a space, and no more."""

    def __init__(self, low: float, high: float, shape: tuple[int, ...], dtype: type) -> None:
        self.low, self.high, self.shape, self.dtype = low, high, shape, dtype


class Env:
    """What an environment inherits."""

    def reset(self, *, seed: int | None = None, options: object = None) -> None:
        self.seed = seed


@pytest.fixture(scope="module")
def example() -> Any:
    """The example, over gymnasium or what stands in for it."""
    name, kept = "examples.clutch_environment", sys.modules.get("gymnasium")
    try:
        importlib.import_module("gymnasium")
    except ImportError:
        standin = ModuleType("gymnasium")
        standin.Env, standin.spaces = Env, SimpleNamespace(Box=Box)  # type: ignore[attr-defined]
        sys.modules["gymnasium"] = standin
    sys.modules.pop(name, None)
    yield importlib.import_module(name)
    sys.modules.pop(name, None)
    if kept is None:
        sys.modules.pop("gymnasium", None)


def test_an_open_clutch_lets_the_engine_go(example: Any) -> None:
    """10 N m on 0.2 kg m^2: 50 rad/s^2; the load rests."""
    made = example.ClutchEnvironment()
    made.reset(seed=3)
    for _ in range(10):
        seen, paid, done, cut, _ = made.step(np.array([0.0]))
    assert seen == pytest.approx([100 + 50 * 0.2, 0.0, 0.0])
    assert (done, cut) == (False, False)
    assert paid == pytest.approx(-0.02 * 1.1)


def test_it_sticks_when_it_does_by_hand_and_begins_again(example: Any) -> None:
    """30 N m: the engine loses 100 rad/s^2, the load comes to 300 (1 - exp(-t/8)) rad/s."""
    made = example.ClutchEnvironment()
    for _ in range(2):
        made.reset()
        done, told = False, []
        while not done:
            seen, _, done, cut, more = made.step(np.array([0.5]))
            told += more["events"]
            assert not cut
        [event] = told
        t = event.time
        assert (event.port, event.kind) == ("clutch", "stick")
        assert 100 - 100 * t == pytest.approx(300 * (1 - np.exp(-t / 8)), abs=1e-6)
        assert seen[0] == seen[1]


def test_an_episode_ends(example: Any) -> None:
    made = example.ClutchEnvironment(longest=0.5)
    total, time = example.episode(made, 0.05)
    assert time == pytest.approx(0.5)
    assert total < 0

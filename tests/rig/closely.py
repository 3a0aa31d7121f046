"""Runs that are closer than the default tolerances, for tests whose bounds ask for that."""

from collections.abc import Callable
from inspect import signature

import pytest

from codegen.runs.track import Settings
from codegen.simulator import Simulator
from codegen.sweeps.sweep import sweep
from codegen.switched.simulator import SwitchedSimulator

CLOSE = {"rtol": 1e-10, "atol": 1e-11}

RUNS: tuple[Callable[..., object], ...] = (
    Simulator.run, Simulator.run_telling, SwitchedSimulator.run, sweep, Settings.__init__,
)  # fmt: skip


@pytest.fixture
def closely(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a test tells no tolerances, they are 1e-10 and 1e-11."""
    for function in RUNS:
        told = signature(function).parameters.values()
        plain = [
            one for one in told if one.default is not one.empty and one.kind != one.KEYWORD_ONLY
        ]
        named = {one.name: one.default for one in told if one.kind == one.KEYWORD_ONLY}
        given = tuple(CLOSE.get(one.name, one.default) for one in plain)
        monkeypatch.setattr(function, "__defaults__", given)
        close = {name: CLOSE.get(name, value) for name, value in named.items()}
        monkeypatch.setattr(function, "__kwdefaults__", close)

"""Runs that come to many modes of many ports: exact steps give way where their tables take longer."""

from typing import Any

import numpy as np
import pytest
from oracles.many import chain

import bondgraph as bg
from codegen import Simulator, simulator
from codegen.engine.places import FEWEST, Places
from codegen.engine.runs import Outcome
from codegen.engine.status import Status
from codegen.taking import backends

CASE = chain(12)


@pytest.fixture
def statuses(monkeypatch: pytest.MonkeyPatch) -> list[Status]:
    """How exact runs ended, where a run may come to sixteen modes."""
    told: list[Status] = []
    start, run = Places.__init__, backends.run_exact

    def few(self: Places, *arguments: Any) -> None:
        start(self, *arguments)
        self.few = FEWEST

    def telling(*arguments: Any) -> Outcome:
        found = run(*arguments)
        told.append(found.status)
        return found

    monkeypatch.setattr(Places, "__init__", few)
    monkeypatch.setattr(backends, "run_exact", telling)
    return told


def _simulator() -> Simulator:
    return simulator(bg.derive(CASE.graph), {}, backend="c")


def test_a_run_with_too_many_modes_is_located(statuses: list[Status]) -> None:
    ready = _simulator()
    expected = ready.run(CASE.times, {}, CASE.inputs, "exact")
    found = ready.run(CASE.times, {}, CASE.inputs, rtol=1e-10, atol=1e-11)
    assert statuses == [Status.OK, Status.CROWDED]
    assert found.backend == "c"
    assert [(e.port, e.kind) for e in found.events] == [(e.port, e.kind) for e in expected.events]
    for name in CASE.shown:
        range_ = np.ptp(expected[name])
        assert np.abs(found[name] - expected[name]).max() <= 1e-8 * range_


def test_whether_it_is_does_not_depend_on_earlier_runs(statuses: list[Status]) -> None:
    """Modes that earlier runs came to count as those that are worked out now."""
    short, alone, after = CASE.times[CASE.times <= 0.25], _simulator(), _simulator()
    after.run(CASE.times, {}, CASE.inputs, "exact")
    for times in (CASE.times, short):
        first, again, later = (ready.run(times, {}, CASE.inputs) for ready in (alone, alone, after))
        for found in (again, later):
            assert found.events == first.events
            for name in CASE.shown:
                assert np.array_equal(found[name], first[name])
    assert statuses == [Status.OK, *[Status.CROWDED] * 3, *[Status.OK] * 3]


def test_leaps_begin_where_they_did_in_the_run_before() -> None:
    """Of a larger model steps by series come first; how many does not depend on earlier runs."""
    ready, times = _simulator(), np.linspace(0.0, 3.0, 3001)
    first, again = (ready.run(times, {}, CASE.inputs, "exact") for _ in range(2))
    for name in CASE.shown:
        assert np.array_equal(first[name], again[name])

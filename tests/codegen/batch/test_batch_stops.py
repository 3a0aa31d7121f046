"""The loop over runs in C on models with stops: bounces as their closed form counts and times them."""

import shutil
from typing import Any

import numpy as np
import pytest
from oracles.stops import ball, bounces, flight

import bondgraph as bg
from codegen import Family, event_count, final, first_event, samples, sweep
from codegen.engine.status import Status
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

TIMES = np.linspace(0.0, 2.0, 21)

MEASURES = {
    "first": first_event("floor", "hit"), "touch": first_event("floor", "touch"),
    "hits": event_count("floor", "hit"), "place": samples("q_floor"), "speed": final("v"),
}  # fmt: skip

RUNS = np.array([(e, h) for e in (0.0, 0.3, 0.8, 0.9, 1.0) for h in (0.4, 0.9)])
"""Restitution and height of each."""

METHODS = ["auto", "DOP853"]
"""By exact steps; with events located."""


def _family(backend: str = "c") -> Family:
    return Family(bg.derive(ball("e")), {"m": 2.0, "g": 9.81, "e": 0.5}, backend=backend)


def _swept(method: str, runs: np.ndarray = RUNS) -> tuple[dict[str, Any], list[int], Any]:
    """The columns of the loop in C, and which runs are left to do another way."""
    job = Job(_family(), ("e", "q_floor"), TIMES, MEASURES, settings={"method": method})
    loop = batch_of(job)
    assert loop is not None
    columns, left = loop(runs)
    return dict(zip(MEASURES, columns, strict=True)), left, loop.statuses


@pytest.mark.parametrize("method", METHODS)
def test_the_loop_counts_and_times_bounces(method: str) -> None:
    found, left, statuses = _swept(method)
    assert not left
    assert dict(statuses) == {int(Status.OK): len(RUNS)}
    for k, (e, h) in enumerate(RUNS.tolist()):
        at = bounces(e, h, 200)
        if e == 0:
            assert found["hits"][k] == 0
            assert found["touch"][k] == pytest.approx(at[0], abs=1e-12)
            continue
        flying = at[99] > TIMES
        right = flight(e, h, TIMES[flying])
        assert found["place"][k][flying] == pytest.approx(right, abs=1e-10)
        assert found["first"][k] == pytest.approx(at[0], abs=1e-12)
        if at[-1] < 2:
            assert found["touch"][k] == pytest.approx(at[-1], abs=1e-4)
            assert (found["place"][k][-1], found["speed"][k]) == (0.0, 0.0)
        else:
            assert np.isnan(found["touch"][k])
            assert found["hits"][k] == np.count_nonzero(at < 2)


def test_both_loops_do_as_numpy_does() -> None:
    expected = sweep(
        _family("numpy"), [dict(zip(("e", "q_floor"), run, strict=True)) for run in RUNS.tolist()],
        TIMES, MEASURES, workers=0, progress=False,
    )  # fmt: skip
    for method in METHODS:
        found, _, _ = _swept(method)
        for name in MEASURES:
            assert found[name] == pytest.approx(np.array(expected[name]), abs=1e-8, nan_ok=True), (
                name
            )


@pytest.mark.parametrize("method", METHODS)
def test_a_start_beyond_a_bound_is_refused_by_name(method: str) -> None:
    _, left, _ = _swept(method, np.array([(0.5, 0.1), (0.5, -0.2)]))
    assert left == [1]
    found = sweep(
        _family(), {"e": [0.5], "q_floor": [0.1, -0.2]}, TIMES, MEASURES, method=method, workers=0,
        progress=False,
    )  # fmt: skip
    (failure,) = found.failed
    assert (failure.run, failure.values["q_floor"]) == (1, -0.2)
    assert "stop 'floor' begins 0.2 beyond its bound" in failure.message
    assert found["first"][0] == pytest.approx(bounces(0.5, 0.1, 1)[0])


def test_more_bounces_than_the_loop_keeps_are_counted_all_the_same() -> None:
    """A ball that bounces for ever, from so low that it does more than 256 times: another way."""
    table = {"e": [1.0], "q_floor": [1e-4]}
    found = sweep(_family(), table, [0.0, 5.0], MEASURES, workers=0, progress=False)
    assert found["hits"].tolist() == [np.count_nonzero(bounces(1.0, 1e-4, 1000) < 5)]

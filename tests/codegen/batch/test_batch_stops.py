"""Sweeps over models with stops in the loop of C: bounces as their closed form counts and times them."""

import shutil
from collections.abc import Mapping

import numpy as np
import pytest
from oracles.stops import ball, bounces, dropped

import bondgraph as bg
from codegen import Family, event_count, final, first_event, sweep

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

TABLE = {"e": [0.0, 0.3, 0.8, 0.9], "h": [0.4, 0.9]}

MEASURES = {
    "first": first_event("floor", "hit"), "touch": first_event("floor", "touch"),
    "hits": event_count("floor", "hit"), "place": final("q_floor"), "speed": final("v"),
}  # fmt: skip


def _start(numbers: Mapping[str, float]) -> dict[str, float]:
    return {"q_floor": numbers["h"]}


def _swept(table: Mapping[str, list[float]], method: str, backend: str = "c"):
    """Over 2 s; any run that C hands back is an error, as warnings are."""
    family = Family(bg.derive(ball("e")), {"m": 2.0, "g": 9.81}, backend=backend)
    times = np.linspace(0.0, 2.0, 21)
    return sweep(
        family, table, times, MEASURES, _start, method=method, workers=0, progress=False
    )  # fmt: skip


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("method", ["auto", "DOP853"])
def test_a_sweep_counts_and_times_bounces(method: str) -> None:
    found = _swept(TABLE, method)
    for e, h, *_, hits, place, speed, first, touch in zip(
        *(found[name] for name in ("e", "h", "hits", "place", "speed", "first", "touch")),
        strict=True,
    ):
        at = bounces(e, h, 200)
        if e == 0:
            assert (hits, touch) == (0, pytest.approx(at[0], abs=1e-12))
            continue
        assert first == pytest.approx(at[0], abs=1e-12)
        if at[-1] < 2:
            assert touch == pytest.approx(at[-1], abs=1e-4)
            assert (place, speed) == (0.0, 0.0)
        else:
            assert hits == np.count_nonzero(at < 2)
            since, v = 2 - at[hits.astype(int) - 1], np.sqrt(2 * 9.81 * h) * e**hits
            right = v * since - 9.81 * since**2 / 2, v - 9.81 * since
            assert (place, speed) == pytest.approx(right, abs=1e-10)


def test_a_sweep_is_the_same_by_every_loop() -> None:
    exact, located = _swept(TABLE, "auto"), _swept(TABLE, "DOP853")
    expected = _swept(TABLE, "auto", "numpy")
    for name in MEASURES:
        for found in (exact, located):
            assert found[name] == pytest.approx(expected[name], abs=1e-9, nan_ok=True), name


def test_a_start_beyond_a_bound_is_refused_by_name() -> None:
    found = _swept({"e": [0.5], "h": [0.1, -0.2]}, "DOP853")
    (failure,) = found.failed
    assert (failure.run, failure.values["h"]) == (1, -0.2)
    assert "stop 'floor' begins 0.2 beyond its bound" in failure.message
    assert found["first"][0] == pytest.approx(bounces(0.5, 0.1, 1)[0])


def test_more_bounces_than_a_loop_keeps_are_counted_all_the_same() -> None:
    """A ball that bounces for ever, from so low that it does more than 256 times: the other way."""
    case = dropped(1.0, 1e-4)
    family = Family(case.equations, {"m": 2.0, "g": 9.81}, backend="c")
    found = sweep(
        family, {"e": [1.0], "h": [1e-4]}, [0.0, 5.0], {"hits": event_count("floor", "hit")}, _start,
        workers=0, progress=False,
    )  # fmt: skip
    assert found["hits"].tolist() == [np.count_nonzero(bounces(1.0, 1e-4, 1000) < 5)]

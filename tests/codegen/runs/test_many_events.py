"""Runs with many switchings: their instants, what they come to, and what they keep."""

import gc
import tracemalloc
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from numpy.typing import NDArray
from references.build import bond_graph

import bondgraph as bg
from codegen import Family, Result, Simulator, event_count, final, simulator, sweep
from codegen.numbers.latest import Latest
from codegen.runs.track import Track
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

F2 = 4e4
"""Half periods [1/s]."""

P = {"E": 24.0, "L": 1e-3, "C": 1e-4, "R": 5.0, "w": 4e4 * np.pi}
NODES = [
    bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t)"), bg.Zero("n"),
    bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
    bg.C("c", "C", effort="v"), bg.R("r", "R"),
]  # fmt: skip
BUCK = bg.derive(bond_graph(NODES, "src>s>q s>n>d n>l>L l>o>c o>r"))


def _buck(backend: str) -> Simulator:
    return simulator(BUCK, P, backend=backend)


def _by_hand(halves: int) -> NDArray[np.float64]:
    """Current and voltage after each half period, while the current flows; from rest."""
    on = np.array([[0, -1 / P["L"], P["E"] / P["L"]],
                   [1 / P["C"], -1 / (P["R"] * P["C"]), 0], [0, 0, 0]])  # fmt: skip
    off = on * [[1, 1, 0], [1, 1, 1], [1, 1, 1]]
    steps = [scipy.linalg.expm(M / F2) for M in (on, off)]
    z, rows = np.array([0.0, 0.0, 1.0]), []
    for k in range(halves):
        z = steps[k % 2] @ z
        rows.append(z[:2])
    return np.array(rows)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_pulsed_converter_switches_at_its_instants(backend: str) -> None:
    """Both switches at every half period, to the rounding of time; states by exponentials."""
    halves = 240
    times = np.arange(1, halves + 1) / F2
    run = _buck(backend).run([0.0, *times])
    at = np.array([event.time for event in run.events])
    assert len(at) == 2 * halves
    assert at == pytest.approx(np.repeat(times, 2), abs=1e-16)
    assert [(e.port, e.kind) for e in run.events[:4]] == [
        ("q", "off"), ("d", "on"), ("q", "on"), ("d", "off"),
    ]  # fmt: skip
    expected = _by_hand(halves)
    for name, column in zip(("i", "v"), expected.T, strict=True):
        assert run[name][1:] == pytest.approx(column, abs=1e-10 * np.ptp(column))


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_events_need_not_be_kept(backend: str) -> None:
    times = np.linspace(0, 2e-3, 21)
    kept, bare = (_buck(backend).run(times, events=events) for events in (True, False))
    assert bare.backend == kept.backend == backend
    assert len(kept.events) == 160
    assert bare.events == ()
    for name in kept:
        assert bare[name].tolist() == kept[name].tolist()


@pytest.mark.parametrize(("method", "backend"), [("exact", "numpy"), ("DOP853", "c")])
def test_events_are_dropped_by_every_method(method: str, backend: str) -> None:
    run = _buck(backend).run([0.0, 1e-4], method=method, events=False)
    assert run.events == ()
    assert run["i"][-1] > 0


def _kept(monkeypatch: pytest.MonkeyPatch, halves: int, **asked: Any) -> int:
    """The memory [bytes] that a run holds as it comes to its end after so many half periods."""
    run, times, held = _buck("numpy"), np.linspace(0, halves / F2, 11), list[int]()
    run.run(times)
    record = Track.record

    def last(self: Track, *sample: Any) -> None:
        gc.collect()
        held.append(tracemalloc.get_traced_memory()[0])
        record(self, *sample)

    monkeypatch.setattr(Track, "record", last)
    tracemalloc.start()
    try:
        run.run(times, **asked)
    finally:
        tracemalloc.stop()
        monkeypatch.undo()
    return held[-1]


def test_without_events_memory_does_not_grow_with_their_number(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """600 more half periods: their events, two each, would take some 70 bytes each."""
    few, many = (_kept(monkeypatch, halves, events=False) for halves in (200, 800))
    assert abs(many - few) < 10_000
    few, many = (_kept(monkeypatch, halves) for halves in (200, 800))
    assert many - few > 60_000


def _seen(result: Result) -> float:
    return len(result.events)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_functions_of_a_sweep_find_events_unless_they_are_not_kept(backend: str) -> None:
    """Two at each half period, as it begins another."""
    family, times = Family(BUCK, P, backend=backend), np.linspace(0, 20.5 / F2, 3)
    for events, count in ((True, 40.0), (False, 0.0)):
        done = sweep(family, {"R": [4.0, 5.0]}, times, {"seen": _seen, "end": final("i")},
                     events=events, workers=0, progress=False)  # fmt: skip
        assert done["seen"].tolist() == [count] * 2
        assert (done["end"] > 0).all()
    asking = {"count": event_count("q", "on"), "seen": _seen}
    with pytest.raises(bg.SignalError, match="'count' asks for events; leave events=False out"):
        sweep(family, {"R": [4.0]}, times, asking, events=False, workers=0)


def _held_by_a_sweep(monkeypatch: pytest.MonkeyPatch, halves: int, **asked: Any) -> int:
    """As `_kept`, of the last of two runs of a sweep by numpy."""
    family, times, held = Family(BUCK, P), np.linspace(0, halves / F2, 11), list[int]()
    record = Track.record

    def last(self: Track, *sample: Any) -> None:
        gc.collect()
        held.append(tracemalloc.get_traced_memory()[0])
        record(self, *sample)

    def run() -> None:
        sweep(family, {"R": [4.0, 5.0]}, times, workers=0, progress=False, **asked)

    run()
    monkeypatch.setattr(Track, "record", last)
    tracemalloc.start()
    try:
        run()
    finally:
        tracemalloc.stop()
        monkeypatch.undo()
    return held[-1]


@pytest.mark.parametrize(
    ("asked", "grows"),
    [
        ({"measures": {"end": final("i")}}, False),
        ({"measures": {"seen": _seen}, "events": False}, False),
        ({"measures": {"seen": _seen}}, True),
    ],
    ids=["ready", "own without", "own"],
)
def test_what_a_sweep_keeps_of_switchings(
    asked: dict[str, Any], grows: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """300 more half periods: of the run that is being done, not of the one before."""
    few, many = (_held_by_a_sweep(monkeypatch, halves, **asked) for halves in (100, 400))
    if grows:
        assert 30_000 < many - few < 90_000
    else:
        assert abs(many - few) < 5_000


def test_what_is_worked_out_by_mode_is_kept_for_so_many_only() -> None:
    made: list[int] = []
    kept = Latest[int, int](3)
    for key in (1, 2, 3, 1, 4, 1, 2):
        assert kept.of(key, lambda key=key: made.append(key) or key) == key  # type: ignore[misc]
    assert made == [1, 2, 3, 4, 2]
    assert len(kept) == 3


@pytest.mark.parametrize("halves", [20, 200])
def test_sweeps_in_c_take_runs_of_any_number_of_events(halves: int) -> None:
    """400 events are more than there is room for; no measure asks for them."""
    times = np.linspace(0, halves / F2, 3)
    family = Family(BUCK, P, backend="c")
    loop = batch_of(Job(family, ("R",), times, {"end": final("i")}, {}, {}))
    assert loop is not None
    (column,), left = loop([(P["R"],)])
    assert left == []
    assert column[0] == pytest.approx(_by_hand(halves)[-1, 0], rel=1e-9)

"""Runs of more samples and events than are handed over at a time, beside what theory says of all of them."""

import signal
import tracemalloc
from itertools import accumulate, islice

import numpy as np
import pytest

import bondgraph as bg
from codegen import Simulator, Square, simulator
from codegen.engine import runs
from codegen.runs import exact
from codegen.runs.track import BLOCK, Event, Track
from codegen.taking import backends
from codegen.taking.blocks import Blocks

BACKENDS = ("numpy", "c")
METHODS = ("exact", "DOP853", "Radau")
MANY = 2 * BLOCK + 100


def oscillator(backend: str) -> Simulator:
    """m x'' + b x' + k x = 0, of 2 kg, 4 kg/s and 800 N/m."""
    graph = bg.graph(
        [bg.One("j"), bg.I("m", 2, flow="v"), bg.C("k", "1/800", effort="F"), bg.R("b", 4)],
        "j > m, j > k, j > b",
    )
    return simulator(bg.derive(graph), {}, backend=backend)


def rubbing(backend: str) -> Simulator:
    """1 kg on a ground that rubs by 1 N."""
    graph = bg.graph(
        [
            bg.Se("force", "F"),
            bg.One("j"),
            bg.I("m", 1, flow="v"),
            bg.R("r", law=bg.DryFriction(1)),
        ],
        "force > j > m, j > r",
    )
    return simulator(bg.derive(graph), {}, backend=backend)


def crossings(count: int) -> np.ndarray:
    """When the speed of `rubbing` is zero under 2 N to and fro, each for half a second.

    It slows down by 3 m/s^2 and then gains 1 m/s^2 to the other side: v' = 1/2 - v/3 from half to half.
    """
    speeds = accumulate(range(count), lambda v, _: 0.5 - v / 3, initial=0.0)
    return np.array([(k + 1) / 2 + v / 3 for k, v in enumerate(islice(speeds, 1, count + 1))])


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("even", [True, False])
def test_samples_on_both_sides_of_a_border_follow_theory(
    backend: str, method: str, even: bool
) -> None:
    times = np.linspace(0.0, 1.0, MANY)
    if not even:
        times[1:-1] += np.random.default_rng(3).uniform(-0.4, 0.4, MANY - 2) / (MANY - 1)
    if method == "exact" and backend == "numpy":
        # One distance after the other, so that stretches of one end inside a block, too.
        times = np.unique(np.round(times, 9))
    run = oscillator(backend).run(times, {"v": 1.0}, method=method, rtol=1e-11, atol=1e-12)
    turns = np.sqrt(400.0 - 1.0)
    decay = np.exp(-run.time)
    speed = decay * (np.cos(turns * run.time) - np.sin(turns * run.time) / turns)
    force = 800 * decay * np.sin(turns * run.time) / turns
    assert run.backend == backend
    assert np.abs(run["v"] - speed).max() < 2e-9
    assert np.abs(run["F"] - force).max() < 2e-9 * 40


@pytest.mark.parametrize("even", [True, False])
def test_samples_of_many_windows_follow_theory(even: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Exact steps look at so many samples at a time; here at few, so that events lie on both sides."""
    monkeypatch.setattr(exact, "WINDOW", 100)
    times = np.linspace(0.0, 3.0, 1001)
    if not even:
        times[1:-1] += np.random.default_rng(3).uniform(-0.4, 0.4, 999) * 0.003
    run = rubbing("numpy").run(times, {"v": 0.0}, {"F": Square(1, -2, 2)}, "exact")
    turns = np.array([0.0, *crossings(6)])
    events = [event.time for event in run.events if event.kind == "cross"]
    assert np.abs(np.array(events) - turns[1 : len(events) + 1]).max() < 1e-9
    # Between crossings 1 m/s^2, and 3 after the force has turned.
    last = np.searchsorted(turns, run.time, side="right") - 1
    since, sign = run.time - turns[last], np.where(last % 2 == 0, 1.0, -1.0)
    turned = np.maximum(run.time - (last + 1) / 2, 0.0)
    assert np.abs(run["v"] - sign * (since - 4 * turned)).max() < 1e-9


def test_a_grid_is_found_a_window_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "WINDOW", 16)
    times = 5.0 + 0.001 * np.arange(1000)
    assert runs.grid_of(times) == pytest.approx(0.001, rel=1e-12)
    for place in (1, 17, 640, 998):
        moved = times.copy()
        moved[place] += 1e-6
        assert runs.grid_of(moved) == 0.0


@pytest.mark.parametrize(
    ("backend", "method", "count"),
    [("numpy", "exact", 300), ("c", "exact", 3 * BLOCK), ("c", "DOP853", 3 * BLOCK)],
)
def test_events_come_in_order_and_none_is_lost(backend: str, method: str, count: int) -> None:
    wave = Square(1, -2, 2)
    run = rubbing(backend).run([0.0, (count + 1.5) / 2], {"v": 0.0}, {"F": wave}, method=method)
    events = run.events[1:] if run.events[0].kind == "slip" else run.events
    assert run.backend == backend
    assert {(event.port, event.kind) for event in events} == {("r", "cross")}
    expected = crossings(count + 1)[: len(events)]
    assert len(events) >= count
    assert np.abs([event.time for event in events] - expected).max() < 1e-8


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_run_takes_the_memory_of_its_samples_alone(backend: str) -> None:
    """Ten times the events without their being kept: not a byte more but what is rounded up."""
    ready, wave, peaks = rubbing(backend), Square(1, -2, 2), []
    for end in (20.0, 20.0, 200.0):
        tracemalloc.start()
        ready.run([0.0, end], {"v": 0.0}, {"F": wave}, events=False)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[2] < peaks[1] + 20_000


def test_what_a_run_that_begins_again_had_handed_over_is_none_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """C gives up after three samples, of which two were taken."""
    ready = oscillator("c")
    expected = ready.run([0.0, 0.1, 0.2], {"v": 1.0}, method="DOP853")
    alone = backends.run_exact

    def giving_up(engine, taker: Blocks, times, *others):
        taker.begin()
        taker.take(np.full((2, 2), 9.0), [(), ()], np.ones(2))
        taker.happened([Event(0.0, "m", "on")])
        outcome = alone(engine, taker, times, *others)
        return type(outcome)(backends.Status.STIFF, 0.1)

    monkeypatch.setattr(backends, "run_exact", giving_up)
    found = ready.run([0.0, 0.1, 0.2], {"v": 1.0})
    assert found.backend == "c"
    assert found.events == ()
    assert (found["v"] == expected["v"]).all()


class Rung(BaseException):
    """An alarm, as Ctrl-C is one."""


@pytest.mark.parametrize("method", ["exact", "DOP853"])
@pytest.mark.parametrize("events", [True, False])
def test_a_run_in_c_can_be_interrupted(method: str, events: bool) -> None:
    """It would last for hours; afterwards the simulator runs as before."""

    def ring(*_: object) -> None:
        raise Rung

    ready, wave = rubbing("c"), {"F": Square(1, -2, 2)}
    expected = ready.run([0.0, 5.0], {"v": 0.0}, wave, method)
    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Rung):
            ready.run([0.0, 1e10], {"v": 0.0}, wave, method, events=events)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert ready.run([0.0, 5.0], {"v": 0.0}, wave, method).events == expected.events


class Kept:
    """A taker of all."""

    def __init__(self) -> None:
        self.rows: list[float] = []
        self.events: list[Event] = []

    def begin(self) -> None:
        """Nothing has been taken."""

    def take(self, vectors, modes, largest) -> None:
        """The next."""
        assert len(vectors) == len(modes)
        self.rows += vectors[:, 0].tolist()

    def happened(self, events) -> None:
        """The next."""
        self.events += events


def test_a_sample_that_is_taken_back_is_never_handed_over() -> None:
    """Room for three: the latest stays until there is another."""
    kept = Kept()
    track = Track(np.zeros((3, 1)), [], np.zeros(1), taker=kept)
    for number in range(3):
        track.record(np.array([float(number)]), ())
    track.take(np.array([[3.0], [9.0]]), ())
    track.unrecord()
    track.record(np.array([4.0]), ())
    track.unrecord()
    track.take(np.arange(4.0, 9.0)[:, None], ())
    track.hand_over()
    assert kept.rows == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
    assert track.recorded == 9


def test_events_are_handed_over_once() -> None:
    kept = Kept()
    track = Track(np.zeros((3, 1)), [], np.zeros(1), taker=kept)
    made = [Event(float(k), "p", "on") for k in range(2 * BLOCK + 7)]
    for event in made:
        track.note([event])
    assert len(track.events) < BLOCK + 5
    track.hand_over()
    assert kept.events == made

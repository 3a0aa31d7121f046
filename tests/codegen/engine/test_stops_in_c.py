"""Stops in C: as closed forms and numpy have them, by exact steps and with events located."""

import shutil
from collections.abc import Callable

import networkx as nx
import numpy as np
import pytest
from oracles.stops import (
    Stopped,
    ball,
    bounces,
    dropped,
    flight,
    rotor,
    solenoid,
    struck,
    turned_body,
)
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Result, Step, simulator, switched_simulator

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

METHODS = ["auto", "DOP853"]
"""By exact steps; with events located."""

FALLEN = np.linspace(0.0, 4.0, 41)
"""Samples [s] of what falls and of what rises."""

CASES: dict[str, Callable[[], Stopped]] = {
    "at a height": lambda: Stopped(
        ball("3/5", low="h"), {"m": 2.0, "g": 9.81, "h": 0.3}, {"q_floor": 1.3}, FALLEN
    ),
    "from below": lambda: Stopped(
        ball("7/10", low=None, high="h"), {"m": 2.0, "g": -9.81, "h": 0.7}, {"q_floor": -0.4}, FALLEN
    ),
    "between two": lambda: Stopped(
        ball("9/10", low="1/10", high="h"), {"m": 2.0, "g": 1.0, "h": 0.7},
        {"q_floor": 0.3, "v": 3.0}, np.linspace(0.0, 3.0, 16),
    ),
    "a row of balls": lambda: struck(5, 1, "1/2"),
    "behind a clutch": rotor,
}  # fmt: skip


def _agree(found: Result, expected: Result, near: float = 1e-9) -> None:
    told = [(event.port, event.kind) for event in expected.events]
    assert told
    assert [(event.port, event.kind) for event in found.events] == told
    for part in ("time", "impulse"):
        right = [getattr(event, part) for event in expected.events]
        assert [getattr(event, part) for event in found.events] == pytest.approx(right, abs=near)
    for name in expected:
        span = max(float(np.ptp(expected[name])), 1e-9)
        assert np.abs(found[name] - expected[name]).max() <= 1e-9 * span, name


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("restitution", [0.0, 0.8, 1.0])
def test_a_ball_bounces_as_its_closed_form_says(restitution: float, method: str) -> None:
    """Times to 1e-12 s, impulses (1 + e) m v; what bounces ever less comes to rest."""
    case = dropped(restitution)
    found = case.run("c", method)
    hits = [event for event in found.events if event.kind == "hit"]
    speed = 2.0 * np.sqrt(2 * 9.81)
    if restitution == 0.0:
        (touch,) = found.events
        assert (touch.port, touch.kind) == ("floor", "touch")
        assert (touch.time, touch.impulse) == pytest.approx((bounces(0.0, 1.0, 1)[0], -speed))
        return
    count = min(len(hits), 40)
    assert count == (40 if restitution < 1 else 7)
    at = bounces(restitution, 1.0, count)
    assert [event.time for event in hits[:count]] == pytest.approx(at, abs=1e-12)
    right = -(1 + restitution) * speed * restitution ** np.arange(count)
    assert [event.impulse for event in hits[:count]] == pytest.approx(right, rel=1e-8)
    flying = case.times < 4.06
    right = flight(restitution, 1.0, case.times[flying])
    assert found["q_floor"][flying] == pytest.approx(right, abs=1e-10)
    if restitution < 1:
        assert found.events[-1].kind == "touch"
        assert found.events[-1].time == pytest.approx(bounces(restitution, 1.0, 99)[-1], abs=1e-4)
        assert found["e_floor_low"][-1] == pytest.approx(-2 * 9.81)


@pytest.mark.parametrize("name", CASES)
def test_exact_steps_agree_with_numpy(name: str) -> None:
    """Events and impulses to 1e-9, columns to 1e-9 of their range."""
    case = CASES[name]()
    expected, found = case.run("numpy"), case.run("c")
    _agree(found, expected)


@pytest.mark.parametrize("name", ["between two", "a row of balls"])
def test_located_events_agree_with_numpy(name: str) -> None:
    case = CASES[name]()
    expected, found = case.run("numpy", "DOP853"), case.run("c", "DOP853")
    _agree(found, expected)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("balls", "moving"), [(3, 1), (5, 2)])
def test_as_many_balls_fly_off_as_come(balls: int, moving: int, method: str) -> None:
    found = struck(balls, moving).run("c", method)
    speeds = [found[f"v{i}"][-1] for i in range(balls)]
    assert speeds == [0.0] * (balls - moving) + [1.0] * moving
    assert {(event.kind, event.impulse) for event in found.events} == {("hit", -1.0)}
    assert len(found.events) == moving * (balls - moving)


@pytest.mark.parametrize("method", METHODS)
def test_a_stop_that_another_opens_fast_enough_gives_no_impulse(method: str) -> None:
    """Ends at -1.8 and -0.2: the first gives 1.5*1.8/(1 + a^2/J) = 2.25, and opens the other at 1.6."""
    found = turned_body().run("c", method)
    (hit,) = found.events
    assert (hit.port, hit.kind) == ("s1", "hit")
    assert (hit.time, hit.impulse) == pytest.approx((0.1, -2.25), abs=1e-11)
    assert found["v_m"][-1] == pytest.approx(1.25)
    assert found["w_J"][-1] == pytest.approx(-8 + 2.25 * 0.1 / 0.05)


@pytest.mark.parametrize("method", METHODS)
def test_the_end_of_a_run_meets_no_stop_that_is_apart(method: str) -> None:
    """At rest in the air at the very end, and at rest on the other bound."""
    thrown = Stopped(
        ball("4/5", high=9), {"m": 2.0, "g": 9.81}, {"v": 9.81}, np.array([0.0, 0.5, 1.0])
    )
    found = thrown.run("c", method)
    assert not found.events
    assert found["q_floor"] == pytest.approx([0.0, 3.67875, 4.905])
    resting = Stopped(
        ball("0", high=9), {"m": 2.0, "g": -9.81}, {"q_floor": 9.0}, np.array([0.0, 0.5, 1.0])
    )
    assert resting.run("c", method)["q_floor"].tolist() == [9.0, 9.0, 9.0]


def test_switches_and_stops_are_decided_together() -> None:
    """A coil fed by a switch and a diode: their choices are made again while the armature flies."""
    case = solenoid()
    expected, found = case.run("numpy"), case.run("c")
    _agree(found, expected)
    assert {event.port for event in found.events} == {"q", "d", "gap.low", "gap.high"}


def _landing() -> "nx.DiGraph":
    """A mass that falls on a mass on a spring, by a switch that says so itself."""
    nodes = [
        bg.One("a"), bg.I("m", 1, flow="v"), bg.Se("w", "-9.81"), bg.Zero("con"), bg.One("rel"),
        bg.Df("d", integrate="gap"), bg.Sw("slack", on="e_slack", off="-gap"), bg.One("b"),
        bg.I("mb", 1, flow="vb"), bg.C("k", "1/200", effort="F"), bg.Se("wb", "-9.81"),
    ]  # fmt: skip
    return bond_graph(nodes, "a>m w>a a>con>rel>d rel>slack con>b>mb b>k wb>b")


@pytest.mark.parametrize("method", METHODS)
def test_a_switch_that_is_a_stop_lets_go_at_each_pull(method: str) -> None:
    ready = [switched_simulator(_landing(), {}, backend=backend) for backend in ("numpy", "c")]
    for gap in (0.1, 0.2, 1.3, 2.9):
        expected, found = (
            one.run(np.linspace(0.0, 2.9, 30), {"gap": gap, "F": -9.81}, method=method,
                    initially_on=["slack"])
            for one in ready
        )  # fmt: skip
        assert found.backend == "c"
        _agree(found, expected)


@pytest.mark.parametrize("method", METHODS)
def test_what_is_pulled_off_a_stop_leaves_it_for_every_height(method: str) -> None:
    nodes = [bg.Se("push", "F"), bg.One("m"), bg.I("M", 1, flow="v"), bg.Df("pos", integrate="x"),
             bg.Sw("stop", on="e_stop", off="-x")]  # fmt: skip
    ready = switched_simulator(bond_graph(nodes, "push>m>M m>pos m>stop"), {}, backend="c")
    for height in (1, 2, 3, 4, 5, 0.37, 7.3):
        pulled = 2 * np.sqrt(2 * height)
        force = Constant(-1.0) + Step(pulled, 2.0)
        found = ready.run([0, pulled, pulled + 1], {"x": height}, {"F": force}, method=method)
        assert found["x"][-1] == pytest.approx(0.5)
        assert [event.kind for event in found.events] == ["off", "on"]


@pytest.mark.parametrize("method", METHODS)
def test_a_start_beyond_a_bound_is_refused_by_name(method: str) -> None:
    ready = simulator(bg.derive(ball("0")), {"m": 1.0, "g": 9.81}, backend="c")
    with pytest.raises(bg.SimulationError, match=r"stop 'floor' begins 0\.5 beyond its bound"):
        ready.run([0.0, 1.0], {"q_floor": -0.5}, method=method)

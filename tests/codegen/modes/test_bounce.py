"""Stops against closed forms: bouncing balls, cradles, plastic joining, friction beside an impact."""

import numpy as np
import pytest
from oracles.stopped import run
from oracles.stopped_judged import complaints
from references.build import bond_graph
from references.stops.line import Bound, Line, Wave
from references.stops.motion import Machine

import bondgraph as bg
from codegen import Result, simulator

ROUTES = [(backend, method) for backend in ("numpy", "c") for method in ("auto", "DOP853")]


def _stop(name: str, a: int, b: int | None, at: float, bounce: float, way: int = 1) -> Bound:
    return Bound(name, (a, b), at, way, bounce)


def _told(result: Result) -> list[tuple[float, str, str]]:
    return [(round(e.time, 9), str(e.port), e.kind) for e in result.events]


def _row(speeds: tuple[float, ...], bounce: float, first: float = 0.0) -> Line:
    """Equal balls in a row; all but the first ``first`` touch."""
    n = len(speeds)
    stops = tuple(_stop(f"s{i}", i + 1, i, 1.0, bounce) for i in range(n - 1))
    return Line((1.0,) * n, (-first, *map(float, range(1, n))), speeds, stops)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
@pytest.mark.parametrize(("at", "way"), [(0.0, 1), (3.25, 1), (-2.0, -1), (0.0, -1)])
def test_a_ball_bounces_in_geometric_steps_and_rests(
    at: float, way: int, backend: str, method: str
) -> None:
    """Dropped by 5 at 10 m/s^2, restitution 0.8: impacts at 1 + 2 (0.8 + 0.8^2 + ...), at rest from 9 on."""
    line = Line(
        (2.0,), (at + way * 5.0,), (0.0,), (_stop("floor", 0, None, at, 0.8, way),),
        (Wave(-way * 20.0),),
    )  # fmt: skip
    tops = 1 + 2 * np.cumsum(0.8 ** np.arange(1, 20)) - 0.8 ** np.arange(1, 20)
    result = run(line, [0.0, *tops, 9.1, 12.0], backend, method)
    hits = [e for e in result.events if e.kind == "hit"]
    steps = 0.8 ** np.arange(len(hits))
    times = 1 + 2 * np.concatenate([[0.0], np.cumsum(steps[1:])])
    assert len(hits) > 45
    # An integrator knows places to its tolerance, which a slow ball passes through in a longer time.
    known = len(hits) if method == "auto" else 20
    assert [e.time for e in hits][:known] == pytest.approx(times[:known].tolist(), abs=1e-10)
    given = (-way * 2 * 10 * 1.8 * steps).tolist()
    assert [e.impulse for e in hits][:known] == pytest.approx(given[:known], abs=1e-8)
    heights = way * (result["q_floor"][1:20] - at)
    assert heights == pytest.approx(5 * 0.64 ** np.arange(1, 20), abs=1e-9)
    assert result["q_floor"][-2:].tolist() == [at, at]
    assert result["v0"][-2:] == pytest.approx([0, 0], abs=1e-14)
    assert result.events[-1].kind == "touch"
    audit = result.audit()
    assert audit.impacts == pytest.approx(100, rel=1e-9 if method == "auto" else 1e-8)
    assert abs(audit.residual) < 1e-9 * audit.turned_over


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_the_last_bounces_gain_nothing(backend: str, method: str) -> None:
    """Up and down again within a step of an integrator: as many hits as by exact steps, when they were."""
    line = Line((2.0,), (1.3,), (0.0,), (_stop("floor", 0, None, 0.3, 0.8),), (Wave(-20.0),))
    right = run(line, [0.0, 4.2]).events
    found = run(line, [0.0, 4.2], backend, method).events
    assert [e.kind for e in found] == [e.kind for e in right]
    assert [e.time for e in found] == pytest.approx([e.time for e in right], abs=1e-7)
    assert [e.impulse for e in found] == pytest.approx([e.impulse for e in right], abs=1e-5)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
@pytest.mark.parametrize(
    ("before", "after"),
    [
        ((1.0, 0.0, 0.0), (0, 0, 1)), ((1.0, 0.0, 0.0, 0.0, 0.0), (0, 0, 0, 0, 1)),
        ((1.0, 1.0, 0.0, 0.0, 0.0), (0, 0, 0, 1, 1)),
    ],
)  # fmt: skip
@pytest.mark.parametrize("first", [0.0, 0.25])
def test_cradles(
    before: tuple[float, ...], after: tuple[int, ...], first: float, backend: str, method: str
) -> None:
    if first and before[1]:
        before = (1.0, 0.0, *before[2:])
        after = (0,) * (len(before) - 1) + (1,)
    result = run(_row(before, 1.0, first), [0.0, 0.5, 0.9], backend, method)
    found = [result[f"v{i}"][-1] for i in range(len(before))]
    assert found == pytest.approx(after, abs=1e-12)
    assert abs(result.audit().residual) < 1e-12


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_start_that_closes_is_completed_and_no_event(backend: str, method: str) -> None:
    """One ball comes, touching, at 1 m/s: the run begins after what that leads to."""
    result = run(_row((1.0, 0.0, 0.0), 1.0), [0.0, 0.5], backend, method)
    assert not result.events
    assert [result[f"v{i}"][0] for i in range(3)] == pytest.approx([0, 0, 1], abs=1e-12)


def test_two_balls_that_come_together_send_two() -> None:
    """They touch one another, and then the third."""
    line = _row((1.0, 1.0, 0.0, 0.0, 0.0), 1.0)
    moved = Line(line.masses, (-0.5, 0.5, 2.0, 3.0, 4.0), line.speeds, line.stops)
    result = run(moved, [0.0, 0.9])
    assert [result[f"v{i}"][-1] for i in range(5)] == pytest.approx([0, 0, 0, 1, 1], abs=1e-12)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
@pytest.mark.parametrize("bounce", [0.0, 0.3, 1.0])
def test_two_masses_meet(bounce: float, backend: str, method: str) -> None:
    """Speeds of 2 and -1, masses of 1 and 3: relative speed 3 to -3 e; the impulse is (1 + e) 3 * 3/4."""
    line = Line((1.0, 3.0), (0.0, 1.5), (2.0, -1.0), (_stop("s", 1, 0, 0.0, bounce),))
    result = run(line, [0.0, 1.0], backend, method)
    impulse = (1 + bounce) * 3 * 0.75
    (event,) = result.events
    kind = "hit" if bounce else "touch"
    assert event == (pytest.approx(0.5, abs=1e-11), "s", kind, pytest.approx(-impulse, abs=1e-11))
    assert result["v0"][-1] == pytest.approx(2 - impulse, abs=1e-11)
    assert result["v1"][-1] == pytest.approx(-1 + impulse / 3, abs=1e-11)
    assert result.audit().impacts == pytest.approx(0.75 * 9 / 2 * (1 - bounce**2), abs=1e-11)


def test_a_plastic_row_moves_as_one() -> None:
    result = run(_row((1.0, 0.0, 0.0), 0.0, 0.25), [0.0, 1.0])
    assert [result[f"v{i}"][-1] for i in range(3)] == pytest.approx([1 / 3] * 3, abs=1e-13)


def test_a_light_ball_on_a_heavy_one_is_thrown_three_times_as_fast() -> None:
    """Both fall at 10 m/s: the floor turns the heavy one, which meets the light one; (3 M - m)/(M + m)."""
    stops = (_stop("floor", 0, None, 0.0, 1.0), _stop("s", 1, 0, 0.0, 1.0))
    line = Line((3.0, 0.1), (5.0, 5.0), (-10.0, -10.0), stops)
    result = run(line, [0.0, 0.6])
    light = 10 * (3 * 3.0 - 0.1) / 3.1
    assert result["v1"][-1] == pytest.approx(light, abs=1e-11)
    assert 3 * result["v0"][-1] == pytest.approx(3 * 10 - 0.1 * (light + 10), abs=1e-11)


def test_bounces_without_end_in_one_instant_end() -> None:
    """A heavy ball on a light one on the floor, e = 0.5: both stop, all the momentum is the floor's."""
    stops = (_stop("floor", 0, None, 0.0, 0.5), _stop("s", 1, 0, 1.0, 0.5))
    result = run(Line((1.0, 50.0), (0.0, 2.0), (0.0, -2.0), stops), [0.0, 1.0])
    assert abs(result["v0"][-1]) + abs(result["v1"][-1]) < 1e-8
    given = sum(e.impulse for e in result.events if e.port == "floor")
    assert given == pytest.approx(-100, abs=1e-6)


def test_what_is_joined_by_a_push_is_not_pulled() -> None:
    """1 leans on 0; what passes 0 by throws 1 off it: 0 stays."""
    stops = (_stop("lean", 1, 0, 1.0, 0.0), _stop("throw", 1, 2, 0.5, 1.0))
    line = Line(
        (1.0, 1.0, 1.0), (0.0, 1.0, -1.0), (0.0, 0.0, 1.0), (*stops, _stop("w", 0, None, 0.0, 0.0)),
        (Wave(), Wave(-1e-3), Wave()),
    )  # fmt: skip
    result = run(line, [0.0, 1.0, 1.6])
    assert result["v0"][-1] == 0
    assert result["v1"][-1] == pytest.approx(1 - 0.1e-3, abs=1e-9)
    assert abs(result["v2"][-1]) < 1e-9


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_stuck_clutch_beside_an_impact_slips_after_it(backend: str, method: str) -> None:
    """Two masses of 1, joined by friction of 2, at 1 m/s: one is stopped, the other slips for 0.5 s."""
    nodes = [
        bg.One("a"), bg.I("m0", 1, flow="v0"), bg.One("b"),
        bg.I("m1", 1, flow="v1"), bg.Zero("z"), bg.One("slip"),
        bg.R("clutch", law=bg.DryFriction(2), effort="f"), bg.Stop("wall", low=None, high=0.5),
    ]  # fmt: skip
    graph = bond_graph(nodes, "a>m0 b>m1 b>z>a z>slip>clutch a>wall")
    made = simulator(bg.derive(graph), {}, backend=backend)
    result = made.run([0.0, 0.25, 0.75, 1.25], {"v0": 1.0, "v1": 1.0}, method=method)
    assert _told(result) == [
        (0.5, "wall", "touch"),
        (0.5, "clutch", "slip"),
        (1.0, "clutch", "stick"),
    ]
    assert result["v1"] == pytest.approx([1, 1, 0.5, 0], abs=1e-9)
    assert result["v0"] == pytest.approx([1, 1, 0, 0], abs=1e-9)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_mass_is_pulled_off_a_stop_when_the_force_turns(backend: str, method: str) -> None:
    """-3 sin(t + 3) presses until pi - 3; then v = 3 - 3 cos(t - pi + 3)."""
    line = Line(
        (1.0,), (0.0,), (0.0,), (_stop("s", 0, None, 0.0, 0.5),), (Wave(0, -3.0, 1.0, 3.0),)
    )
    result = run(line, [0.0, 0.1, 2.0], backend, method)
    go = np.pi - 3
    assert _told(result) == [(round(go, 9), "s", "apart")]
    assert result["e_s_low"][1] == pytest.approx(-3 * np.sin(3.1), abs=1e-9)
    assert result["v0"][-1] == pytest.approx(3 * (1 - np.cos(2 - go)), abs=1e-8)


def test_an_inertia_is_driven_onto_a_stop_and_pressed_against_it() -> None:
    """2 N on 1 kg over 1 m: there at t = 1 with 2 m/s; then the stop gives all of the force."""
    line = Line((1.0,), (0.0,), (0.0,), (_stop("s", 0, None, 1.0, 0.0, -1),), (Wave(2.0),))
    result = run(line, [0.0, 0.5, 2.0])
    assert [tuple(e) for e in result.events] == [
        (pytest.approx(1.0, abs=1e-12), "s", "touch", pytest.approx(2.0, abs=1e-12))
    ]
    assert result["e_s_high"].tolist() == pytest.approx([0, 0, 2], abs=1e-12)
    assert result["q_s"][-1] == 1.0


LINES = {
    "a gear in its backlash": Line(
        (1.0,), (0.0, 0.0), (0.0,),
        (_stop("s.low", 0, 1, -0.05, 0.6), _stop("s.high", 0, 1, 0.05, 0.6, -1)),
        driven=(Wave(0.0, 1.0, 7.0, 0.3),), dampers={(0, None): 0.2},
    ),
    "a mass on a spring": Line(
        (1.0,), (1.0,), (0.0,), (_stop("s", 0, None, -0.25, 0.7),), springs={(0, None): (9.0, 1.0)}
    ),
    "a mass on a spring that presses": Line(
        (1.0,), (1.0,), (0.0,), (_stop("s", 0, None, 0.5, 0.5),), (Wave(0.0, 1.5, 3.0, 0.2),),
        springs={(0, None): (9.0, 1.0)}, dampers={(0, None): 0.2},
    ),
    "a mass between a floor and what comes down on it": Line(
        (0.5, 2.0), (0.5, 1.5), (0.0, -1.0),
        (_stop("floor", 0, None, 0.0, 0.66), _stop("s", 1, 0, 0.0, 0.44)),
        (Wave(-5.0), Wave(-7.0)),
    ),
}  # fmt: skip


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("name", LINES)
@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_motions_are_those_of_the_judge(name: str, backend: str, method: str) -> None:
    line, times = LINES[name], np.linspace(0, 6, 61)
    course = Machine(line).run(times)
    result = run(line, times, backend, method)
    assert complaints(line, times, result, course, len(times)) == []


def test_two_stops_that_are_one_stop_as_one_does() -> None:
    stops = (_stop("s", 0, None, 0.0, 0.5), _stop("t", 0, None, 0.0, 0.5))
    result = run(Line((1.0,), (1.0,), (-1.0,), stops), [0.0, 1.5])
    assert result["v0"][-1] == pytest.approx(0.5, abs=1e-12)
    assert sum(e.impulse for e in result.events) == pytest.approx(-1.5, abs=1e-12)


def test_at_the_end_of_a_run_what_rests_at_one_bound_stays_there() -> None:
    """Rest at one bound is not the other's event."""
    stops = (_stop("s.low", 0, None, 0.0, 0.0), _stop("s.high", 0, None, 0.6, 0.0, -1))
    result = run(Line((1.0,), (0.5,), (0.0,), stops, (Wave(-1.0),)), [0.0, 2.0, 3.0])
    assert result["q_s"].tolist() == [0.5, 0.0, 0.0]


def test_bodies_that_take_turns_at_two_stops_come_to_rest() -> None:
    """A light mass that a floor and another mass hold by turns: what leaps too low to be seen has stopped."""
    stops = (_stop("floor", 0, None, 0.0, 0.66), _stop("s", 0, 1, -1.0, 0.44))
    line = Line((0.55, 1.92), (0.1, 1.0), (0.0, 0.0), stops, (Wave(-5.0), Wave(2.0)))
    result = run(line, np.linspace(0, 6, 13))
    assert abs(result["v0"][-1]) + abs(result["v1"][-1]) < 1e-9


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_what_joins_throws_back_what_touched_and_was_leaving(backend: str, method: str) -> None:
    """1 and 2 join at 0 m/s; then 2 kg at -2 m/s meet their 2 kg, e = 1/2: 1 m/s apart about -1 m/s."""
    stops = (_stop("throw", 0, 1, 1.0, 0.5), _stop("join", 1, 2, 1.0, 0.0))
    line = Line((2.0, 1.0, 1.0), (1.0, 0.0, -1.0), (-2.0, -3.0, 3.0), stops)
    result = run(line, [0.0, 0.5], backend, method)
    assert [result[f"v{i}"][0] for i in range(3)] == pytest.approx([-0.5, -1.5, -1.5], abs=1e-12)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("bounce", [0.5, 1.0])
def test_a_floor_throws_what_rides_on_a_lift(
    bounce: float, order: int, backend: str, method: str
) -> None:
    """Down at 1 m/s, at the floor at 1/2 s: two stops at one motion, of which one lets go."""
    stops = (_stop("lift", 0, 1, 0.0, bounce), _stop("floor", 0, None, -0.5, bounce))
    line = Line((2.0,), (0.0, 0.0), (-1.0,), stops[::order], (Wave(-20.0),), (Wave(-1.0),))
    result = run(line, [0.0, 0.25, 0.5 + 1e-6, 0.5 + bounce / 20], backend, method)
    assert result["v0"] == pytest.approx([-1, -1, bounce, bounce / 2], abs=2e-5)
    given = {(e.port, e.kind): e.impulse for e in result.events}
    assert given["floor", "hit"] == pytest.approx(-2 * (1 + bounce), abs=1e-9)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
@pytest.mark.parametrize("speed", [1e-10, 1e-9, 1e-8])
def test_what_closes_hardly_faster_than_rounding_is_stopped(
    speed: float, backend: str, method: str
) -> None:
    """It touches as the force already pulls it off: then v = t, q = t^2/2, up to the bound beyond."""
    stops = (_stop("s.low", 0, None, 0.0, 0.0), _stop("s.high", 0, None, 1.0, 0.0, -1))
    line = Line((1.0,), (0.0,), (-speed,), stops, (Wave(1.0),))
    result = run(line, [0.0, 0.5, 1.0], backend, method)
    assert result["v0"] == pytest.approx([0.0, 0.5, 1.0], abs=1e-12)
    assert result["q_s"] == pytest.approx([0.0, 0.125, 0.5], abs=1e-12)
    assert not result.events


def test_a_start_beyond_a_bound_is_refused() -> None:
    with pytest.raises(bg.SimulationError, match="beyond its bound"):
        run(Line((1.0,), (-0.1,), (0.0,), (_stop("s", 0, None, 0.0, 0.0),)), [0.0, 1.0])

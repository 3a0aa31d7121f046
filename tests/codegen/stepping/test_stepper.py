"""Steps from outside against closed forms and against one run whose inputs are held from step to step."""

import pickle

import numpy as np
import pytest
from oracles.switching import CASES, case
from oracles.switching import equations as switched
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Event, Simulator, Sine, Step, Stepper, ZeroOrderHold, simulator

BACKENDS = pytest.mark.parametrize("backend", ["numpy", "c"])

MASS = bg.graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v")], "force > mass > m")

BLOCK = bg.graph(
    [bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
     bg.R("rub", law=bg.DryFriction("L"), effort="f"), bg.Df("way", integrate="x")],
    "force > j > m", "j > rub", "j > way",
)  # fmt: skip


def block(backend: str = "numpy", method: str = "auto", **more: object) -> Stepper:
    """A block of 2 kg that rubs with 3 N."""
    ready = simulator(bg.derive(BLOCK), {"m": 2, "L": 3}, backend=backend)
    return ready.stepper({"v": 1.0}, {"F": 0.0}, method=method, **more)


METHODS = pytest.mark.parametrize(
    ("backend", "method"),
    [("numpy", "auto"), ("numpy", "DOP853"), ("c", "auto"), ("c", "DOP853"), ("c", "Radau")],
)


@METHODS
def test_friction_sticks_and_breaks_away_where_it_does_by_hand(backend: str, method: str) -> None:
    """From 1 m/s it rubs itself to rest at 2/3 s, holds against 2.9 N, and gains 1 m/s^2 under 5 N."""
    one, told = block(backend, method), list[Event]()
    for force, step in [(0.0, 0.5), (0.0, 0.5), (2.9, 0.5), (5.0, 0.25), (5.0, 0.25), (-1.0, 0.5)]:
        one.advance(step, F=force)
        told += one.events
    assert one.backend == backend
    assert [(e.kind, round(e.time, 9)) for e in told] == [
        ("stick", round(2 / 3, 9)), ("slip", 1.5), ("stick", 2.25)
    ]  # fmt: skip
    assert one.signals["v"] == 0.0
    # 1/3 m on the way to rest, 1/8 m pushed, 1/16 m while (1 + 3)/2 m/s^2 stop 1/2 m/s.
    assert one.signals["x"] == pytest.approx(1 / 3 + 1 / 8 + 1 / 16, abs=1e-9)


@METHODS
def test_one_run_whose_inputs_are_held_is_the_same(backend: str, method: str) -> None:
    forces, step = np.random.default_rng(5).uniform(-8, 8, 60).tolist(), 0.05
    ready = simulator(bg.derive(BLOCK), {"m": 2, "L": 3}, backend=backend)
    times = np.arange(len(forces) + 1) * step
    held = ZeroOrderHold(values=forces, period=step)
    run = ready.run(times, {"v": 1.0}, {"F": held}, method=method)
    one = ready.stepper({"v": 1.0}, {"F": 0.0}, method=method)
    rows, told = [dict(one.signals)], list[Event]()
    for force in forces:
        rows.append(dict(one.advance(step, F=force)))
        told += one.events
    assert [(e.port, e.kind) for e in told] == [(e.port, e.kind) for e in run.events]
    assert [e.time for e in told] == pytest.approx([e.time for e in run.events], abs=1e-12)
    assert [*rows[0]] == [*run]
    for name in run.states:
        found = np.array([row[name] for row in rows])
        assert np.abs(found - run[name]).max() <= 1e-9 * np.ptp(run[name]), name
    assert {name: rows[-1][name] for name in run} == {name: run[name][-1] for name in run}


@BACKENDS
def test_steps_add_up_as_if_time_were_not_rounded(backend: str) -> None:
    one = simulator(bg.derive(MASS), {"m": 1}, backend=backend).stepper(inputs={"F": 1})
    for _ in range(1000):
        one.advance(1e-3)
    assert one.time == 1.0
    assert one.signals["v"] == pytest.approx(1.0, abs=1e-13)


@BACKENDS
def test_inputs_may_be_signals_and_go_on_as_they_were(backend: str) -> None:
    """F = sin(2 pi t) for a second leaves nothing; a step in the middle of one is met where it is."""
    one = simulator(bg.derive(MASS), {"m": 2}, backend=backend).stepper(inputs={"F": Sine(1, 1)})
    one.advance(0.5)
    assert one.signals["v"] == pytest.approx(1 / (2 * np.pi), abs=1e-9)
    one.advance(0.5)
    assert one.signals["v"] == pytest.approx(0.0, abs=1e-9)
    assert one.advance(1.0, F=Step(1.25, 4.0))["v"] == pytest.approx(1.5, abs=1e-9)
    assert one.advance(1.0, F=-1)["v"] == pytest.approx(1.0, abs=1e-9)
    assert one.advance(1.0)["v"] == pytest.approx(0.5, abs=1e-9)


@BACKENDS
def test_known_sources_are_told_as_far_as_steps_come(backend: str) -> None:
    """A square wave between 0 and 2 N, of the time alone: 1 m/s gained in each second."""
    graph = bg.graph(
        [bg.Se("force", "1 + sign(sin(2*pi*t))"), bg.One("j"), bg.I("m", 1, flow="v")],
        "force > j > m",
    )
    one = simulator(bg.derive(graph), {}, backend=backend).stepper()
    assert one.signals["v"] == 0.0
    begin = one.state
    assert [round(one.advance(0.25)["v"], 9) for _ in range(8)] == [
        0.5, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0
    ]  # fmt: skip
    assert one.advance(100.0)["v"] == pytest.approx(102.0, abs=1e-8)
    one.restore(begin)
    assert one.advance(0.25)["v"] == pytest.approx(0.5, abs=1e-9)


def counter() -> bg.StateEquations:
    """What is sampled at 0.1, 0.2 .. s: the switch turns each half period, and resets what nothing moves."""
    nodes = [
        bg.Se("force", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.One("pivot"), bg.R("rest", 1),
        bg.Sf("none", 0), bg.One("c"), bg.Df("held", integrate="u"),
        bg.Sw("clock", on="sin(20*pi*t)", reset={"on": {"u": "v + F"}, "off": {"u": "u"}}),
    ]  # fmt: skip
    return bg.derive(bond_graph(nodes, "force>j>m pivot>rest pivot>clock none>c>held"))


@BACKENDS
def test_a_sampled_controller_samples_at_its_instants(backend: str) -> None:
    """By hand: v + F = 2 t + 2 is sampled as the sine rises, at 0.1 s, 0.2 s, ..; steps end there.

    A run begins with no event.
    """
    one = simulator(counter(), {}, backend=backend).stepper(inputs={"F": 2.0})
    found = [one.advance(0.05)["u"] for _ in range(6)]
    assert found == pytest.approx([0.0, 2.2, 2.2, 2.4, 2.4, 2.6], abs=1e-9)
    for _ in range(3):
        one.advance(0.0125)
        assert one.events == ()
    one.advance(0.0125)
    assert [(e.kind, round(e.time, 9)) for e in one.events] == [("off", 0.35)]
    assert one.advance(0.05)["u"] == pytest.approx(2.8, abs=1e-9)
    assert [(e.port, e.kind) for e in one.events] == [("clock", "on")]


@BACKENDS
def test_what_is_sampled_where_an_input_changes_sees_the_new_one(backend: str) -> None:
    """As in one run: the instant is decided anew, and what was told of it is not told again."""
    times = np.array([0.0, 0.05, 0.1, 0.15, 0.2])
    ready = simulator(counter(), {}, backend=backend)
    run = ready.run(times, inputs={"F": ZeroOrderHold([0.0, 0.1], [1.0, 5.0])})
    one, told = ready.stepper(inputs={"F": 1.0}), list[Event]()
    for k, force in enumerate([1.0, 1.0, 5.0, 5.0]):
        one.advance(times[k + 1] - times[k], F=force)
        told += one.events
        if k == 1:
            assert one.signals["u"] == pytest.approx(0.1 + 1.0, abs=1e-9)
        if k == 2:
            assert one.signals["u"] == pytest.approx(0.1 + 5.0, abs=1e-9)
    assert run["u"][3] == pytest.approx(0.1 + 5.0, abs=1e-9)
    assert [(e.port, e.kind) for e in told] == [(e.port, e.kind) for e in run.events]


@BACKENDS
@pytest.mark.parametrize("name", CASES)
def test_modes_are_carried_on(name: str, backend: str) -> None:
    """A hysteresis, dogs, a freewheel: however a run is cut into steps, the same happens."""
    one = case(name)
    ready = simulator(switched(name), one.parameters, one.laws, backend)
    closely = {"initially_on": one.initially_on, "rtol": 1e-12, "atol": 1e-13}
    run = ready.run(one.times, one.initial, one.inputs, **closely)
    steps = ready.stepper(one.initial, one.inputs, **closely)
    told, rows = list[Event](), [dict(steps.signals)]
    for t in one.times[1:]:
        rows.append(dict(steps.advance(t - steps.time)))
        told += steps.events
    assert [(e.port, e.kind) for e in told] == [(e.port, e.kind) for e in run.events]
    assert [e.time for e in told] == pytest.approx([e.time for e in run.events], abs=1e-9)
    assert [e.impulse for e in told] == pytest.approx([e.impulse for e in run.events], rel=1e-9)
    for state in run.states:
        found = np.array([row[state] for row in rows])
        assert np.abs(found - run[state]).max() <= 1e-9 * max(np.ptp(run[state]), 1e-3), state


def ball(backend: str) -> Simulator:
    """A ball that falls from 5 m, g = 10 m/s^2, and is thrown back with 0.8 of its speed."""
    nodes = [
        bg.Se("F", -20),
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.Stop("floor", restitution=0.8),
    ]
    return simulator(bg.derive(bond_graph(nodes, "F>n>m n>floor")), {}, backend=backend)


@BACKENDS
def test_a_stop_that_is_met_where_a_step_ends_is_hit_once(backend: str) -> None:
    """It falls for 1 s, hits with 10 m/s and is up for 1.6 s: steps end just there."""
    one = ball(backend).stepper({"q_floor": 5.0}, initially_on=["floor"])
    told = list[Event]()
    for step in (1.0, 1e-6, 1.6 - 1e-6, 0.1):
        one.advance(step)
        told += one.events
    assert [e.kind for e in told] == ["hit", "hit"]
    assert [e.time for e in told] == pytest.approx([1.0, 2.6], abs=1e-9)
    # (1 + 0.8) m v, which the stop takes from what falls.
    assert [-e.impulse for e in told] == pytest.approx([36.0, 28.8], abs=1e-8)


@METHODS
def test_a_state_is_gone_back_to_digit_for_digit(backend: str, method: str) -> None:
    one = block(backend, method)
    one.advance(0.5)
    kept = one.state
    first = [dict(one.advance(0.3, F=force)) for force in (1.0, 7.0, -2.0)]
    happened = one.events
    for state in (kept, pickle.loads(pickle.dumps(kept))):
        one.restore(state)
        assert (one.time, one.events) == (0.5, ())
        assert one.signals["v"] == pytest.approx(0.25, abs=1e-12)
        assert [dict(one.advance(0.3, F=force)) for force in (1.0, 7.0, -2.0)] == first
        assert one.events == happened
    assert hash(kept) == hash(pickle.loads(pickle.dumps(kept)))


@pytest.mark.parametrize(("one", "other"), [("numpy", "c"), ("c", "numpy")])
@pytest.mark.parametrize("method", ["auto", "DOP853"])
def test_what_one_backend_left_another_goes_on_with(one: str, other: str, method: str) -> None:
    here, there = block(one, method), block(other, method)
    here.advance(0.6)
    there.restore(here.state)
    for stepper in (here, there):
        stepper.advance(0.3, F=4.0)
    assert [(e.kind, round(e.time, 9)) for e in here.events] == [
        (e.kind, round(e.time, 9)) for e in there.events
    ]
    assert here.signals["x"] == pytest.approx(there.signals["x"], abs=1e-10)


@BACKENDS
def test_signals_are_those_of_a_result_and_all_others_by_name(backend: str) -> None:
    now = block(backend).advance(0.5)
    assert (now["v"], now["F"], now["f"], now["x"]) == pytest.approx((0.25, 0.0, 3.0, 0.3125))
    assert now["e_m"] == pytest.approx(-3.0)
    assert len(now) == len([*now])
    with pytest.raises(KeyError, match="no signal 'w'; there are v"):
        now["w"]


@BACKENDS
def test_states_are_told_for_the_instant_before_anything(backend: str) -> None:
    """What a source drives through a dependent storage has its start under the inputs of the first step."""
    graph = bg.graph(
        [bg.Se("source", "V"), bg.One("loop"), bg.I("coil", 1, flow="i"), bg.R("r", 2)],
        "source > loop > coil", "loop > r",
    )  # fmt: skip
    ready = simulator(bg.derive(graph), {}, backend=backend)
    one = ready.stepper("equilibrium", {"V": 6.0})
    assert one.signals["i"] == pytest.approx(3.0)
    assert one.advance(0.5, V=0.0)["i"] == pytest.approx(3 * np.exp(-1.0), abs=1e-9)
    later = ready.stepper({"i": 1.0}, {"V": 0.0}, time=-2.0)
    later.advance(0.5)
    assert (later.time, later.signals["i"]) == (-1.5, pytest.approx(np.exp(-1.0), abs=1e-9))


def test_constants_are_numbers() -> None:
    one = simulator(bg.derive(MASS), {"m": 1}).stepper(inputs={"F": Constant(2)})
    assert one.advance(1.0, F=np.float32(2.0))["v"] == 2.0


@BACKENDS
def test_an_event_that_a_step_ends_at_is_decided_again_under_other_inputs(backend: str) -> None:
    """The ball hits at 1 s with 10 m/s; from then on it falls at 16 m/s^2: back after 2*8/16 s."""
    nodes = [
        bg.Se("F", "F"),
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.Stop("floor", restitution=0.8),
    ]
    ready = simulator(bg.derive(bond_graph(nodes, "F>n>m n>floor")), {}, backend=backend)
    one = ready.stepper({"q_floor": 5.0}, {"F": -20.0}, initially_on=["floor"])
    one.advance(1.0)
    told = list(one.events)
    for _ in range(3):
        one.advance(0.5, F=-32.0)
        told += one.events
    assert [e.kind for e in told[:2]] == ["hit", "hit"]
    assert [e.time for e in told[:2]] == pytest.approx([1.0, 2.0], abs=1e-9)
    assert one.signals["q_floor"] >= 0.0


@METHODS
def test_what_counts_as_zero_is_carried_on(backend: str, method: str) -> None:
    """It is told by the largest magnitudes: the speed, at rest since 2/3 s, has been 1 m/s."""
    one = block(backend, method)
    for _ in range(8):
        one.advance(0.125)
    there = block(backend, method)
    there.restore(one.state)
    for stepper in (one, there):
        assert stepper.state.paused.present.peaks.both[0] == 1.0

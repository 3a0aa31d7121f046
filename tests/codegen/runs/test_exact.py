"""Exact legs: against closed forms, against step control, and where events hide between samples."""

import math

import networkx as nx
import numpy as np
import pytest
import scipy.linalg

import bondgraph as bg
from codegen import Lag, Ramp, Simulator, Sine, Step, simulator
from codegen.runs.watched import powers_of


def _oscillator(level: object = "N") -> "nx.DiGraph[str]":
    """A mass on a spring with a damper, rubbing on a belt that runs at its own speed."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.C("spring", "1/k", effort="F_k"),
        bg.R("damper", "b"), bg.Zero("contact"), bg.R("rub", law=bg.DryFriction(level), flow="w"),
        bg.Sf("belt", "v_b"),
    ])  # fmt: skip
    graph.add_edges_from([
        ("force", "mass"), ("mass", "m"), ("mass", "spring"), ("mass", "damper"), ("mass", "contact"),
        ("contact", "rub"), ("belt", "contact"),
    ])  # fmt: skip
    return graph


NUMBERS = {"m": 2.0, "k": 800.0, "b": 3.0, "N": 5.0}


def _made(**numbers: float) -> Simulator:
    return simulator(bg.derive(_oscillator()), {**NUMBERS, **numbers})


INPUTS = {"F": Lag(Step(0.05, 40.0), 0.03), "v_b": Ramp(0.3, 1.5, 0.0, 0.6)}


def test_exact_and_adaptive_runs_agree() -> None:
    time = np.linspace(0, 2, 801)
    exact = _made().run(time, {"v": 0.4}, INPUTS, method="exact")
    other = _made().run(time, {"v": 0.4}, INPUTS, method="DOP853", rtol=1e-12, atol=1e-13)
    assert [(e.kind, e.port) for e in exact.events] == [(e.kind, e.port) for e in other.events]
    assert [e.kind for e in exact.events] == ["cross", "stick", "slip"]
    for one, two in zip(exact.events, other.events, strict=True):
        assert one.time == pytest.approx(two.time, abs=1e-9)
    for name in exact.columns:
        assert np.abs(exact[name] - other[name]).max() <= 1e-8 * (1 + np.ptp(other[name])), name


def test_a_free_run_is_the_exponential_to_rounding() -> None:
    time = np.linspace(0, 3, 301)
    run = _made(N=0.0).run(time, {"v": 1.0, "F_k": 30.0}, {"F": 0.0, "v_b": -100.0}, method="exact")
    m, k, b = NUMBERS["m"], NUMBERS["k"], NUMBERS["b"]
    M = np.array([[-b / m, -1 / m], [k, 0.0]])
    expected = np.array([scipy.linalg.expm(M * t) @ [1.0, 30.0] for t in time])
    assert np.abs(run["v"] - expected[:, 0]).max() <= 1e-13
    assert np.abs(run["F_k"] - expected[:, 1]).max() <= 1e-12 * np.abs(expected).max()


def test_samples_may_lie_anywhere() -> None:
    rng = np.random.default_rng(3)
    time = np.sort(np.concatenate([[0.0, 2.0], rng.uniform(0, 2, 40), 0.7 + np.arange(5) * 1e-13]))
    ragged = _made().run(time, {"v": 0.4}, INPUTS, method="exact")
    even = _made().run(np.linspace(0, 2, 5), {"v": 0.4}, INPUTS, method="exact")
    assert [e.time for e in ragged.events] == pytest.approx(
        [e.time for e in even.events], abs=1e-12
    )
    assert ragged["v"][-1] == pytest.approx(even["v"][-1], abs=1e-12)


def test_two_crossings_between_two_samples_are_found() -> None:
    """A block that is pushed over its breakaway for a moment, far from any sample."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("push", "F"), bg.One("block"), bg.I("m", "m", flow="v"),
        bg.R("ground", law=bg.DryFriction("N"), flow="w"),
    ])  # fmt: skip
    graph.add_edges_from([("push", "block"), ("block", "m"), ("block", "ground")])
    # The force is above the level three times, for some milliseconds each.
    level = 10 * (1 - 1e-4)
    run = simulator(bg.derive(graph), {"m": 1.0, "N": level}).run(
        [0.0, 1.5], inputs={"F": Sine(10.0, 1.0)}, method="exact"
    )
    released = math.asin(1 - 1e-4) / (2 * math.pi)
    kinds = [(e.kind, round(e.time, 9)) for e in run.events]
    assert kinds[0] == ("slip", round(released, 9))
    assert kinds[1][0] == "stick"
    assert [kind for kind, _ in kinds] == ["slip", "stick"] * 3


def test_a_level_that_falls_below_zero_is_refused_with_its_time() -> None:
    ready = simulator(bg.derive(_oscillator("level")), NUMBERS)
    with pytest.raises(bg.SimulationError, match="the friction at 'rub' has level"):
        ready.run(
            np.linspace(0, 1, 11),
            {"v": 1.0},
            {"F": 0.0, "v_b": 0.0, "level": Ramp(0.0, -10.0, 5.0)},
            method="exact",
        )


def test_models_that_are_not_affine_are_refused() -> None:
    ready = simulator(bg.derive(_oscillator()), NUMBERS, {"rub": "w**3"})
    with pytest.raises(bg.SimulationError, match="not affine"):
        ready.run([0.0, 1.0], inputs={"F": 0.0, "v_b": 0.0}, method="exact")


@pytest.mark.parametrize("count", [1, 2, 3, 7, 64, 100])
def test_powers_come_by_doubling(count: int) -> None:
    leap = np.array([[0.9, 0.2], [-0.3, 0.8]])
    z = np.array([1.0, 2.0])
    rows = powers_of(leap, z, count)
    expected = [np.linalg.matrix_power(leap, k) @ z for k in range(count + 1)]
    assert rows == pytest.approx(np.array(expected), abs=1e-13)


def test_thousands_of_ragged_samples_are_those_of_step_control() -> None:
    rng = np.random.default_rng(8)
    time = np.sort(np.concatenate([[0.0, 2.0], rng.uniform(0, 2, 2000)]))
    exact = _made().run(time, {"v": 0.4}, INPUTS, method="exact")
    other = _made().run(time, {"v": 0.4}, INPUTS, method="DOP853", rtol=1e-12, atol=1e-13)
    for name in exact.columns:
        assert np.abs(exact[name] - other[name]).max() <= 1e-8 * (1 + np.ptp(other[name])), name


@pytest.mark.parametrize("size", [1.0, 1e60, 1e142, 1e300])
@pytest.mark.parametrize("span", [1.0, 1e3])
def test_states_of_any_size_move_alike(size: float, span: float) -> None:
    """The model is linear: the motion over its start is the same, in steps and by long exponentials."""
    graph = _oscillator()
    graph.remove_nodes_from(["contact", "rub", "belt"])
    ready = simulator(bg.derive(graph), {"m": 2.0, "k": 800.0, "b": 1e-3})
    run = ready.run(np.linspace(0, span, 101), {"v": size}, {"F": 0.0}, method="exact")
    M = np.array([[-1e-3 / 2, -1 / 2], [800.0, 0.0]])
    for k in (1, 50, 100):
        expected = scipy.linalg.expm(M * run.time[k])[:, 0]
        assert run["v"][k] / size == pytest.approx(expected[0], abs=2e-11)
        assert run["F_k"][k] / size == pytest.approx(expected[1], abs=1e-9)


@pytest.mark.parametrize("method", ["exact", "DOP853", "Radau"])
def test_an_event_at_the_last_instant_is_one(method: str) -> None:
    """v = 1 - t/2 comes to rest at 2 s, where the run ends; then a force grows to the breakaway at 1 s."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("push", "F"), bg.One("block"), bg.I("m", "m", flow="v"),
        bg.R("ground", law=bg.DryFriction("N"), flow="w"),
    ])  # fmt: skip
    graph.add_edges_from([("push", "block"), ("block", "m"), ("block", "ground")])
    ready = simulator(bg.derive(graph), {"m": 1.0, "N": 1.0})
    run = ready.run(np.linspace(0, 2, 21), {"v": 1.0}, {"F": 0.5}, method=method)
    assert [(e.kind, round(e.time, 9)) for e in run.events] == [("stick", 2.0)]
    run = ready.run(np.linspace(0, 1, 21), {}, {"F": Ramp(0.0, 1.0)}, method=method)
    assert [(e.kind, round(e.time, 9)) for e in run.events] == [("slip", 1.0)]


@pytest.mark.usefixtures("closely")
def test_numbers_past_the_largest_are_refused_with_their_time() -> None:
    graph = _oscillator()
    graph.remove_nodes_from(["contact", "rub", "belt"])
    for rate in (10.0, 1e6):  # in steps, and by long exponentials
        ready = simulator(bg.derive(graph), {"m": 1.0, "k": 1.0, "b": -rate})
        with pytest.raises(bg.SimulationError, match=r"at t = \S+ \w+ is not finite"):
            ready.run(np.linspace(0, 100, 101), {"v": 1.0}, {"F": 0.0})


def test_a_search_for_events_without_end_is_refused() -> None:
    ready = _made(k=1e16)  # 7e7 rad/s for a minute
    with pytest.raises(
        bg.SimulationError, match=r"to look for events until 1000000 s takes .* steps"
    ):
        ready.run([0.0, 1e6], {"v": 0.4}, {"F": 0.0, "v_b": 1.0})

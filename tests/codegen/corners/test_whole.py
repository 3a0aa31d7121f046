"""Runs over the jumps of floor and mod: located, in either direction, many at once, resting on one."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Ramp, Sine, simulator


def _cam(law: str) -> nx.DiGraph:
    """A shaft turned by a source, and a mass that is pushed by its angle."""
    nodes = [bg.Sf("turn", "w"), bg.One("a"), bg.Df("angle", integrate="theta"), bg.Se("cam", law),
             bg.One("n"), bg.I("m", 1, flow="v")]  # fmt: skip
    return bond_graph(nodes, "turn>a>angle cam>n>m")


def _pushed(theta: np.ndarray) -> np.ndarray:
    """The integral of floor by the angle from zero."""
    whole = np.floor(theta)
    return whole * (whole - 1) / 2 + whole * (theta - whole)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("speed", [1.0, -1.0, 37.0, -250.5])
def test_a_push_by_whole_turns(backend: str, speed: float) -> None:
    """However many turns there are between samples."""
    run = simulator(bg.derive(_cam("floor(theta)")), {}, backend=backend).run(
        np.linspace(0, 3, 4), inputs={"w": speed}
    )
    assert run["v"] == pytest.approx(_pushed(speed * run.time) / speed, rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_shaft_that_turns_round(backend: str) -> None:
    """There and back over the same jumps, beside a sum over small steps."""
    swing, f = 2.6, 0.5
    run = simulator(bg.derive(_cam("floor(theta)")), {}, backend=backend).run(
        np.linspace(0, 2, 5), inputs={"w": Sine(swing * np.pi * f, f, np.pi / 2)}
    )
    t = np.linspace(0, 2, 2_000_001)
    theta = 0.5 * swing * np.sin(2 * np.pi * f * t)
    right = np.concatenate([[0], np.cumsum(np.floor(0.5 * (theta[1:] + theta[:-1])))]) * (
        t[1] - t[0]
    )
    assert run["v"] == pytest.approx(right[::500_000], abs=2e-6)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("at", [0.0, 1.0, 2.0, -1.0, -2.0])
def test_resting_on_a_whole_number_is_above(backend: str, at: float) -> None:
    run = simulator(bg.derive(_cam("floor(theta)")), {}, backend=backend).run(
        [0, 1], {"theta": at}, {"w": Constant(0.0)}
    )
    assert run["v"] == pytest.approx([0, at], abs=1e-12)


def test_of_time_alone_it_is_cut_into_exact_parts() -> None:
    nodes = [bg.Se("saw", "mod(t, T)/T"), bg.One("n"), bg.I("m", 1, flow="v")]
    run = simulator(bg.derive(bond_graph(nodes, "saw>n>m")), {"T": 0.25}).run(np.linspace(0, 2, 9))
    assert run["v"] == pytest.approx(run.time / 2, abs=1e-13)


def test_an_input_that_ramps_over_jumps() -> None:
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m*(1 + floor(load))", flow="v")]
    equations = bg.derive(bond_graph(nodes, "push>n>m"), inputs=["load"])
    run = simulator(equations, {"m": 1.0}).run(
        np.linspace(0, 2.5, 6), inputs={"P": 1.0, "load": Ramp(0.0, 1.0)}
    )
    assert run["v"][1:] == pytest.approx(run.time[1:] / (1 + np.floor(run.time[1:])), abs=1e-9)

"""The slopes of rates are what central differences of an evaluation say."""

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator
from codegen.modes.closed import ClosedModel

LAWS = ("q_s**3 + w*q_s", "sinh(q_s)*w", "abs(q_s)*q_s", "q_s/(1 + w**2)", "max(q_s, 2*q_s)", "exp(-q_s)*w",
        "sign(q_s)*sqrt(abs(q_s))", "Piecewise((q_s**2, q_s > 0), (-q_s, True))", "atan2(q_s, 1 + w**2)",
        "min(q_s, w)")  # fmt: skip


def _model(law: str) -> ClosedModel:
    """Two masses, a spring with a law that reads a speed beside, a damper that multiplies."""
    nodes = [bg.One("a"), bg.I("m", 2, flow="v"), bg.C("s", law=law), bg.Zero("z"), bg.One("b"),
             bg.I("n", 3, flow="w"), bg.R("d", law="f_d**3 + v*f_d")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "a>m a>z z>s z>b b>n b>d"))
    return simulator(equations, {}).closed


def _differences(model: ClosedModel, t: float, s: np.ndarray) -> np.ndarray:
    h, none = 1e-5, np.zeros(0)
    columns = []
    for j in range(len(s)):
        step = h * np.eye(len(s))[j]
        ends = [model.evaluate(t, s + side * step, none, none, ()).rate for side in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * h))
    return np.column_stack(columns)


@pytest.mark.parametrize("law", LAWS)
def test_slopes_are_those_of_central_differences(law: str) -> None:
    model = _model(law)
    slopes = model.slopes([], ())
    assert slopes is not None
    rng = np.random.default_rng(1)
    for _ in range(8):
        s = rng.uniform(0.3, 1.5, size=model.size) * rng.choice([-1, 1], size=model.size)
        assert slopes(0.1, s) == pytest.approx(_differences(model, 0.1, s), rel=1e-6, abs=1e-7)


def test_slopes_of_matrices_that_change() -> None:
    """A mass on a crank: products and quotients of what moves."""
    nodes = [bg.One("rot"), bg.I("J", "J*(2 + sin(theta))", flow="omega"), bg.Df("angle", integrate="theta"),
             bg.TF("c", "r*cos(theta) + l"), bg.One("e"), bg.C("s", law="q_s**3")]  # fmt: skip
    graph = bond_graph(nodes, "rot>J rot>angle rot>c>e>s")
    model = simulator(bg.derive(graph), {"J": 1.5, "r": 0.4, "l": 0.9}).closed
    assert model.program.varying
    slopes = model.slopes([], ())
    assert slopes is not None
    s = np.array([0.7, 0.4, -0.6])
    assert slopes(0.0, s) == pytest.approx(_differences(model, 0.0, s), rel=1e-6, abs=1e-7)


def test_on_one_side_of_a_corner_slopes_are_those_of_that_side() -> None:
    model = _model("max(q_s, 2*q_s)")
    assert len(model.program.sides) == 1
    s = np.array([0.2, 0.3, 0.5])
    found = [model.on_sides((side,)).slopes([], ())(0.0, s) for side in (1, -1)]
    at = model.program.law_states.index(model.program.law_states[0]) + len(model.program.states)
    stiff = sorted(abs(one[:, at]).max() for one in found)
    assert stiff[1] == pytest.approx(2 * stiff[0])


def test_where_laws_are_solved_for_there_are_none() -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.Zero("o"), bg.R("r", law="f_r + f_r**3"),
             bg.R("q", law="tanh(e_q)", gives="flow")]  # fmt: skip
    model = simulator(bg.derive(bond_graph(nodes, "n>m n>o o>r o>q")), {}).closed
    assert model.straight.of(()) is not None
    assert model.slopes([], ()) is None


def test_stiff_runs_agree_with_those_of_explicit_steps() -> None:
    ready = simulator(bg.derive(bond_graph(
        [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law="q_s**3"), bg.R("d", law="40*f_d + f_d**3")],
        "n>m n>s n>d",
    )), {})  # fmt: skip
    times = np.linspace(0, 3, 31)
    runs = [ready.run(times, {"q_s": 1.0}, method=method) for method in ("Radau", "DOP853")]
    assert runs[0]["q_s"] == pytest.approx(runs[1]["q_s"], abs=1e-8)

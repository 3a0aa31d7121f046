"""The method that nobody chose: implicit steps where stability holds back explicit ones, else these."""

import networkx as nx
import numpy as np
import pytest
import scipy
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen.runs.methods import Turns
from codegen.tuning import TUNING

SPAN, ANGULAR = 10.0, 3.0


def _filter() -> nx.DiGraph:
    """A mass on a spring beside a leak ``K (e + e^3)``: a rate of K 1/s, and one of an oscillation."""
    nodes = [bg.Se("F", "F"), bg.One("a"), bg.I("m", 1, flow="v"), bg.Zero("z"), bg.C("k", 1, effort="e"),
             bg.R("r", law="K*(e_r + e_r**3)", gives="flow")]  # fmt: skip
    return bond_graph(nodes, "F>a>m a>z>k z>r")


def _right(K: float) -> float:
    def rates(t: float, x: np.ndarray) -> list[float]:
        return [np.sin(ANGULAR * t) - x[1], x[0] - K * (x[1] + x[1] ** 3)]

    run = scipy.integrate.solve_ivp(rates, (0, SPAN), [0, 0], "Radau", rtol=1e-10, atol=1e-12)
    return float(run.y[0, -1])


def _run(K: float, method: str, backend: str = "numpy") -> float:
    model = codegen.simulator(bg.derive(_filter()), {"K": K}, backend=backend)
    inputs = {"F": codegen.Sine(1, ANGULAR / (2 * np.pi))}
    return float(model.run([0, SPAN], inputs=inputs, method=method)["v"][-1])


@pytest.mark.parametrize("K", [10.0, 2e3])
def test_it_asks_for_hardly_more_than_the_better_one(K: float, evaluations: list[int]) -> None:
    asked = {}
    for method in ("auto", "DOP853", "Radau"):
        evaluations[0] = 0
        _run(K, method)
        asked[method] = evaluations[0]
    assert asked["auto"] < 1.5 * min(asked["DOP853"], asked["Radau"]) + 1_000


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("K", [1e2, 1e3, 1e5])
def test_it_is_as_right(K: float, backend: str) -> None:
    assert _run(K, "auto", backend) == pytest.approx(_right(K), abs=1e-8)


def _count(
    turns: Turns, steps: int, length: float, error: float, fastest: float = 1e3
) -> int | None:
    """After how many steps of that length [time constants] and error it turns over."""
    t = 0.0
    for count in range(1, steps + 1):
        t += length / fastest
        if turns.over(t, length / fastest, fastest, error, 100.0):
            return count
    return None


def test_steps_that_errors_hold_back_stay_explicit() -> None:
    assert _count(Turns(2, True), 1_000, 1.0, 0.5) is None
    assert _count(Turns(2, True), 1_000, 0.5, 1e-9) is None
    assert _count(Turns(2, True), 1_000, 1.0, 1e-9) == TUNING.patience


def test_implicit_steps_that_are_no_longer_give_way_and_are_tried_later() -> None:
    turns = Turns(2, True)
    assert _count(turns, 1_000, 1.0, 1e-9) == TUNING.patience
    assert _count(turns, 1_000, 1.1, np.inf) == 2 * TUNING.lot_implicit
    assert turns.explicit
    assert _count(turns, 1_000, 1.0, 1e-9) == TUNING.later * TUNING.patience
    assert _count(turns, 1_000, 50.0, np.inf) is None


def test_what_ends_soon_stays_explicit() -> None:
    turns, fastest = Turns(2, True), 1e3
    stop = 0.5 * TUNING.worth / fastest
    assert not any(turns.over(k / fastest, 1 / fastest, fastest, 1e-9, stop) for k in range(100))

"""Steps that leave where laws have values: they are tried shorter, and an end tells which law wants what."""

import networkx as nx
import numpy as np
import pytest
import scipy
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen.runs.legs import Trials

METHODS = ("auto", "DOP853", "Radau")


def _fast_and_slow() -> nx.DiGraph:
    """A <-> B fast, B <-> C slowly: a stage of a step beyond the fast one's end takes more than there is."""
    nodes: list[tuple] = []
    for one in "ABC":
        nodes += [bg.Zero(f"z{one}", effort=f"mu_{one}"), bg.C(one, law=f"log(q_{one})")]
    for one, other in ("AB", "BC"):
        law = f"k_{one}{other}*(exp(mu_{one}) - exp(mu_{other}))"
        nodes += [bg.One(f"j{one}{other}"), bg.R(f"r{one}{other}", law=law, gives="flow")]
    bonds = "zA>A zB>B zC>C zA>jAB>zB jAB>rAB zB>jBC>zC jBC>rBC"
    return bond_graph(nodes, bonds)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_stage_that_takes_more_than_there_is_is_tried_shorter(backend: str) -> None:
    start, k = {"q_A": 1e-4, "q_B": 1e-9, "q_C": 1.0}, {"k_AB": 1e8, "k_BC": 1.0}
    times = np.linspace(0, 1, 5)
    K = np.array([[-1e8, 1e8, 0], [1e8, -1e8 - 1, 1], [0, 1, -1]])
    right = np.array([scipy.linalg.expm(K * t)[0] @ [*start.values()] for t in times])
    run = codegen.simulator(bg.derive(_fast_and_slow()), k, backend=backend).run(times, start)
    assert run["q_A"] == pytest.approx(right, rel=1e-7)


def _emptied() -> nx.DiGraph:
    """``p' = -(sqrt(p) + 1)`` from 1: empty after 2 (1 - log 2), and then without a value."""
    nodes = [bg.Sf("pump", "Q"), bg.Zero("tank"), bg.C("c", 1, effort="p"),
             bg.R("out", law="sqrt(p) + 1", gives="flow")]  # fmt: skip
    return bond_graph(nodes, "pump>tank>c tank>out")


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("method", METHODS)
def test_where_a_law_ends_the_run_ends_and_names_it(backend: str, method: str) -> None:
    model = codegen.simulator(bg.derive(_emptied()), {}, backend=backend)
    end = 2 * (1 - np.log(2))
    with pytest.raises(
        bg.SimulationError, match="the law at 'out' has no finite value at p = -"
    ) as caught:
        model.run([0, 1, 2], {"p": 1}, {"Q": 0}, method=method)
    assert float(str(caught.value).split()[3]) == pytest.approx(end, rel=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_an_infinite_potential_with_a_finite_rate_is_run(backend: str) -> None:
    """``exp(log 0) = 0``: what is used up reacts no more, and is shown to pull without bound."""
    nodes = [bg.Zero("z", effort="mu"), bg.C("A", law="log(q_A)"),
             bg.R("r", law="exp(mu) - 1", gives="flow")]  # fmt: skip
    model = codegen.simulator(bg.derive(bond_graph(nodes, "z>A z>r")), {}, backend=backend)
    assert model.rhs(0, [0.0], []).tolist() == [1.0]
    times = np.linspace(0, 2, 11)
    run = model.run(times, {"q_A": 0.0})
    assert run["q_A"] == pytest.approx(-np.expm1(-times), abs=1e-9)
    assert run["mu"][0] == -np.inf


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_levels_that_meet_at_an_infinite_slope_stay_met(backend: str) -> None:
    """Two tanks and an orifice: ``d' = -2 sqrt(d)`` of d = p_1 - p_2, from 4 to nothing in 2 s."""
    nodes = [bg.Zero("a"), bg.C("C_1", 1, effort="p_1"), bg.One("o"), bg.Zero("b"),
             bg.C("C_2", 1, effort="p_2"),
             bg.R("v", law="sqrt(abs(e_v))*sign(e_v)", gives="flow")]  # fmt: skip
    model = codegen.simulator(
        bg.derive(bond_graph(nodes, "a>C_1 a>o>v o>b>C_2")), {}, backend=backend
    )
    times = np.linspace(0, 3, 31)
    run = model.run(times, {"p_1": 4, "p_2": 0})
    assert run["p_1"] == pytest.approx(2 + np.maximum(2 - times, 0) ** 2 / 2, abs=1e-8)


def test_a_stage_without_a_state_asks_for_no_rates() -> None:
    """It follows one without rates, which is what is told."""
    asked = []

    def rates(t: float, s: np.ndarray) -> np.ndarray:
        asked.append(t)
        raise bg.SimulationError("no value")

    trials = Trials(rates, lambda t, s: bg.SimulationError("lost"))
    assert np.isnan(trials(0.0, np.array([1.0]))).all()
    assert np.isnan(trials(0.1, np.array([np.nan]))).all()
    assert (asked, str(trials.refused)) == ([0.0], "no value")

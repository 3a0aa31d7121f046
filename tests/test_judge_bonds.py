"""The judge of bond equations at instants: runs that satisfy them, and faults that it must see."""

import random
from collections.abc import Iterable

import networkx as nx
import numpy as np
import pytest
from references.bond_instants import Told, instants, misfits
from references.build import bond_graph
from references.random_graphs import random_graph

import bondgraph as bg
from codegen import Ramp, Result, Sine, Step, simulator

CLOSE = 1e-9
INPUTS = {"push": Sine(9.0, 1.1) + Step(0.4, 3.0), "L_rub": Ramp(0.2, 2.0, 3.0, end=1.2)}


def _told(graph: nx.DiGraph, run: Result, given: Iterable[str], levels: Iterable[str] = ()) -> Told:
    """Sources by name of node and input alike; friction's levels by that of the port."""
    bonds = {bond: tuple(part.copy() for part in run.bond(*bond)) for bond in graph.edges}
    return Told(
        run.time, bonds, {n: run[n].copy() for n in given}, {n: run[f"L_{n}"] for n in levels}
    )


@pytest.mark.parametrize("seed", range(12))
def test_random_graphs_satisfy_their_bond_equations(seed: int) -> None:
    rng = random.Random(f"instants {seed}")
    while True:
        graph = random_graph(rng, 9, symbols=False)
        try:
            equations = bg.derive(graph, outputs=[])
        except bg.BondGraphError:
            continue
        if equations.states and equations.inputs:
            break
    ready = simulator(equations, {})
    inputs = {name: Sine(rng.uniform(1, 3), rng.uniform(0.5, 2)) for name in ready.inputs}
    fast = max(np.abs(np.linalg.eigvals(_rates(ready))).max(), 12.0)
    times = instants([0.0, 0.3], panels=int(np.ceil(0.3 * fast)) + 1)
    run = ready.run(times, dict.fromkeys(ready.states, 0.7), inputs)
    given = {str(port.element.name): run[port.given.name] for port in equations.ports}
    bonds = {bond: run.bond(*bond) for bond in graph.edges}
    assert max(misfits(graph, Told(times, bonds, given)).values()) < CLOSE


def _rates(ready: object) -> np.ndarray:
    """The Jacobian of a linear model, column by column."""
    n, m = len(ready.states), len(ready.inputs)
    origin = ready.rhs(0.0, np.zeros(n), np.zeros(m))
    return np.column_stack([ready.rhs(0.0, e, np.zeros(m)) - origin for e in np.eye(n)])


@pytest.fixture(scope="module")
def braked() -> tuple[nx.DiGraph, Result]:
    """An oscillator pushed against a brake: it slips, sticks and slips again."""
    graph = bond_graph(
        [bg.Se("push", "push"), bg.One("j"), bg.I("m", 2), bg.C("k", "1/40"), bg.R("b", "1/2"),
         bg.R("rub", law=bg.DryFriction("L_rub")), bg.TF("lever", 3), bg.One("far"),
         bg.I("small", "1/10", priority=-1)],
        "push>j>m j>k j>b j>rub j>lever>far>small",
    )  # fmt: skip
    ready = simulator(bg.derive(graph), {})
    coarse = ready.run(np.linspace(0, 2, 3), {"f_m": 1.0}, INPUTS)
    edges = {0.0, 0.2, 0.4, 2.0, *(event.time for event in coarse.events)}
    edges |= {b for b in INPUTS["L_rub"].breakpoints if b < 2}
    return graph, ready.run(instants(edges, panels=6), {"f_m": 1.0}, INPUTS)


def test_a_run_with_friction_satisfies_its_bond_equations(
    braked: tuple[nx.DiGraph, Result],
) -> None:
    graph, run = braked
    assert {event.kind for event in run.events} >= {"stick", "slip"}
    assert max(misfits(graph, _told(graph, run, ["push"], ["rub"])).values()) < CLOSE


@pytest.mark.parametrize("bond", [("j", "b"), ("j", "rub"), ("push", "j"), ("lever", "far")])
def test_the_judge_sees_a_flipped_sign(braked: tuple[nx.DiGraph, Result], bond: tuple) -> None:
    graph, run = braked
    told = _told(graph, run, ["push"], ["rub"])
    told.bonds[bond][0][:] *= -1
    found = misfits(graph, told)
    assert {node for node in bond if found[node] > 0.1}


def test_the_judge_sees_a_dropped_event(braked: tuple[nx.DiGraph, Result]) -> None:
    """Panels that lie over an event: what a storage holds is no longer what flowed into it."""
    graph, _ = braked
    times = instants(np.linspace(0, 2, 40))
    other = simulator(bg.derive(graph), {}).run(times, {"f_m": 1.0}, INPUTS)
    assert misfits(graph, _told(graph, other, ["push"], ["rub"]))["m"] > 1e3 * CLOSE


def test_the_judge_sees_a_lost_joule(braked: tuple[nx.DiGraph, Result]) -> None:
    """A mass that is a millionth slower from half of the run on."""
    graph, run = braked
    told = _told(graph, run, ["push"], ["rub"])
    told.bonds["j", "m"][1][len(run.time) // 2 :] *= 1 - 1e-6
    found = misfits(graph, told)
    assert found["m"] > 1e2 * CLOSE
    assert found["j"] > 1e2 * CLOSE

"""Random graphs whose ratios change: what storages absorb is what their energies gain."""

import random

import networkx as nx
import numpy as np
import pytest
from references.random_graphs import random_graph

import bondgraph as bg
from codegen import Result, Sine, simulator

STEP = 1e-3


#: What the ratios follow: a junction's angle, an input, the time, or a storage's own state.
FOLLOWED = {"angle": "theta", "input": "ctl", "time": "t", "state": "{state}"}


def _turning(seed: int, followed: str) -> nx.DiGraph:
    """A random graph with every ratio modulated."""
    rng = random.Random(seed)
    graph = random_graph(rng, 10, mesh=0.2)
    kinds = dict(graph.nodes(data="kind"))
    ones = [n for n, kind in kinds.items() if kind == "One"]
    ratios = [n for n, kind in kinds.items() if kind in ("TF", "GY")]
    storages = [
        f"{'f' if kind == 'I' else 'e'}_{n}" for n, kind in kinds.items() if kind in ("I", "C")
    ]
    if followed == "angle":
        graph.add_node("angle", kind="Df", integrate="theta")
        graph.add_edge(rng.choice(ones), "angle")
    if followed == "input":
        graph.add_node("lever", kind="Se", value="ctl")
        graph.add_node("rest", kind="R", value=1)
        graph.add_edge("lever", "rest")
    name = FOLLOWED[followed].format(state=rng.choice(storages))
    for at, ratio in enumerate(ratios):
        graph.nodes[ratio]["value"] = f"{1 + at / 3}*(2 + sin({at + 1}*{name}))"
    return graph


def _run(seed: int, followed: str) -> tuple[bg.StateEquations, Result]:
    equations = bg.derive(_turning(seed, followed), outputs=[])
    assert equations.varying
    assert equations.states
    rng = np.random.default_rng(seed)
    numbers = {name.name: float(rng.uniform(0.5, 2)) for name in equations.parameters}
    ready = simulator(equations, numbers)
    start = dict(zip(ready.states, rng.uniform(-1, 1, len(ready.states)).tolist(), strict=True))
    inputs = {name: Sine(0.3, 1.0 + at, offset=0.5) for at, name in enumerate(ready.inputs)}
    return equations, ready.run(np.arange(0, 41) * STEP, start, inputs)


#: Seeds whose graph is regular and has states.
SEEDS = [0, 3, 6, 7, 8, 9, 10, 11]


@pytest.mark.parametrize("followed", FOLLOWED)
@pytest.mark.parametrize("seed", SEEDS)
def test_storages_gain_what_they_absorb(seed: int, followed: str) -> None:
    """Wrong rates of ratios would show here: power balances whatever storages give, energy does not."""
    equations, run = _run(seed, followed)
    storages = [n for n, element in equations.elements.items() if element.kind.stores]
    energy = sum(run.energy(node) for node in storages)
    power = sum(run.power(node) for node in storages)
    # Central differences of fourth order.
    rate = (energy[:-4] - 8 * energy[1:-3] + 8 * energy[3:-1] - energy[4:]) / (12 * STEP)
    size = sum(abs(run.power(node)).max() for node in storages) + 1e-6
    assert abs(rate - power[2:-2]).max() < 1e-5 * size

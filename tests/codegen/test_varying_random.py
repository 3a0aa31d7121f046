"""Random graphs whose ratios turn with an angle: what storages absorb is what their energies gain."""

import random

import networkx as nx
import numpy as np
import pytest
from references.random_graphs import random_graph

import bondgraph as bg
from bondgraph.elements import STORAGES
from codegen import Result, simulator

STEP = 1e-3


def _turning(seed: int) -> nx.DiGraph:
    """A random graph with every ratio modulated by the integral of one junction's flow."""
    rng = random.Random(seed)
    graph = random_graph(rng, 10, mesh=0.2)
    ones = [n for n, kind in graph.nodes(data="kind") if kind == "One"]
    ratios = [n for n, kind in graph.nodes(data="kind") if kind in ("TF", "GY")]
    graph.add_node("angle", kind="Df", integrate="theta")
    graph.add_edge(rng.choice(ones), "angle")
    for at, name in enumerate(ratios):
        graph.nodes[name]["value"] = f"{1 + at / 3}*(2 + sin({at + 1}*theta))"
    return graph


def _run(seed: int) -> tuple[bg.StateEquations, Result]:
    equations = bg.derive(_turning(seed), outputs=[])
    assert "theta" in {name.name for name in equations.varying}
    rng = np.random.default_rng(seed)
    numbers = {name.name: float(rng.uniform(0.5, 2)) for name in equations.parameters}
    ready = simulator(equations, numbers)
    start = dict(zip(ready.states, rng.uniform(-1, 1, len(ready.states)).tolist(), strict=True))
    inputs = dict.fromkeys(ready.inputs, 0.3)
    return equations, ready.run(np.arange(0, 41) * STEP, start, inputs)


#: Seeds whose graph is regular, has states, and feels the angle.
SEEDS = [0, 3, 6, 7, 8, 9, 10, 11, 14, 17, 19, 23]


@pytest.mark.parametrize("seed", SEEDS)
def test_storages_gain_what_they_absorb(seed: int) -> None:
    equations, run = _run(seed)
    storages = [n for n, element in equations.elements.items() if element.kind in STORAGES]
    energy = sum(run.energy(node) for node in storages)
    power = sum(run.power(node) for node in storages)
    # Central differences of fourth order.
    rate = (energy[:-4] - 8 * energy[1:-3] + 8 * energy[3:-1] - energy[4:]) / (12 * STEP)
    size = sum(abs(run.power(node)).max() for node in storages) + 1e-6
    assert abs(rate - power[2:-2]).max() < 1e-5 * size

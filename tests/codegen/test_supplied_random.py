"""Random graphs whose values read an input that steps and swings: every bond equation, storages included."""

import random
from fractions import Fraction

import networkx as nx
import numpy as np
import pytest
from references.bond_instants import Told, instants, misfits
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg
from codegen import Pulse, Signal, Simulator, Sine, simulator

CLOSE, BEGIN, END, LAST = 1e-7, 0.07, 0.19, 0.3
DEPTH = Fraction(1, 2)


def _drawn(rng: random.Random) -> tuple[nx.DiGraph, nx.DiGraph, list[str]]:
    """A graph of numbers, the same with an input in some values, and in which."""
    while True:
        graph = random_graph(rng, rng.randint(4, 11), symbols=False)
        kinds = dict(graph.nodes(data="kind"))
        # How the judge signs an element that is drawn into a two-port is another way.
        if any(kinds[tail] in "ICR" and kinds[head] in ("TF", "GY") for tail, head in graph.edges):
            continue
        ports = [name for name, told in graph.nodes(data=True)
                 if told["kind"] in "ICR" and "value" in told and told["value"] != 1]  # fmt: skip
        fed = [name for name in ports if rng.random() < 0.6]
        supplied = graph.copy()
        for name in fed:
            value = graph.nodes[name]["value"]
            supplied.nodes[name]["value"] = f"({value})*(1 + ({DEPTH})*load)"
        try:
            equations = bg.derive(supplied, outputs=[], inputs=["load"] if fed else [])
        except bg.BondGraphError:
            continue
        if equations.states and fed:
            return graph, supplied, fed


def _fastest(ready: Simulator, load: float) -> float:
    """The largest rate [1/s] at this load."""
    n, given = len(ready.states), [load if name == "load" else 0.0 for name in ready.inputs]
    origin = ready.rhs(0.0, np.zeros(n), given)
    rates = np.column_stack([ready.rhs(0.0, e, given) - origin for e in np.eye(n)])
    return float(np.abs(np.linalg.eigvals(rates)).max())


@pytest.mark.parametrize("seed", seeds("supplied"))
def test_values_that_read_an_input_satisfy_their_bond_equations(seed: int) -> None:
    rng = random.Random(f"supplied {seed}")
    graph, supplied, fed = _drawn(rng)
    equations = bg.derive(supplied, outputs=[], inputs=["load"])
    ready = simulator(equations, {}, backend=rng.choice(["numpy", "c"]))
    # Storages that share a momentum pass impulses to one another where it steps: these no panel sees.
    load: Signal = Sine(0.8, 1.5)
    if not equations.reduction.dependent:
        load = load + Pulse(BEGIN, END, rng.uniform(0.5, 2))
    inputs: dict[str, Signal] = {
        name: Sine(rng.uniform(1, 3), rng.uniform(0.5, 2)) for name in ready.inputs
    }
    inputs["load"] = load
    fast = max(_fastest(ready, -0.8), _fastest(ready, 2.8), 12.0)
    times = instants([0.0, BEGIN, END, LAST], panels=int(np.ceil(0.15 * fast)) + 1)
    run = ready.run(times, dict.fromkeys(ready.states, 0.7), inputs)
    given = {str(p.element.name): run[p.given.name] for p in equations.ports}
    bonds = {bond: run.bond(*bond) for bond in graph.edges}
    factors = 1 + float(DEPTH) * np.array([load(t) for t in times])
    told = Told(times, bonds, given, times_value=dict.fromkeys(fed, factors))
    found = misfits(graph, told)
    assert max(found.values()) < CLOSE, found

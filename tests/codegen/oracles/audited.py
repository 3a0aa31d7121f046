"""Random runs of every kind, whose power balances are to close."""

import random
from collections.abc import Callable

import networkx as nx
import numpy as np
from references.build import bond_graph
from references.cases import CASES
from references.diode_networks import random_network
from references.random_graphs import random_graph

import bondgraph as bg
from codegen import Lag, Ramp, Result, Signal, Sine, Step, simulator, switched_simulator
from oracles.chains import random_chain

CLOSED = 1e-9
"""Of the energy turned over."""


def open_part(result: Result) -> float:
    """What the power balance leaves open, of the energy turned over."""
    audit = result.audit()
    return abs(audit.residual) / audit.turned_over if audit.turned_over else abs(audit.residual)


def _signal(rng: np.random.Generator, steps: bool) -> Signal:
    size, at = float(rng.normal()), float(rng.uniform(0.1, 0.9))
    kinds: list[Callable[[], Signal]] = [
        lambda: Sine(size, float(rng.uniform(0.2, 2.0)), offset=0.3),
        lambda: Lag(Step(at, size), 0.1),
        lambda: Ramp(at, size),
    ]
    if steps:
        kinds.append(lambda: Step(at, size))
    return kinds[int(rng.integers(len(kinds)))]()


def _numbers(equations: bg.StateEquations, rng: np.random.Generator) -> dict[str, float]:
    """A number for every name that an element's value has, whether a run needs it or not."""
    values = [element.value for element in equations.elements.values() if element.value is not None]
    names = {symbol.name for value in values for symbol in value.free_symbols}
    moving = {str(s) for s in (*equations.signals, *equations.integrals, *equations.varying, "t")}
    return {name: float(rng.uniform(0.5, 2)) for name in sorted(names - moving)}


def linear(seed: int, backend: str = "numpy", method: str = "auto") -> Result | None:
    """A random meshed graph under sources that also step; None where it has none of that kind."""
    try:
        equations = bg.derive(random_graph(random.Random(seed), 10, mesh=0.3), outputs=[])
    except bg.BondGraphError:
        return None
    if not equations.states:
        return None
    rng = np.random.default_rng(seed)
    ready = simulator(equations, _numbers(equations, rng), backend=backend)
    start = {name: float(rng.uniform(-1, 1)) for name in ready.states}
    inputs = {name: _signal(rng, True) for name in ready.inputs}
    return ready.run(np.linspace(0, 1, 6), start, inputs, method=method)


def textbook(name: str, backend: str = "numpy") -> Result:
    """A case of a textbook under sines, its numbers drawn by its place."""
    case, rng = CASES[name], np.random.default_rng(list(CASES).index(name))
    equations = bg.derive(bond_graph(case.nodes, case.bonds), outputs=[])
    numbers = {symbol.name: float(rng.uniform(0.5, 2)) for symbol in equations.parameters}
    ready = simulator(equations, numbers, backend=backend)
    start = {state: float(rng.uniform(-1, 1)) for state in ready.states}
    inputs = {one: Sine(1.0, 0.3 + at) for at, one in enumerate(ready.inputs)}
    return ready.run([0, 0.7, 3], start, inputs)


def rubbing(seed: int, backend: str = "numpy", method: str = "auto") -> Result:
    """A random chain of masses with friction that sticks and slips."""
    chain = random_chain(np.random.default_rng(seed), breakaway=bool(seed % 2))
    start = {f"v{i}": v for i, v in enumerate(chain.start.tolist())}
    inputs: dict[str, object] = {f"P{i}": push for i, push in enumerate(chain.pushes)}
    inputs |= {f"L{i}": level for i, level in enumerate(chain.levels)}
    ready = simulator(bg.derive(chain.graph()), {}, backend=backend)
    return ready.run(np.linspace(0, 2, 6), start, inputs, method=method)


def turning(seed: int, backend: str = "numpy", method: str = "auto") -> Result | None:
    """A random graph with ratios and storages that follow an angle, an input, the time or a state."""
    rng, noise = random.Random(seed), np.random.default_rng(seed)
    graph = random_graph(rng, 9, mesh=0.2)
    _modulate(graph, rng, ("angle", "input", "time", "state")[seed % 4])
    try:
        equations = bg.derive(graph, outputs=[])
    except bg.BondGraphError:
        return None
    if not equations.states or not equations.varying:
        return None
    ready = simulator(equations, _numbers(equations, noise), backend=backend)
    start = {name: float(noise.uniform(-1, 1)) for name in ready.states}
    inputs = {name: _signal(noise, False) for name in ready.inputs}
    return ready.run(np.linspace(0, 0.3, 4), start, inputs, method=method)


def _modulate(graph: nx.DiGraph, rng: random.Random, followed: str) -> None:
    kinds = dict(graph.nodes(data="kind"))
    ones = [n for n, kind in kinds.items() if kind == "One"]
    storages = [n for n, kind in kinds.items() if kind in ("I", "C")]
    name = {"time": "t", "input": "ctl", "angle": "theta"}.get(followed)
    if followed == "angle" and ones:
        graph.add_node("angle", kind="Df", integrate="theta")
        graph.add_edge(rng.choice(ones), "angle")
    if followed == "input":
        graph.add_node("lever", kind="Se", value="ctl")
        graph.add_node("rest", kind="R", value=1)
        graph.add_edge("lever", "rest")
    if name is None and storages:
        one = rng.choice(storages)
        name = f"{'f' if kinds[one] == 'I' else 'e'}_{one}"
    for at, node in enumerate(n for n, kind in kinds.items() if kind in ("TF", "GY")):
        graph.nodes[node]["value"] = f"{1 + at / 3}*(2 + sin({at + 1}*{name}))"
    for at, node in enumerate(storages[:2]):
        if followed != "state":
            graph.nodes[node]["value"] = f"{1 + at / 5}*(3 + cos({at + 1}*{name}))"


def rectifying(seed: int, backend: str = "numpy", method: str = "auto") -> Result:
    """A random network with diodes, ideal ones and with resistances; switches run in Python alone."""
    network = random_network(np.random.default_rng(seed), ideal=bool(seed % 2))
    inputs = {f"u_{b.name}": Sine(b.value, b.frequency, phase=b.phase) for b in network.of("S")}
    return switched_simulator(network.graph(), {}).run(
        np.linspace(0.0, 3.0, 7), inputs=inputs, method=method
    )


FAMILIES: dict[str, Callable[..., Result | None]] = {
    "linear": linear, "rubbing": rubbing, "turning": turning, "rectifying": rectifying,
}  # fmt: skip

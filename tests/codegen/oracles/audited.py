"""Runs of every kind, whose power balances are to close."""

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import networkx as nx
import numpy as np
from references.build import bond_graph
from references.cases import CASES
from references.random_graphs import random_graph
from references.switched.random_networks import random_network

import bondgraph as bg
from codegen import (
    Family,
    Lag,
    Ramp,
    Result,
    Signal,
    Sine,
    Step,
    simulator,
    switched_simulator,
)
from codegen.numbers.arrays import Array
from codegen.record.measures import Measure
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of
from oracles.chains import random_chain
from oracles.circuits import Drawing

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


@dataclass(frozen=True)
class Case:
    """One run, in numbers."""

    equations: bg.StateEquations
    numbers: Mapping[str, float]
    times: Array
    start: Mapping[str, float]
    inputs: Mapping[str, object]

    def run(self, backend: str = "numpy", method: str = "auto") -> Result:
        """Its result."""
        ready = simulator(self.equations, self.numbers, backend=backend)
        return ready.run(self.times, self.start, self.inputs, method=method)

    def swept(self, measures: Mapping[str, Measure], method: str = "auto") -> list[Array] | None:
        """Measures of a sweep of it alone by the loop in C; None where the loop leaves it to others."""
        family = Family(self.equations, self.numbers, None, "c")
        settings = {"method": method, "rtol": 1e-10, "atol": 1e-11}
        loop = batch_of(Job(family, (), self.times, measures, self.start, self.inputs, settings))
        if loop is None:
            return None
        found, left = loop([()])
        return None if left else [column[0] for column in found]


def textbook(name: str) -> Case:
    """A case of a textbook under sines, its numbers drawn by its place."""
    case, rng = CASES[name], np.random.default_rng(list(CASES).index(name))
    equations = bg.derive(bond_graph(case.nodes, case.bonds), outputs=[])
    return _case(equations, rng, np.array([0, 0.7, 3]), lambda at: Sine(1.0, 0.3 + at))


def linear(seed: int) -> Case | None:
    """A random meshed graph under sources that also step; None where it has none of that kind."""
    try:
        equations = bg.derive(random_graph(random.Random(seed), 10, mesh=0.3), outputs=[])
    except bg.BondGraphError:
        return None
    rng = np.random.default_rng(seed)
    if not equations.states:
        return None
    return _case(equations, rng, np.linspace(0, 1, 6), lambda at: _signal(rng, True))


def rubbing(seed: int) -> Case:
    """A random chain of masses with friction that sticks and slips."""
    chain = random_chain(np.random.default_rng(seed), breakaway=bool(seed % 2))
    start = {f"v{i}": v for i, v in enumerate(chain.start.tolist())}
    inputs: dict[str, object] = {f"P{i}": push for i, push in enumerate(chain.pushes)}
    inputs |= {f"L{i}": level for i, level in enumerate(chain.levels)}
    return Case(bg.derive(chain.graph()), {}, np.linspace(0, 2, 6), start, inputs)


def turning(seed: int) -> Case | None:
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
    return _case(equations, noise, np.linspace(0, 0.3, 4), lambda at: _signal(noise, False))


def _case(
    equations: bg.StateEquations, rng: np.random.Generator, times: Array,
    signal: Callable[[int], Signal],
) -> Case:  # fmt: skip
    numbers = _numbers(equations, rng)
    ready = simulator(equations, numbers)
    start = {name: float(rng.uniform(-1, 1)) for name in ready.states}
    return Case(
        equations, numbers, times, start, {n: signal(k) for k, n in enumerate(ready.inputs)}
    )


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


def rectifying(seed: int) -> Result:
    """A random network with diodes, ideal ones and with resistances; switches run in Python alone."""
    network = random_network(np.random.default_rng(seed), ideal=bool(seed % 2))
    drawing, times = Drawing(network), np.linspace(0.0, 3.0, 7)
    return switched_simulator(drawing.graph(), {}).run(times, inputs=drawing.inputs())


FAMILIES: dict[str, Callable[[int], Case | None]] = {
    "linear": linear, "rubbing": rubbing, "turning": turning,
}  # fmt: skip

"""Random chains whose numbers are swept, for runs side by side."""

from typing import Any, NamedTuple

import numpy as np

import bondgraph as bg
from codegen import Family, Result, Swept, Table
from codegen.abreast.abreast import Abreast, abreast
from codegen.abreast.asked import Asked
from codegen.numbers.arrays import Array
from oracles.chains import random_chain

TIMES = np.linspace(0.0, 2.0, 81)


class Many(NamedTuple):
    """A sweep over a model: the family's arguments, numbers of each run, and what all share."""

    equations: bg.StateEquations
    parameters: dict[str, float]
    table: Table
    times: Array
    initial: dict[str, float]
    inputs: dict[str, Any]

    def family(self, backend: str = "numpy") -> Family:
        """The model, run by a backend."""
        return Family(self.equations, self.parameters, backend=backend)

    def rows(self) -> Array:
        """The numbers of the runs."""
        return np.asarray(self.table.rows(range(len(self.table))))

    def asked(self) -> Asked:
        """What is asked of runs side by side."""
        given = self.table.names, self.times, self.initial, self.inputs, "auto", True
        return Asked(self.family(), *given)

    def beside(self) -> Abreast:
        """What does them."""
        found = abreast(self.asked())
        assert found is not None
        return found

    def alone(self, row: Array, backend: str = "numpy") -> Result:
        """One run by itself."""
        values = dict(zip(self.table.names, row.tolist(), strict=True))
        simulator = self.family(backend).simulator(**self.asked().changes(row))
        states = {name: v for name, v in values.items() if name in simulator.states}
        inputs = {n: g.of(values) if isinstance(g, Swept) else g for n, g in self.inputs.items()}
        return simulator.run(self.times, {**self.initial, **states}, inputs)


def many_chains(seed: int, runs: int, times: Array = TIMES, breakaway: bool = False) -> Many:
    """A random chain with masses, springs, speeds at the start, pushes and levels that are swept.

    These differ so much that runs come to other events in another order.
    """
    rng = np.random.default_rng(seed)
    chain = random_chain(rng, breakaway)
    graph, parameters = chain.graph(), dict[str, float]()
    for node, data in graph.nodes(data=True):
        if node.startswith(("m", "c")):
            name = f"{node}_value"
            parameters[name] = float(data["value"])
            data["value"] = name
    columns = {n: v * rng.uniform(0.5, 2.0, runs) for n, v in parameters.items()}
    columns["v0"] = rng.normal(size=runs)
    inputs: dict[str, Any] = {}
    for letter, signals in (("P", chain.pushes), ("L", chain.levels)):
        for at, signal in enumerate(signals):
            inputs[f"{letter}{at}"] = Swept(f"size_{letter}{at}", signal)
            columns[f"size_{letter}{at}"] = rng.uniform(0.5, 2.0, runs)
    return Many(bg.derive(graph), parameters, Table(**columns), times, {"v1": 0.3}, inputs)

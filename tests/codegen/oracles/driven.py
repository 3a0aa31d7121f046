"""A mass that an input alone drives: its speed is the input's integral."""

from references.build import bond_graph

import bondgraph as bg
from codegen import Simulator, simulator


def mass(backend: str = "numpy") -> Simulator:
    """2 kg under the force F: v' = F/2."""
    nodes = [bg.Se("push", "F"), bg.One("j"), bg.I("m", "m", flow="v")]
    return simulator(bg.derive(bond_graph(nodes, "push>j>m")), {"m": 2.0}, backend=backend)

"""The package `bondgraph` of the Python package index: states are momenta and displacements."""

from typing import Any

import sympy as sp
from bondgraph.core import Bond, BondGraph

from bondgraph import elements, junctions

ONE_PORTS = {
    "Se": elements.Source_effort, "R": elements.Element_R, "I": elements.Element_I,
    "C": elements.Element_C, "TF": elements.Transformer,
}  # fmt: skip
JUNCTIONS = {"One": junctions.JunctionEqualFlow, "Zero": junctions.JunctionEqualEffort}


def build(spec: dict[str, Any]) -> Any:
    """The graph, its bonds in the order in which they were declared."""
    made = {}
    for name, kind, value in spec["nodes"]:
        if kind in JUNCTIONS:
            made[name] = JUNCTIONS[kind](name)
        elif kind in ("I", "C"):
            made[name] = ONE_PORTS[kind](name, sp.Symbol(value), sp.Symbol(f"x({name})"))
        else:
            made[name] = ONE_PORTS[kind](name, sp.Symbol(value))
    graph = BondGraph()
    for tail, head in spec["bonds"]:
        graph.add(Bond(made[tail], made[head]))
    return graph


def derive(graph: Any) -> Any:
    """What is timed."""
    return graph.get_state_equations()


def relations(result: Any, spec: dict[str, Any]) -> dict[str, Any]:
    """The equations as expressions that vanish; the output is the flow of the first mass."""
    x = [str(state) for state in result]
    dx = [f"d({state})" for state in x]
    rows = [{d: 1, "": -right} for d, right in zip(dx, result.values(), strict=True)]
    output = {"x(m_0)": 1 / sp.Symbol("m_0")}
    return {"x": x, "dx": dx, "u": ["u"], "rows": rows, "output": output}

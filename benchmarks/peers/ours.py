"""This project, run as its peers are."""

from typing import Any

import networkx as nx

import bondgraph as bg


def build(spec: dict[str, Any]) -> Any:
    """The graph as this project wants it."""
    graph: Any = nx.DiGraph()
    for name, kind, value in spec["nodes"]:
        graph.add_node(name, kind=kind, **({} if value is None else {"value": value}))
    graph.add_edges_from(spec["bonds"])
    return graph


def derive(graph: Any) -> Any:
    """What is timed."""
    return graph, bg.derive(graph, outputs=[])


def relations(result: Any, spec: dict[str, Any]) -> dict[str, Any]:
    """The equations as expressions that vanish; the output is the flow of the first mass."""
    graph, equations = result
    x, u = list(equations.states), list(equations.inputs)
    dx = [f"d({state})" for state in x]
    rows = []
    for i in range(len(x)):
        terms = {dx[j]: equations.A[i, j] for j in range(len(x)) if equations.A[i, j] != 0}
        terms |= {str(x[j]): -equations.J[i, j] for j in range(len(x)) if equations.J[i, j] != 0}
        terms |= {str(u[j]): -equations.B[i, j] for j in range(len(u)) if equations.B[i, j] != 0}
        rows.append(terms)
    shown = bg.derive(graph, outputs=["mass_0"])
    output = {str(x[j]): shown.F[0, j] for j in range(len(x)) if shown.F[0, j] != 0}
    return {"x": [str(name) for name in x], "dx": dx, "u": [str(name) for name in u],
            "rows": rows, "output": output}  # fmt: skip

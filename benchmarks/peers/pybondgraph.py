"""`pyBondGraph`: states are momenta and displacements.

It asks for Python 3.13, but only for its aliases ``type A = B``. An older Python reads them here as
``A = B``, which changes nothing of what is derived.
"""

import importlib.machinery
import re
import sys
from typing import Any

import sympy as sp

if sys.version_info < (3, 12):
    _source_to_code = importlib.machinery.SourceFileLoader.source_to_code

    def _plain(self: Any, data: Any, path: Any, **options: Any) -> Any:
        if "pyBondGraph" in str(path):
            data = re.sub(rb"(?m)^type (\w+) = ", rb"\1 = ", bytes(data))
        return _source_to_code(self, data, path, **options)

    importlib.machinery.SourceFileLoader.source_to_code = _plain  # type: ignore[method-assign]

import pyBondGraph as pbg

PARTS = {"Se": pbg.SourceEffort, "R": pbg.Resistor, "I": pbg.Inductor, "C": pbg.Capacitor,
         "TF": pbg.Transformer}  # fmt: skip
JUNCTIONS = {"One": pbg.OneJunction, "Zero": pbg.ZeroJunction}


def build(spec: dict[str, Any]) -> Any:
    """The graph, causality left to the package."""
    made = {
        name: JUNCTIONS[kind](name) if kind in JUNCTIONS else PARTS[kind](name, value)
        for name, kind, value in spec["nodes"]
    }
    graph = pbg.BondGraph()
    for tail, head in spec["bonds"]:
        graph.connect(made[tail], made[head])
    return graph


def derive(graph: Any) -> Any:
    """What is timed: the solution, without the matrices of all efforts and flows."""
    solution = graph.get_solution_equations()
    return {x: solution[sp.Derivative(x, "t")] for x in graph.state_vars}


def relations(result: Any, spec: dict[str, Any]) -> dict[str, Any]:
    """The equations as expressions that vanish; the output is the flow of the first mass."""
    x = [str(state) for state in result]
    dx = [f"d({state})" for state in x]
    rows = [{d: 1, "": -right} for d, right in zip(dx, result.values(), strict=True)]
    return {"x": x, "dx": dx, "u": ["u"], "rows": rows, "output": {"p_m_0": 1 / sp.Symbol("m_0")}}

"""This project, run as the tools beside it are; runs by the backend that is asked for."""

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

import networkx as nx
import numpy as np

import bondgraph as bg
import codegen
from differentials.scenarios import prepared


@dataclass
class Case:
    """What a run needs."""

    spec: dict[str, Any]
    equations: Any
    numbers: Any
    times: Any
    inputs: Any
    laws: Any = field(default_factory=dict)
    initial: Any = field(default_factory=dict)
    simulator: Any = None


def chain_graph(spec: dict[str, Any]) -> tuple[Any, dict[str, float]]:
    """The chain as a graph whose values are names, and their numbers."""
    graph: Any = nx.DiGraph()
    graph.add_nodes_from([bg.Se("drive", "u")])
    numbers: dict[str, float] = {}
    for k, (m, b) in enumerate(zip(spec["inertias"], spec["dampers"], strict=True)):
        graph.add_nodes_from(
            [bg.One(f"j_{k}"), bg.I(f"m_{k}", f"m_{k}", flow=f"w_{k}"), bg.R(f"b_{k}", f"b_{k}")]
        )
        graph.add_edges_from([(f"j_{k}", f"m_{k}"), (f"j_{k}", f"b_{k}")])
        numbers |= {f"m_{k}": m, f"b_{k}": b}
    graph.add_edge("drive", "j_0")
    for k, c in enumerate(spec["compliances"], 1):
        graph.add_nodes_from([bg.Zero(f"z_{k}"), bg.C(f"c_{k}", f"c_{k}")])
        graph.add_edges_from([(f"j_{k - 1}", f"z_{k}"), (f"z_{k}", f"c_{k}"), (f"z_{k}", f"j_{k}")])
        numbers[f"c_{k}"] = c
    return graph, numbers


def derive_chain(spec: dict[str, Any]) -> Any:
    """Equations of the graph, which is built before in no time that counts."""
    graph, numbers = chain_graph(spec)
    times = np.linspace(0.0, spec["end"], spec["samples"])
    return Case(spec, bg.derive(graph, outputs=[]), numbers, times, {"u": spec["torque"]})


def run(case: Case) -> Any:
    """A run by a simulator that is made at the first and kept for others."""
    if case.simulator is None:
        numbers, backend = case.numbers, case.spec["backend"]
        case.simulator = codegen.simulator(case.equations, numbers, case.laws, backend=backend)
    return case.simulator.run(case.times, case.initial, case.inputs)


def chain_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Eigenvalues and speeds."""
    A, J = (np.array(in_numbers(M, ready.numbers)) for M in (ready.equations.A, ready.equations.J))
    values = np.linalg.eigvals(np.linalg.solve(A, J))
    count = len(spec["inertias"])
    return {
        "eigenvalues": [[v.real, v.imag] for v in values.tolist()],
        "values": np.column_stack([found[f"w_{k}"] for k in range(count)]).tolist(),
    }


def in_numbers(matrix: Any, numbers: dict[str, float]) -> list[list[float]]:
    """A matrix of entries with numbers for names."""
    rows, columns = matrix.shape
    return [
        [float(matrix[i, j].subs(numbers)) if matrix[i, j] != 0 else 0.0 for j in range(columns)]
        for i in range(rows)
    ]


def derive_ladder(spec: dict[str, Any]) -> Any:
    """Equations of the circuit."""
    graph: Any = nx.DiGraph()
    graph.add_nodes_from([bg.Se("source", "V")])
    before = "source"
    for k in range(1, spec["sections"] + 1):
        graph.add_nodes_from([
            bg.One(f"s_{k}"), bg.R(f"R_{k}", "R"), bg.I(f"L_{k}", "L"), bg.Zero(f"p_{k}"),
            bg.C(f"C_{k}", "C", effort=f"v_{k}"),
        ])  # fmt: skip
        graph.add_edges_from([
            (before, f"s_{k}"), (f"s_{k}", f"R_{k}"), (f"s_{k}", f"L_{k}"), (f"s_{k}", f"p_{k}"),
            (f"p_{k}", f"C_{k}"),
        ])  # fmt: skip
        before = f"p_{k}"
    graph.add_nodes_from([bg.R("load", "load")])
    graph.add_edge(before, "load")
    times = np.linspace(0.0, spec["end"], spec["samples"])
    numbers = {name: spec[name] for name in ("R", "L", "C", "load")}
    return Case(spec, bg.derive(graph, outputs=[]), numbers, times, {"V": spec["V"]})


def ladder_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and voltages."""
    columns = [found[f"v_{k}"] for k in range(1, spec["sections"] + 1)]
    return {"times": ready.times.tolist(), "values": np.column_stack(columns).tolist()}


def prepare_clutch(spec: dict[str, Any]) -> Any:
    """Fig. 11 as the library has it: the graph, its derivation, its numbers and its inputs."""
    case = prepared("alsd", "fig11")
    given = case.times, case.inputs, case.laws, case.initial
    return Case(spec, case.equations, case.parameters, *given)


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Events and speeds."""
    events = [[event.time, event.kind] for event in found.events]
    return {
        "events": events,
        "values": np.column_stack([found["omega_1"], found["omega_2"]]).tolist(),
    }


def family(spec: dict[str, Any]) -> Any:
    """The differential without its clutch, ready to be swept."""
    tires = {} if spec["linear"] else {
        f"tire_{j}": f"limit*tanh(k_t*r/omega_t{j}_0*(omega_t{j} - omega_t{j}_0)/limit)" for j in (1, 2)
    }  # fmt: skip
    case = prepared("alsd", "fig11", laws={"clutch": "0", **tires})
    numbers = {**case.parameters, **({} if spec["linear"] else {"limit": spec["numbers"]["limit"]})}
    made = codegen.Family(case.equations, numbers, case.laws, backend=spec["backend"])
    engine = codegen.Lag(codegen.Step(0.0, spec["numbers"]["torque_e"]), spec["numbers"]["lag"])
    return made, case.initial, {"tau_e": engine}, spec


def swept(ready: Any, pairs: Any) -> Any:
    """The halfshaft's torque at the end of each run."""
    made, initial, inputs, spec = ready
    table = codegen.Table(k=pairs[:, 0], I_w=pairs[:, 1])
    times, measures = np.array([0.0, spec["end"]]), {"end": codegen.final("tau_k1")}
    found = codegen.sweep(made, table, times, measures, initial, inputs, workers=1, progress=False)
    return np.asarray(found["end"])


def sweep(ready: Any) -> Any:
    """All pairs."""
    return swept(ready, np.array(ready[3]["pairs"]))


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found.tolist()}


def differences(ready: Any) -> Any:
    """No derivatives are made: central differences of the fourth order, by a sweep of eight runs and one."""
    numbers = ready[3]["numbers"]
    at = np.array([numbers["k"], numbers["I_w"]])
    steps = np.array([-2.0, -1.0, 1.0, 2.0]) * 1e-3
    rows = [at] + [at * (1 + s * np.eye(2)[j]) for j in (0, 1) for s in steps]
    found = swept(ready, np.array(rows))
    weights = np.array([1.0, -8.0, 8.0, -1.0]) / 12e-3
    return found[0], [float(weights @ found[1 + 4 * j : 5 + 4 * j] / at[j]) for j in (0, 1)]


def gradient_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The value and its derivatives."""
    return {"value": float(found[0]), "gradient": found[1], "differences": True}


ROWS = {
    "chain": (derive_chain, run, chain_told),
    "ladder": (derive_ladder, run, ladder_told),
    "clutch": (prepare_clutch, run, clutch_told),
    "sweep": (family, sweep, sweep_told),
    "gradient": (family, differences, gradient_told),
}
CANNOT: dict[str, str] = {}

"""Tables where models ask for more than a value: laws in loops, switches, starts, exact steps."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
from codegen import simulator

pytestmark = pytest.mark.usefixtures("compiled_quickly")

diode = bg.LookupTable("diode", [-1, 0, 0.5, 1, 2], [-0.1, 0, 0.1, 1, 6], outside="extend")


def _with(graph: nx.DiGraph, *tables: bg.LookupTable) -> nx.DiGraph:
    graph.graph["tables"] = list(tables)
    return graph


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_law_that_gives_a_signal_from_itself(backend: str) -> None:
    """A diode by its points behind a resistance of 2, beside a coil: (5 - e)/2 = i + f(e)."""
    nodes = [bg.Se("u", "U"), bg.One("j"), bg.R("R", 2), bg.Zero("z"), bg.One("k"), bg.I("L", 1, flow="i"),
             bg.R("d", law="diode(e_d)", gives="flow")]  # fmt: skip
    equations = bg.derive(_with(bond_graph(nodes, "u>j>R j>z>d z>k>L"), diode))
    run = simulator(equations, {}, backend=backend).run(np.linspace(0, 1, 9), inputs={"U": 5})
    right = [brentq(lambda e, i=i: (5 - e) / 2 - i - float(diode(e)), -10, 10) for i in run["i"]]
    assert run["e_d"] == pytest.approx(right, rel=1e-12)
    assert run.backend == backend


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_switch_by_a_table(backend: str) -> None:
    """v = t comes to 0.75 where the table is 1/2: from then on 1 - v goes as exp(-(t - 0.75))."""
    gate = bg.LookupTable("gate", [0, 0.5, 1], [0, 0, 1])
    nodes = [bg.Se("push", 1), bg.One("n"), bg.I("m", 1, flow="v"), bg.Zero("z", on="gate(v) - 1/2"),
             bg.R("b", 1)]  # fmt: skip
    equations = bg.derive(_with(bond_graph(nodes, "push>n>m n>z>b"), gate))
    run = simulator(equations, {}, backend=backend).run([0, 2.75], initially_on=[])
    assert [event.time for event in run.events] == pytest.approx([0.75], abs=1e-9)
    assert run["v"][-1] == pytest.approx(1 - 0.25 * np.exp(-2), rel=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_tables_of_parameters_leave_steps_exact(backend: str) -> None:
    """A resistance that warms: what it is at 50 degrees is a number, and the model affine."""
    warm = bg.LookupTable("warm", [0, 100], [1, 3])
    nodes = [
        bg.Se("push", "F"),
        bg.One("n"),
        bg.I("m", "2*warm(T)", flow="v"),
        bg.R("b", "warm(T)"),
    ]
    equations = bg.derive(_with(bond_graph(nodes, "push>n>m n>b"), warm))
    ready = simulator(equations, {"T": 50}, backend=backend)
    run = ready.run(np.linspace(0, 3, 7), inputs={"F": 4}, method="exact")
    assert run["v"] == pytest.approx(2 * -np.expm1(-run.time / 2), rel=1e-11)


def test_a_start_may_be_looked_up() -> None:
    first = bg.LookupTable("first", [0, 1], [0, 8], method="pchip")
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"),
             {"name": "s", "kind": "Stop", "high": 10, "start": "first(k)"}]  # fmt: skip
    stop = ("s", {key: value for key, value in nodes.pop().items() if key != "name"})
    graph = _with(bond_graph([*nodes, stop], "n>m n>s"), first)
    run = simulator(bg.derive(graph), {"k": 0.25}).run([0, 1], {"v": 1})
    assert run["q_s"] == pytest.approx([2, 3])

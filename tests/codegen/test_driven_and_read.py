"""Inputs and integrals that laws and values read at once: each counts once, and where it moves something."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Ramp, Sine, simulator, to_python


def _charged(source: str, value: str) -> nx.DiGraph:
    """A source on a capacity of a value, beside what has a state."""
    nodes = [
        bg.Se("s", source),
        bg.Zero("z"),
        bg.C("c", value),
        bg.One("o"),
        bg.R("r", 1),
        bg.C("d", 1),
    ]
    return bond_graph(nodes, "s>z>c z>o>r o>d")


def test_an_input_that_a_law_and_a_value_read_is_one_input() -> None:
    """With e = sin(3 load), C = 2 + load and load = t the current is (C e)' = e + 3 C cos(3 t)."""
    equations = bg.derive(_charged("sin(3*load)", "2 + load"), inputs=["load"])
    ready = simulator(equations, {})
    assert ready.inputs == ("load",)
    assert 'INPUTS = ("load",)' in to_python(equations, {})
    run = ready.run(times := np.linspace(0, 1, 11), {}, {"load": Ramp(0.0, 1.0)})
    right = np.sin(3 * times) + 3 * (2 + times) * np.cos(3 * times)
    # At the first sample the ramp has not begun for one who looks from before.
    assert run.bond("z", "c")[1][1:] == pytest.approx(right[1:], rel=1e-9)


@pytest.mark.parametrize(
    ("source", "nodes", "bonds"),
    [
        ("sin(x)", [bg.Df("place", integrate="x")], "o>place"),
        ("1 + q_n", [bg.C("n", law="q_n + q_n**3")], "o>n"),
    ],
)
def test_a_source_of_a_state_that_drives_a_dependent_storage_is_refused(
    source: str, nodes: list, bonds: str
) -> None:
    """Its slope in time would be needed: integrals and states of other laws move as well."""
    graph = _charged(source, "2")
    graph.add_nodes_from(nodes)
    graph.add_edges_from([bonds.split(">")])
    with pytest.raises(
        bg.DependentSourceError, match="let it read the time, parameters and inputs"
    ):
        bg.derive(graph)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_table_of_an_input_in_a_value_has_its_corners_where_the_input_is(backend: str) -> None:
    """Against one that steps finely over lines between points."""
    x, z = np.linspace(-2.3, 2.2, 9), np.random.default_rng(1).uniform(0.7, 1.6, 9)
    graph = bond_graph(
        [
            bg.Sf("s", "U"),
            bg.One("o"),
            bg.TF("g", "map(load)"),
            bg.Zero("z"),
            bg.C("c", 1),
            bg.R("r", 1),
        ],
        "s>o>g>z>c z>r",
    )
    graph.graph["tables"] = [bg.LookupTable("map", x, z)]
    flow, load, times = Sine(0.5, 0.7, 1.0), Sine(1.9, 0.34, 0.5), np.linspace(0, 1, 5)
    right = solve_ivp(
        lambda t, e: np.interp(load(t), x, z) * flow(t) - e, (0, 1), [0.5], "RK45", times,
        max_step=1e-3, rtol=1e-9, atol=1e-10,
    )  # fmt: skip
    run = simulator(bg.derive(graph, inputs=["load"]), {}, backend=backend).run(
        times, {"e_c": 0.5}, {"U": flow, "load": load}
    )
    assert run["e_c"] == pytest.approx(right.y[0], abs=1e-6)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_turned_storage_is_refused_what_its_law_never_gives(backend: str) -> None:
    """``exp(p) - 1`` gives no speed below -1, whatever the momentum."""
    nodes = [bg.Sf("s", "v"), bg.One("o"), bg.I("m", law="exp(p_m) - 1"), bg.C("c", 1)]
    ready = simulator(bg.derive(bond_graph(nodes, "s>o>m o>c")), {}, backend=backend)
    run = ready.run(times := np.linspace(0, 1, 5), {}, {"v": Sine(0.5, 0.5)})
    speed, rate = 0.5 * np.sin(np.pi * times), 0.5 * np.pi * np.cos(np.pi * times)
    assert run["e_m"] == pytest.approx(rate / (1 + speed), abs=1e-9)
    with pytest.raises(bg.SimulationError, match="the law of 'm' gives it in no state"):
        ready.run([0, 1.4, 1.5], {}, {"v": Sine(1.5, 0.5)})

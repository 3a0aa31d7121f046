"""Starts that storages and detectors declare: in runs, files and exports, unless a run tells others."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
import codegen
from bondgraph.declare.declared import elements_of


def _swing(**more: object):
    """A mass on a spring with its way integrated, from 0.3 m and v_0."""
    nodes = [bg.One("n"), bg.I("m", 2, flow="v", start="v_0"), bg.C("k", law="8*q_k", start=0.3),
             bg.Df("way", integrate="x", start="1 + v_0", **more)]  # fmt: skip
    return bond_graph(nodes, "n>m n>k n>way")


def _right(times: np.ndarray, v: float, q: float) -> np.ndarray:
    """``2 v' = -8 q``: of frequency 2 rad/s."""
    return v * np.cos(2 * times) - 2 * q * np.sin(2 * times)


def test_runs_begin_as_the_graph_says() -> None:
    times = np.linspace(0, 2, 11)
    equations = bg.derive(_swing())
    assert {str(name): str(value) for name, value in equations.starts.items()} == {
        "v": "v_0", "q_k": "3/10", "x": "v_0 + 1",
    }  # fmt: skip
    for backend in ("numpy", "c"):
        model = codegen.simulator(equations, {"v_0": 0.5}, backend=backend)
        run = model.run(times)
        assert run["v"] == pytest.approx(_right(times, 0.5, 0.3), abs=1e-8)
        assert run["x"][0] == 1.5
        assert model.run(times, {"v": 0.0})["v"] == pytest.approx(_right(times, 0, 0.3), abs=1e-8)


def test_files_parts_and_sweeps_keep_starts() -> None:
    graph = _swing()
    for again in (bg.from_json(bg.to_json(graph)), bg.from_graphml(bg.to_graphml(graph))):
        assert bg.derive(again).starts == bg.derive(graph).starts
    part = bg.derive(bg.prefixed(graph, "left_", parameters=["v_0"]))
    assert part.starts[sp.Symbol("left_v")] == sp.Symbol("left_v_0")
    family = codegen.Family(bg.derive(graph), {"v_0": 0.5})
    grid, measures = {"v_0": [0.5, 1.0]}, {"last": codegen.final("v")}
    found = codegen.sweep(family, grid, [0.0, 1.0], measures=measures)
    right = [_right(np.ones(1), v, 0.3)[0] for v in (0.5, 1.0)]
    assert found["last"] == pytest.approx(right, abs=1e-8)


def test_exports_begin_there() -> None:
    equations, numbers = bg.derive(_swing()), {"v_0": 0.5}
    module: dict = {}
    exec(codegen.to_python(equations, numbers, name="swing"), module)
    assert module["simulate"]([0.0, 1.0], {}, {}, step=1e-3)["v"][0] == 0.5
    files = codegen.to_c(equations, numbers, name="swing", main=True)
    assert any("0.3" in text and "1.5" in text for text in files.values())


def test_fields_have_starts_by_their_ports() -> None:
    graph = bond_graph(
        [bg.One("a"), bg.One("b"), bg.R("ra", 1), bg.R("rb", 1),
         bg.I("core", [["L", "M"], ["M", "L"]], ports=["p", "s"], flow={"p": "i_p", "s": "i_s"},
              start={"p": "i_0", "s": -1})],
        "a>ra b>rb",
    )  # fmt: skip
    graph.add_edge("a", "core", port="p")
    graph.add_edge("b", "core", port="s")
    equations = bg.derive(graph)
    told = {sp.Symbol("i_p"): sp.Symbol("i_0"), sp.Symbol("i_s"): sp.Integer(-1)}
    assert equations.starts == told
    for again in (bg.from_json(bg.to_json(graph)), bg.from_graphml(bg.to_graphml(graph))):
        assert bg.derive(again).starts == told
    part = bg.derive(bg.prefixed(graph, "one_", parameters=["i_0"]))
    assert part.starts[sp.Symbol("one_i_p")] == sp.Symbol("one_i_0")
    run = codegen.simulator(equations, {"L": 2.0, "M": 1.0, "i_0": 3.0}).run([0.0, 1.0])
    # Sum and difference decay by themselves, by L + M = 3 and L - M = 1.
    total, off = 2 * np.exp(-1 / 3), 4 * np.exp(-1.0)
    assert run["i_p"] == pytest.approx([3.0, (total + off) / 2], abs=1e-9)
    assert run["i_s"] == pytest.approx([-1.0, (total - off) / 2], abs=1e-9)


def test_fields_of_energies_have_starts_too() -> None:
    graph = bond_graph([bg.One("a"), bg.R("ra", 1)], "a>ra")
    energy = "q_c_p**2 + q_c_s**2 + q_c_p*q_c_s"
    graph.add_nodes_from([bg.C("c", energy=energy, ports=["p", "s"], start={"s": 0.5}), bg.One("b"),
                          bg.R("rb", 1)])  # fmt: skip
    graph.add_edge("b", "rb")
    graph.add_edge("a", "c", port="p")
    graph.add_edge("b", "c", port="s")
    run = codegen.simulator(bg.derive(graph), {}).run([0.0, 1.0])
    # Sum and difference, of stiffness 3 and 1.
    total, off = 0.5 * np.exp(-3.0), -0.5 * np.exp(-1.0)
    assert run["q_c_p"] == pytest.approx([0.0, (total + off) / 2], abs=1e-9)
    assert run["q_c_s"] == pytest.approx([0.5, (total - off) / 2], abs=1e-9)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (1, "node 'c': with ports, start maps ports to values, not 1"),
        ({"q": 1}, "node 'c', start: there is no port 'q'.*there are p, s"),
        ({"p": "t"}, "node 'c' at p: its start t reads the time"),
    ],
)
def test_starts_of_no_port_are_refused(start: object, message: str) -> None:
    node = bg.C("c", [[2, 1], [1, 2]], ports=["p", "s"], start=start)
    with pytest.raises(bg.StructureError, match=message):
        elements_of(*node)


@pytest.mark.parametrize(
    ("nodes", "bonds", "message"),
    [
        ([bg.One("n"), bg.I("a", 1, priority=1), bg.I("b", 1, start=1)], "n>a n>b",
         "node 'b' has a start, but is dependent: others rule its f_b"),
        ([bg.One("n"), bg.I("a", 1, start="2*e_a"), bg.R("r", 1)], "n>a n>r",
         "its start reads e_a, a signal"),
        ([bg.One("n"), bg.I("a", 1, start="t"), bg.R("r", 1)], "n>a n>r", "its start t reads the time"),
        ([bg.One("n"), bg.I("a", 1), bg.Df("d", start=1)], "n>a n>d",
         "it has a start, but integrates nothing"),
        ([bg.One("n"), bg.I("a", 1), bg.R("r", 1, start=1)], "n>a n>r", "unknown attribute 'start'"),
    ],
)  # fmt: skip
def test_starts_of_what_is_no_state_are_refused(nodes, bonds: str, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(bond_graph(nodes, bonds))


def test_a_run_may_begin_at_rest() -> None:
    """A mass that hangs on a spring of its own law, 20 = 8 q + q^3, and is pulled at 0.5 s."""
    nodes = [bg.Se("weight", "F"), bg.One("n"), bg.I("m", 2, flow="v"), bg.C("k", law="8*q_k + q_k**3"),
             bg.R("b", 3)]  # fmt: skip
    model = codegen.simulator(bg.derive(bond_graph(nodes, "weight>n>m n>k n>b")), {})
    run = model.run([0, 0.25, 0.5, 1], "equilibrium", {"F": codegen.Step(0.5, 25, 20)})
    q = np.roots([1, 0, 8, -20])
    rest = float(q[abs(q.imag) < 1e-12][0].real)
    assert run["q_k"][:3] == pytest.approx(np.full(3, rest), abs=1e-9)
    assert run["q_k"][3] > rest + 0.05
    assert run["v"][:3] == pytest.approx(np.zeros(3), abs=1e-9)


def test_what_drifts_has_no_rest_to_begin_at() -> None:
    nodes = [bg.Se("weight", "F"), bg.One("n"), bg.I("m", 2, flow="v")]
    model = codegen.simulator(bg.derive(bond_graph(nodes, "weight>n>m")), {})
    with pytest.raises(bg.SimulationError, match="no steady state was found: a state may drift"):
        model.run([0, 1], "equilibrium", {"F": 1})
    with pytest.raises(bg.SignalError, match="initial must map names to values, not be 'rest'"):
        model.run([0, 1], "rest", {"F": 1})

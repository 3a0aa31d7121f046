"""Runs come over the corners of tables where closed forms do, few sides telling of many corners."""

from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

import bondgraph as bg
from bondgraph.errors import SimulationError
from codegen import simulator
from codegen.corners.located import with_corners
from codegen.corners.tabled import Edge, LookOn, region_of
from codegen.program.gains import written_out
from codegen.program.lower import lower

BACKENDS = ("numpy", "c")

pytestmark = pytest.mark.usefixtures("compiled_quickly")


def _graph(law: str, *tables: bg.LookupTable) -> nx.DiGraph:
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law=law)]
    graph = bond_graph(nodes, "push>n>m n>r")
    graph.graph["tables"] = list(tables)
    return graph


@pytest.mark.parametrize("backend", BACKENDS)
def test_corners_are_located_where_they_are(backend: str) -> None:
    """Free fall through air by a table, one line after the other: from each point on an exponential."""
    F, v = 10.0, np.array([0.0, 1.0, 2.0, 4.0, 5.0])
    drag = np.array([0.0, 0.5, 2.0, 6.0, 9.5])
    crossed, t = [], 0.0
    for (a, b), (p, q) in zip(pairwise(v), pairwise(drag), strict=True):
        slope = (q - p) / (b - a)
        t += np.log((F - p) / (F - q)) / slope
        crossed.append(t)
    # Beyond the last point the drag is held: the speed grows straight on.
    ready = simulator(
        bg.derive(_graph("drag(v)", bg.LookupTable("drag", v, drag))), {}, backend=backend
    )
    run = ready.run([0.0, crossed[-1] + 2.0], inputs={"F": F}, corners=True)
    found = [event.time for event in run.events if event.kind == "corner" and event.time > 1e-6]
    assert found == pytest.approx(crossed, rel=1e-8)
    assert run["v"][-1] == pytest.approx(5 + 0.5 * 2.0, rel=1e-8)
    assert {event.port for event in run.events} == {"r"}


@pytest.mark.parametrize("backend", BACKENDS)
def test_corners_of_both_axes_are_located(backend: str) -> None:
    """At v' = 1 over x = v and y = 2 v the corners are at the points of either axis."""
    x, y = [0.0, 0.3, 1.0, 2.0], [0.0, 0.5, 1.5, 9.0]
    table = bg.LookupTable(
        "f", x, y, np.random.default_rng(0).normal(size=(4, 4)), method="bilinear"
    )
    nodes = [bg.Se("push", 1), bg.One("n"), bg.I("m", 1, flow="v"), bg.One("far"),
             bg.Se("other", "f(v, 2*v)"), bg.I("m_2", 1, flow="w")]  # fmt: skip
    graph = bond_graph(nodes, "push>n>m other>far>m_2")
    graph.graph["tables"] = [table]
    run = simulator(bg.derive(graph), {}, backend=backend).run([0, 1.8], {"v": -0.1}, corners=True)
    found = [event.time - 0.1 for event in run.events]
    assert found == pytest.approx([0.0, 0.0, 0.25, 0.3, 0.75, 1.0], abs=1e-8)


@pytest.mark.parametrize("backend", BACKENDS)
def test_ends_and_points_of_cubic_tables_are_located(backend: str) -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 1, 4], method="pchip")
    nodes = [bg.Se("push", 1), bg.One("n"), bg.I("m", 1, flow="v"), bg.C("c", law="f(v)*q_c/1e9")]
    graph = bond_graph(nodes, "push>n>m n>c")
    graph.graph["tables"] = [table]
    run = simulator(bg.derive(graph), {}, backend=backend).run([0, 3], {"v": -0.5}, corners=True)
    assert [event.time for event in run.events] == pytest.approx([0.5, 1.5, 2.5], abs=1e-8)


@pytest.mark.parametrize("method", ["pchip", "akima"])
@pytest.mark.parametrize("backend", BACKENDS)
def test_no_step_goes_over_a_jump_of_second_slopes(backend: str, method: str) -> None:
    """Between points what is summed up is a cubic of time, which steps of order eight do exactly."""
    x, rng = np.array([0.0, 0.31, 0.7, 1.13, 1.6, 2.0]), np.random.default_rng(8)
    z = rng.normal(size=len(x))
    table = bg.LookupTable("f", x, z, method=method)
    nodes = [bg.Se("push", 1), bg.One("n"), bg.I("m", 1, flow="v"), bg.One("far"),
             bg.Se("other", "f(v)"), bg.I("m_2", 1, flow="w")]  # fmt: skip
    graph = bond_graph(nodes, "push>n>m other>far>m_2")
    graph.graph["tables"] = [table]
    times = np.linspace(0, 1.9, 20)
    run = simulator(bg.derive(graph), {}, backend=backend).run(times, method="DOP853")
    made = PchipInterpolator(x, z) if method == "pchip" else Akima1DInterpolator(x, z)
    assert run["w"] == pytest.approx(made.antiderivative()(times), abs=1e-13)


@pytest.mark.parametrize("method", ["linear", "pchip"])
@pytest.mark.parametrize("backend", BACKENDS)
def test_a_run_that_leaves_ends_by_name(backend: str, method: str) -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 1, 2], method=method, outside="refuse")
    ready = simulator(bg.derive(_graph("f(v)", table)), {}, backend=backend)
    # v = 4 (1 - exp(-t)) comes to 2 at log(2).
    assert ready.run([0, 0.69], inputs={"F": 4})["v"][-1] == pytest.approx(4 - 4 * np.exp(-0.69))
    says = r"at t = 0\.69314\d* v leaves table 'f', which is from 0\.0 to 2\.0"
    with pytest.raises(SimulationError, match=says):
        ready.run([0, 1], inputs={"F": 4})
    with pytest.raises(SimulationError, match=r"at t = 0 v leaves table 'f'"):
        ready.run([0, 1], {"v": 3}, inputs={"F": 4})
    # What comes to the end and turns there stays in: v = 2 t - t^2/2 without the table's slope.
    flat = bg.LookupTable("f", [0, 1, 2], [0, 0, 0], method=method, outside="refuse")
    turning = simulator(bg.derive(_graph("f(v)", flat)), {}, {"push": "1.99 - t"}, backend=backend)
    assert turning.run([0, 3], {"v": 0.01})["v"][-1] == pytest.approx(0.01 + 1.99 * 3 - 4.5)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_table_that_is_not_looked_into_ends_no_run(backend: str) -> None:
    table = bg.LookupTable("f", [0, 1], [0, 1], outside="refuse")
    law = "Piecewise((f(v), v < 1), (v, True))"
    ready = simulator(bg.derive(_graph(law, table)), {}, backend=backend)
    assert ready.run([0, 3], inputs={"F": 4})["v"][-1] == pytest.approx(4 - 4 * np.exp(-3.0))


def test_few_sides_tell_of_many_corners() -> None:
    x = np.linspace(0, 1, 1000)
    program = lower(bg.derive(_graph("f(v)", bg.LookupTable("f", x, x**2))), None, [], True)
    found = with_corners(program).corners
    assert found is not None
    assert len(found.sides) == 10
    assert all(isinstance(one, Edge) for one in written_out(found.values)[:10])
    (law,) = [one for code in found.blocks for one in written_out(code) if one.has(LookOn)]
    assert law.free_symbols >= set(found.sides)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_thousand_points_are_as_good_as_what_they_are_of(backend: str) -> None:
    """v' = 1 - v^2, tanh(t): lines over steps of 1/500 are off by a millionth."""
    x = np.linspace(0, 2, 1001)
    ready = simulator(bg.derive(_graph("f(v)", bg.LookupTable("f", x, x**2))), {}, backend=backend)
    run = ready.run(np.linspace(0, 1, 5), inputs={"F": 1}, corners=True)
    assert run["v"] == pytest.approx(np.tanh(run.time), abs=1e-6)
    assert len(run.events) == int(np.floor(np.tanh(1) * 500))


@pytest.mark.parametrize("count", [1, 2, 3, 6, 7, 8])
def test_stretches_are_numbered_by_their_sides(count: int) -> None:
    bits = count.bit_length()
    for region in range(count + 1):
        gray = region ^ (region >> 1)
        sides = [sp.Integer(-1 if gray >> bit & 1 else 1) for bit in range(bits)]
        assert region_of(sides) == region


def test_tables_of_parameters_and_time_alone_have_no_sides() -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 1, 3])
    for law in ("f(k)*v", "f(t)*v + f(k*t)"):
        program = lower(bg.derive(_graph(law, table)), None, ["k"], True)
        assert with_corners(program).corners is None


@pytest.mark.parametrize("method", ["linear", "pchip"])
@pytest.mark.parametrize("backend", BACKENDS)
def test_what_rests_on_an_end_is_inside(backend: str, method: str) -> None:
    """At rest on the first point, then pushed along: v = (t - 1)^2/2; and so on the last."""
    flat = bg.LookupTable("f", [0, 1, 2], [0, 0, 0], method=method, outside="refuse")
    push = {"push": "Max(t - 1, 0)"}
    ready = simulator(bg.derive(_graph("f(v)", flat)), {}, push, backend=backend)
    run = ready.run([0, 0.5, 2.5])
    assert run["v"] == pytest.approx([0, 0, 1.125], abs=1e-9)
    assert run.backend == backend
    down = {"push": "-Max(t - 1, 0)"}
    ready = simulator(bg.derive(_graph("f(v)", flat)), {}, down, backend=backend)
    assert ready.run([0, 0.5, 2.5], {"v": 2})["v"] == pytest.approx([2, 2, 0.875], abs=1e-9)
    with pytest.raises(SimulationError, match=r"at t = 1\.\d* v leaves table 'f'"):
        ready.run([0, 2.5])

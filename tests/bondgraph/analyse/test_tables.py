"""Linear models at points of tables: slopes by differences, corners and ends refused by name."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator

x = np.array([-2.0, -1.0, 0.5, 2.0, 3.0])
y = np.array([0.0, 0.4, 1.0, 2.0])
TABLES = [
    bg.LookupTable("f", x, np.sin(x), method=method, outside=outside)
    for method in ("linear", "pchip", "akima")
    for outside in ("hold", "extend")
] + [
    bg.LookupTable("f", x, y, np.outer(np.sin(x), np.exp(y)) if full else np.outer(x, y), method=method)
    for method, full in (("bilinear", True), ("bicubic", False))
]  # fmt: skip
TABLES[-1] = bg.LookupTable("f", x, y, np.outer(np.sin(x), np.exp(y)), method="bicubic")


def _graph(table: bg.LookupTable, law: str) -> nx.DiGraph:
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law=law)]
    graph = bond_graph(nodes, "push>n>m n>r")
    graph.graph["tables"] = [table]
    return graph


@pytest.mark.parametrize("at", [-1.7, 0.1, 2.6, 4.0])
@pytest.mark.parametrize("table", TABLES, ids=lambda one: f"{one.method} {one.outside}")
def test_slopes_are_those_of_the_rates(table: bg.LookupTable, at: float) -> None:
    law = "f(v)" if len(table.axes) == 1 else "f(v, F/3)"
    equations = bg.derive(_graph(table, law))
    there = bg.linearize(equations, {"v": at, "F": 2.0}).numeric({})
    ready, h = simulator(equations, {}), 1e-6
    by_v = (ready.rhs(0, [at + h], [2.0]) - ready.rhs(0, [at - h], [2.0])) / (2 * h)
    by_F = (ready.rhs(0, [at], [2.0 + h]) - ready.rhs(0, [at], [2.0 - h])) / (2 * h)
    assert there.P[0, 0] == pytest.approx(by_v[0], abs=1e-8)
    assert there.Q[0, 0] == pytest.approx(by_F[0], abs=1e-8)


@pytest.mark.parametrize(
    ("table", "at"),
    [(TABLES[0], 0.5), (TABLES[0], 3.0), (TABLES[1], 2.0), (TABLES[2], 3.0), (TABLES[4], -2.0)],
    ids=["inside", "end", "bent", "end of pchip", "end of akima"],
)
def test_corners_are_refused_by_name(table: bg.LookupTable, at: float) -> None:
    equations = bg.derive(_graph(table, "f(v)"))
    with pytest.raises(
        bg.SignalError, match=rf"law at 'r' has a corner.*table 'f' has one at v = {at}"
    ):
        bg.linearize(equations, {"v": at, "F": 0})


def test_points_in_a_row_are_no_corner() -> None:
    table = bg.LookupTable("f", [0, 1, 2], [0, 2, 4])
    assert (
        bg.linearize(bg.derive(_graph(table, "f(v)")), {"v": 1, "F": 0}).numeric({}).P[0, 0] == -2
    )


def test_ends_are_refused_by_name() -> None:
    table = bg.LookupTable("f", x, np.sin(x), method="akima", outside="refuse")
    equations = bg.derive(_graph(table, "f(v)"))
    with pytest.raises(bg.SignalError, match=r"law at 'r' leaves table 'f', which ends, at 3\.5"):
        bg.linearize(equations, {"v": 3.5, "F": 0})


def test_a_point_that_hangs_on_parameters_needs_their_numbers() -> None:
    equations = bg.derive(_graph(TABLES[0], "f(v - gap)"))
    with pytest.raises(
        bg.SignalError, match="in table 'f' the operating point lies depends on gap"
    ):
        bg.linearize(equations, {"v": 1, "F": 0})
    assert bg.linearize(equations, {"v": 1, "F": 0, "gap": 0.2}).J[0, 0] != 0
    smooth = bg.derive(_graph(TABLES[3], "f(v - gap)"))
    assert bg.linearize(smooth, {"v": 1, "F": 0}).numeric({"gap": 0.2}).P[0, 0] < 0


def test_ratios_by_tables_have_their_corners_as_well() -> None:
    ratio = bg.LookupTable("f", [0, 1, 2], [1, 2, 5])
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w"), bg.Df("angle", integrate="phi"),
             bg.TF("g", "f(phi)"), bg.One("b"), bg.R("r", "r")]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J a>angle a>g>b>r")
    graph.graph["tables"] = [ratio]
    equations = bg.derive(graph)
    model = bg.linearize(equations, {"w": 2, "phi": 0.5, "T": 0}).numeric({"J": 1, "r": 3})
    # w' = -r f(phi)^2 w: by w -r f^2, by phi -2 r f f' w.
    assert np.allclose(model.P[0], [-3 * 1.5**2, -2 * 3 * 1.5 * 1 * 2])
    with pytest.raises(bg.SignalError, match="table 'f' has one at phi = 1"):
        bg.linearize(equations, {"w": 2, "phi": 1, "T": 0})

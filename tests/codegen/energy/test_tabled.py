"""Energies of storages whose laws are tables, against the interpolators' own integrals and against work."""

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.interpolated import random_table
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

import bondgraph as bg
from bondgraph.tables.integral import integrated
from bondgraph.tables.looking import looked_up
from bondgraph.tables.pieces import pieces
from codegen import simulator
from codegen.energy.tabled import integral_of

q = sp.Symbol("q", real=True)


@pytest.mark.parametrize("outside", ["hold", "extend", "refuse"])
@pytest.mark.parametrize("method", ["linear", "pchip", "akima"])
def test_integrals_are_the_interpolators_own(method: str, outside: str) -> None:
    table, (x, z) = random_table(method, outside)
    made = {"pchip": PchipInterpolator, "akima": Akima1DInterpolator}
    for at in np.random.default_rng(4).uniform(x[0] - 1, x[-1] + 1, 200):
        inside = min(max(at, x[0]), x[-1])
        if method == "linear":
            points = np.append(x[x < inside], inside)
            right = cumulative_trapezoid(np.interp(points, x, z), points, initial=0)[-1]
            end = 0 if at < x[0] else len(x) - 2
            slope = (z[end + 1] - z[end]) / (x[end + 1] - x[end]) if outside == "extend" else 0.0
            right += (at - inside) * (np.interp(inside, x, z) + 0.5 * slope * (at - inside))
        else:
            spline = made[method](x, z)
            right = spline.antiderivative()(at if outside == "extend" else inside, extrapolate=True)
            right += (at - inside) * spline(inside) if outside == "hold" else 0.0
        found = looked_up(integrated(pieces(table), z[0], z[-1]), (0,), (at,))
        if outside == "refuse" and at != inside:
            assert np.isnan(found)
        else:
            assert found == pytest.approx(right, rel=1e-10, abs=1e-10)


def _graph(law: str, *tables: bg.LookupTable) -> nx.DiGraph:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("c", law=law)]
    graph = bond_graph(nodes, "n>m n>c")
    graph.graph["tables"] = list(tables)
    return graph


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize(
    "law", ["k*f(q_c)", "f(2*q_c + 0.1) + q_c/2 + 3*f(-q_c) - f(1)", "f(k*q_c)*k"]
)
@pytest.mark.parametrize("method", ["linear", "pchip", "akima"])
def test_a_spring_by_a_table_holds_what_the_mass_gave(law: str, method: str) -> None:
    """An oscillator without a loss: 2 J in the beginning, and in all at all times."""
    table = bg.LookupTable("f", [-1.5, -0.4, 0, 0.8, 2], [-4, -1, 0, 1.5, 7], method=method)
    ready = simulator(bg.derive(_graph(law, table)), {"k": 2.0} if "k" in law else {})
    run = ready.run(np.linspace(0, 5, 41), {"v": 2.0})
    held = run.energy("c")
    assert held + 0.5 * run["v"] ** 2 == pytest.approx(2.0, rel=1e-7)
    assert np.ptp(held) > 0.5


def test_what_has_no_closed_form_is_refused() -> None:
    f, g = bg.LookupTable("f", [0, 1], [0, 1]), bg.LookupTable("g", [0, 1], [0, 1], np.eye(2))
    for law in (f(q**2), q * f(q), f(q) ** 2, f(f(q)), g(q, 1), sp.sin(f(q))):
        assert integral_of(law, q) is None
    ready = simulator(bg.derive(_graph("q_c*f(q_c)", f)), {})
    with pytest.raises(bg.SignalError, match="'c': no closed form of the energy; ask for its work"):
        ready.run([0, 1], {"v": 1}).energy("c")


def test_integrals_of_slopes_are_the_tables() -> None:
    f = bg.LookupTable("f", [0, 1, 3], [1, 2, 3])
    assert integral_of(sp.diff(f(q), q), q) == f(q) - f(0)
    assert integral_of(3 * f(sp.Symbol("k")), q) == 3 * q * f(sp.Symbol("k"))
    assert sp.diff(integral_of(f(2 * q), q), q) == f(2 * q)

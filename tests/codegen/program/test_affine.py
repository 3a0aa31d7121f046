"""When a law is affine, and the matrix of one mode cut into parts."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from bondgraph.algebra.expressions import expression
from codegen import simulator
from codegen.program.affine import AffineMap, is_affine

PARAMETERS = {"k", "b", "x_0"}
AFFINE = [
    "0", "3.5", "k", "k*x", "k*x + b*y - 1", "k*(x - x_0)/b", "exp(k)*x", "abs(k)", "k**2*x",
    "x/(k + b)", "(x + y)**2 - x**2 - 2*x*y - y**2 + x", "log(exp(k))*x", "(x + y)*(k + 1)/b + atan2(k, b)",
]  # fmt: skip
NOT_AFFINE = [
    "x*y", "x**2", "1/x", "sin(x)", "exp(-x)", "abs(x)", "sign(x)", "max(x, 0)", "min(x, y)",
    "k*t", "t", "x*t", "sqrt(x)", "tanh(x/k)", "abs(x - y)*k", "sign(x)*k", "x/(y + k)", "k**x",
    # Their slopes hold no signal.
    "atan2(x - 1/2, 0)", "atan2(x, 0)", "log(exp(x))", "sqrt(x**2)/x", "sqrt(x**2)", "k*x + atan2(y, 0)",
    "acos(cos(x))", "asin(sin(x))", "atan(tan(x))", "x + 0*log(y) + y/abs(y)",
]  # fmt: skip


@pytest.mark.parametrize("text", AFFINE)
def test_affine(text: str) -> None:
    assert is_affine([expression(text, "law")], PARAMETERS)


@pytest.mark.parametrize("text", NOT_AFFINE)
def test_not_affine(text: str) -> None:
    assert not is_affine([expression(text, "law")], PARAMETERS)
    assert not is_affine([expression("k*x", "law"), expression(text, "law")], PARAMETERS)


@pytest.mark.parametrize("step", ["floor(x)", "Heaviside(x)", "Piecewise((1, x > 0), (x, True))"])
def test_steps_as_sympy_expressions_are_not_affine(step: str) -> None:
    assert not is_affine([sp.sympify(step)], set())


def test_factors_without_a_finite_number_are_refused() -> None:
    """A matrix of infinities is no map: the law is named, whatever makes it so."""
    nodes = [
        bg.Se("F", "F"),
        bg.One("j"),
        bg.I("m", "m", flow="v"),
        bg.R("r", law="log(k)*v + v", effort="F_r"),
    ]
    equations = bg.derive(bond_graph(nodes, "F>j>m j>r"))
    assert simulator(equations, {"m": 1, "k": 1}).rhs(0.0, [2.0], [0.0]) == pytest.approx([-2.0])
    with pytest.raises(bg.SimulationError, match=r"what gives F_r has no finite factors"):
        simulator(equations, {"m": 1, "k": 0}).run([0.0, 1.0], {"v": 1.0}, {"F": 0.0})


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_law_whose_slope_is_one_almost_everywhere(backend: str) -> None:
    """``v' = F - log(exp(v))``: v = F + (v_0 - F) exp(-t)."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.R("r", law="log(exp(f_r))")]
    run = simulator(bg.derive(bond_graph(nodes, "F>j>m j>r")), {}, backend=backend)
    result = run.run([0.0, 0.7, 1.5], {"v": 1.0}, {"F": 0.2})
    assert result["v"] == pytest.approx(0.2 + 0.8 * np.exp(-result.time), abs=1e-9)


def test_a_name_is_a_signal_unless_it_is_a_parameter() -> None:
    product = [expression("k*x", "law")]
    assert is_affine(product, {"k"})
    assert is_affine(product, {"x"})
    assert not is_affine(product, set())


def test_the_map_is_one_matrix_cut_into_parts() -> None:
    rng = np.random.default_rng(1)
    matrix = rng.normal(size=(6, 5))
    affine = AffineMap([2, 0, 1, 3], matrix, 0)
    s, w = rng.normal(size=3), rng.normal(size=1)
    parts = affine(s, w)
    assert [len(part) for part in parts] == [2, 0, 1, 3]
    expected = matrix[:, :3] @ s + matrix[:, 3] * w[0] + matrix[:, 4]
    assert np.concatenate(parts) == pytest.approx(expected, rel=1e-13)

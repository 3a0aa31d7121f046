"""When a law is affine, and the matrix of one mode cut into parts."""

import numpy as np
import pytest

from bondgraph.expressions import expression
from codegen.model.affine import AffineMap, is_affine

PARAMETERS = {"k", "b", "x_0"}
AFFINE = [
    "0", "3.5", "k", "k*x", "k*x + b*y - 1", "k*(x - x_0)/b", "exp(k)*x", "abs(k)", "k**2*x",
    "x/(k + b)", "(x + y)**2 - x**2 - 2*x*y - y**2 + x",
]  # fmt: skip
NOT_AFFINE = [
    "x*y", "x**2", "1/x", "sin(x)", "exp(-x)", "abs(x)", "sign(x)", "max(x, 0)", "min(x, y)",
    "k*t", "t", "x*t", "sqrt(x)", "tanh(x/k)", "abs(x - y)*k", "sign(x)*k", "x/(y + k)", "k**x",
]  # fmt: skip


@pytest.mark.parametrize("text", AFFINE)
def test_affine(text: str) -> None:
    assert is_affine([expression(text, "law")], PARAMETERS)


@pytest.mark.parametrize("text", NOT_AFFINE)
def test_not_affine(text: str) -> None:
    assert not is_affine([expression(text, "law")], PARAMETERS)
    assert not is_affine([expression("k*x", "law"), expression(text, "law")], PARAMETERS)


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

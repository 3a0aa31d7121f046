"""Exact integrals of products: closed forms from short steps to very long ones."""

from math import exp, pi

import numpy as np
import pytest

from codegen.energy.quadrature import NODES, exact_integrals, gauss_sum, rows_over


@pytest.mark.parametrize("h", [1e-6, 0.3, 5.0, 1e3, 1e6])
def test_products_of_decays(h: float) -> None:
    """exp(-2 t) exp(-0.001 t) and squares, from far below to far beyond their time constants."""
    M = np.diag([-2.0, -0.001])
    one, other = np.array([[1.0, 0], [1, 0], [0, 1]]), np.array([[0, 1.0], [1, 0], [0, 1]])
    found = exact_integrals(rows_over(M, one, other), np.array([[3.0, 5.0]]), np.array([h]))[0]
    rates = np.array([2.001, 4.0, 0.002])
    expected = np.array([15, 9, 25]) * -np.expm1(-rates * h) / rates
    assert found == pytest.approx(expected, rel=1e-12 if h < 1e5 else 1e-9)


@pytest.mark.parametrize("periods", [0.125, 1.0, 64.0])
def test_products_of_oscillations(periods: float) -> None:
    w, h = 7.0, periods * 2 * pi / 7.0
    M = np.array([[0, w], [-w, 0.0]])
    rows = rows_over(M, np.array([[1.0, 0], [1, 0]]), np.array([[1.0, 0], [0, 1]]))
    found = exact_integrals(rows, np.array([[0.0, 1.0]]), np.array([h]))[0]
    expected = [h / 2 - np.sin(2 * w * h) / (4 * w), np.sin(w * h) ** 2 / (2 * w)]
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_intervals_of_all_lengths_at_once() -> None:
    M, h = np.array([[-1.0]]), np.array([0.0, 0.5, 2.0, 0.5, 40.0])
    z = np.array([[1.0], [2.0], [3.0], [4.0], [5.0]])
    found = exact_integrals(rows_over(M, np.eye(1), np.eye(1)), z, h)[:, 0]
    assert found == pytest.approx(z[:, 0] ** 2 * (1 - np.exp(-2 * h)) / 2, rel=1e-13)


def test_gauss_is_exact_for_the_products_of_interpolants() -> None:
    """Degree 15 over a step from 2 to 5."""
    times = 2 + 3 * NODES
    assert gauss_sum(times[None] ** 15, 3.0)[0] == pytest.approx((5**16 - 2**16) / 16, rel=1e-13)
    assert abs(gauss_sum(np.exp(times)[None], 3.0)[0] - (exp(5) - exp(2))) < 1e-12 * exp(5)

"""Entries read as in print, and stay what they were."""

import pytest
import sympy as sp

from bondgraph.algebra.tidy import MOST_TERMS, by_linear_symbols, tidy

a, b, c, x, h, I_1, I_2 = sp.symbols("a b c x h I_1 I_2")
one = sp.Integer(1)


@pytest.mark.parametrize(
    ("entry", "shortest"),
    [
        (a + b, a + b),
        (a / (a + b) + b / (a + b), one),
        (a**2 + 2 * a * b + b**2, (a + b) ** 2),
        (a * b + a * c, a * (b + c)),
        ((a + b) ** 2 - a**2 - 2 * a * b - b**2, sp.Integer(0)),
        (sp.sin(x) ** 2 + sp.cos(x) ** 2, sp.sin(x) ** 2 + sp.cos(x) ** 2),
    ],
)
def test_tidy_entry_is_short_and_equal(entry: sp.Expr, shortest: sp.Expr) -> None:
    assert tidy(entry).count_ops() <= shortest.count_ops()
    assert sp.simplify(tidy(entry) - entry) == 0


def test_each_inertia_has_its_own_squared_ratio() -> None:
    """As Appendix B prints the stationary clutch TVD, from the expanded single fraction."""
    printed = I_1 * h**2 / (4 * (h - 1) ** 2) + I_2 * (h - 2) ** 2 / (4 * (h - 1) ** 2) + a
    assert tidy(sp.together(sp.expand(printed))) == printed


@pytest.mark.parametrize("entry", [a * b + c, a * b, a**2 + b**2, (a * b + b * c) / c, x / (x + a)])
def test_by_linear_symbols_changes_no_value(entry: sp.Expr) -> None:
    assert sp.cancel(by_linear_symbols(entry) - entry) == 0


def test_long_entries_stay_as_they_are() -> None:
    names = sp.symbols(f"y:{MOST_TERMS + 1}")
    entry = sp.Add(*[name * a for name in names])
    assert tidy(entry) is entry

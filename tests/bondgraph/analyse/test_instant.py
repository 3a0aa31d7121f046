"""The linear equations of an operating point."""

import pytest
import sympy as sp

from bondgraph.algebra.exact import SingularError
from bondgraph.analyse.instant import _solved

a, b, c = sp.symbols("a b c")


def test_equations_with_long_entries_are_solved() -> None:
    inside = [{0: a + b, 1: sp.Integer(1)}, {1: b * c + a}]
    found = _solved(inside, [{0: a}, {0: sp.Integer(1)}])
    second = 1 / (b * c + a)
    assert [
        sp.cancel(row[0] - one)
        for row, one in zip(found, [(a - second) / (a + b), second], strict=True)
    ] == [0, 0]


@pytest.mark.parametrize(
    "hidden", [2 * a + 2 * b, (a + b) * 2, 2 * (a + b) * (sp.sin(c) ** 2 + sp.cos(c) ** 2)]
)
def test_what_names_would_hide_is_singular_all_the_same(hidden: sp.Expr) -> None:
    with pytest.raises(SingularError):
        _solved([{0: a + b, 1: sp.Integer(1)}, {0: hidden, 1: sp.Integer(2)}], [{0: a}, {0: b}])

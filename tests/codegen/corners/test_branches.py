"""Laws on one side of each corner: on their own side they are the law, and beyond it they go on smoothly."""

import numpy as np
import pytest
import sympy as sp

from codegen.corners.branches import Branch, Sided

x, y, p = sp.symbols("x y p")

LAWS = [
    sp.Abs(x - y) * x,
    sp.sign(x) * x**2 + y,
    sp.Max(x, y, x * y, 1),
    sp.Min(x, sp.Max(y, 2 * x - 1)),
    sp.Piecewise((x, x > 1), (y, x > -1), (x * y, True)),
    sp.Piecewise((x, sp.And(x > 0, sp.Or(y > 0, x > 2))), (y, sp.Not(y < x)), (3, True)),
    sp.Piecewise((sp.Abs(x), x + sp.Abs(y) >= 1), (1, True)),
    sp.Heaviside(x - y) * sp.Abs(y),
    sp.Max(0, sp.Abs(x) - sp.Abs(y)),
]


def _sided(law: sp.Expr) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """A law on sides, and what each hangs on."""
    hung: dict[sp.Expr, sp.Symbol] = {}

    def side(size: sp.Expr) -> tuple[sp.Symbol, int] | None:
        if not size.free_symbols - {p}:
            return None
        return hung.setdefault(size, sp.Symbol(f"side_{len(hung)}")), 1

    put = Sided(side).put(law)
    return put, {name: size for size, name in hung.items()}


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_on_its_own_sides_a_law_is_what_it_is(law: sp.Expr) -> None:
    put, hung = _sided(law)
    assert put.has(Branch)
    assert not put.has(sp.Abs, sp.sign, sp.Max, sp.Min, sp.Piecewise, sp.Heaviside)
    function = sp.lambdify([x, y, *hung], put)
    sides = sp.lambdify([x, y], list(hung.values()))
    plain = sp.lambdify([x, y], law)
    for a, b in np.random.default_rng(0).uniform(-3, 3, (50, 2)).tolist():
        here = [1 if value > 0 else -1 for value in sides(a, b)]
        assert function(a, b, *here) == pytest.approx(float(plain(a, b)), abs=1e-12)


def test_beyond_its_corner_a_branch_goes_on() -> None:
    put, hung = _sided(sp.Max(0, x - 1))
    (side,) = hung
    function = sp.lambdify([x, side], put)
    way = 1 if hung[side].subs(x, 2) > 0 else -1
    assert [function(0.25, way), function(0.25, -way)] == [-0.75, 0]
    assert [function(3.0, way), function(3.0, -way)] == [2.0, 0]


def test_what_does_not_move_has_no_side() -> None:
    law = sp.Max(p, 2) * x + sp.Piecewise((x, p > 1), (0, True))
    assert _sided(law) == (law, {})
    put, hung = _sided(law + sp.Abs(x))
    assert list(hung.values()) == [x]
    assert put.has(sp.Max)

"""Floors, ceilings and remainders are Python's, their slopes none, and either side goes on as it is."""

import math

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from bondgraph.algebra.expressions import expression
from bondgraph.algebra.whole import Floor

X, Y = sp.symbols("x y")


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("floor(x)", math.floor), ("ceil(x)", math.ceil), ("mod(x, 3)", lambda x: x % 3),
        ("mod(x, -0.7)", lambda x: x % -0.7), ("floor(2*x + 1)/2", lambda x: math.floor(2 * x + 1) / 2),
    ],
)  # fmt: skip
def test_values_are_pythons(text: str, right: object) -> None:
    found = sp.lambdify(X, expression(text, "law"), "numpy")
    places = np.concatenate([np.random.default_rng(3).uniform(-9, 9, 200), np.arange(-5.0, 6.0)])
    if "0.7" in text:
        places = places[:200]
    assert [float(found(x)) for x in places] == pytest.approx([right(x) for x in places], abs=1e-12)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (sp.floor(X), "floor(x)"), (sp.ceiling(X), "ceil(x)"), (sp.frac(X), "mod(x, 1)"),
        (sp.Mod(X, Y), "mod(x, y)"),
    ],
)  # fmt: skip
def test_sympys_own_are_the_same(given: sp.Expr, text: str) -> None:
    assert expression(given, "law") == expression(text, "law")


def test_their_text_is_read_again() -> None:
    law = expression("mod(x, y) + 2*floor(y/x)", "law")
    assert expression(str(law), "law") == law


@pytest.mark.parametrize("side", [1, -1])
def test_a_side_is_the_same_and_goes_on_beyond(side: int) -> None:
    """Around even numbers' cells, or odd ones', for a half beyond either end."""
    told = sp.lambdify(X, Floor(X).on_side(X, side), "numpy")
    for whole in range(-6, 7):
        if (whole % 2 == 0) == (side > 0):
            inside = whole + np.linspace(-0.49, 1.49, 23)
            assert (told(inside) == whole).all()
            middle = whole + np.linspace(0.01, 0.99, 9)
            assert (np.sign(np.sin(np.pi * middle)) == side).all()
            assert (np.floor(middle) == whole).all()


def test_a_law_is_linearised_between_its_jumps_only() -> None:
    nodes = [bg.Se("F", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="2*v + floor(v)")]
    equations = bg.derive(bond_graph(nodes, "F>n>m n>r"))
    assert sp.Matrix([[-2]]) == bg.linearize(equations, at={"v": 0.6}).J
    with pytest.raises(bg.SignalError, match="corner at the operating point"):
        bg.linearize(equations, at={"v": 1})


@pytest.mark.parametrize(
    ("law", "at", "slope"),
    [
        ("v*floor(floor(v)/2)", "1/2", 0),
        ("v*floor(floor(v)/2)", "9/2", 2),
        ("v*floor(floor(v)/2)", "2", None),
        ("v*mod(floor(v), 3)", "7/2", 0),
        ("v*mod(floor(v), 3)", "9/2", 1),
        ("floor(v + floor(2*v))", "1/2", None),
        ("floor(v + floor(2*v))", "3/4", 0),
        ("abs(floor(v))", "1", None),
    ],
)
def test_floors_in_floors_jump_where_what_they_hold_does(law: str, at: str, slope: int) -> None:
    """By hand: ``floor(v + floor(2 v))`` goes from 0 to 1 at 1/2."""
    nodes = [bg.Se("F", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law=law)]
    equations = bg.derive(bond_graph(nodes, "F>n>m n>r"))
    if slope is not None:
        assert sp.Matrix([[-slope]]) == bg.linearize(equations, at={"v": at}).J
        return
    with pytest.raises(bg.SignalError, match="corner at the operating point"):
        bg.linearize(equations, at={"v": at})

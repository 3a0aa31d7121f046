"""Tables over numpy are numpy's and scipy's interpolators, values and slopes, inside and outside."""

import numpy as np
import pytest
import sympy as sp
from references.interpolated import (
    METHODS,
    interpolated,
    off,
    orders_of,
    random_places,
    random_table,
)

import bondgraph as bg
from codegen.numbers.lambdified import lambdified
from codegen.standalone.arrays import Array

ROUNDING = 1e-12
"""Of the largest number; polynomials lose a few digits where they go on beyond their ends."""

FEW = 10_000
"""Arguments of slopes; values are compared at ten times as many."""


def _by_numpy(table: bg.LookupTable, orders: tuple[int, ...], places: list[Array]) -> Array:
    names = sp.symbols("x y")[: len(orders)]
    value = table(*names)
    for name, order in zip(names, orders, strict=True):
        value = sp.diff(value, name, order) if order else value
    return lambdified(names, value)(*places)


@pytest.mark.parametrize("outside", ["hold", "extend", "refuse"])
@pytest.mark.parametrize("method", METHODS)
def test_values_and_slopes_are_the_interpolators_own(method: str, outside: str) -> None:
    table, parts = random_table(method, outside)
    places = random_places(parts[:-1], outside=True)
    for orders in orders_of(method):
        some = [one[:FEW] for one in places] if any(orders) else places
        found = _by_numpy(table, orders, some)
        assert off(found, interpolated(method, outside, parts, some, orders)) < ROUNDING, orders


def test_numbers_give_numbers_and_arrays_arrays() -> None:
    table = bg.LookupTable("map", [0, 1, 3], [0, 2, 2])
    x, y = sp.symbols("x y")
    f = lambdified([x, y], [table("x") + y, table("2*x")])
    assert f(0.5, 1.0) == [2.0, 2.0]
    assert np.array_equal(f(np.array([0.5, 2.0]), 1.0)[0], [2.0, 3.0])
    assert lambdified([x], [[table(x)]])(np.zeros((2, 2)))[0][0].shape == (2, 2)

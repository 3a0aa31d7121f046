"""Tables that are turned round give back what was given, or there are none."""

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator
from scipy.optimize import brentq

import bondgraph as bg
from bondgraph.algebra.lookups import Handle, Look
from bondgraph.inverses.tabled import turned_table
from bondgraph.tables.one_way import one_way
from bondgraph.tables.pieces import pieces
from codegen.numbers.cells import steepest

X = [-1.0, 0.0, 2.0, 2.5]
CURVES = {"pchip": PchipInterpolator, "akima": Akima1DInterpolator}
BENT = ([-1.0, 0.0, 1.5, 2.2, 4.0], [-3.0, -1.0, 0.2, 1.4, 6.0])


@pytest.mark.parametrize("z", [[-3.0, 1.0, 2.0, 9.0], [4.0, 3.0, -1.0, -7.0]])
@pytest.mark.parametrize("outside", ["extend", "refuse", "hold"])
def test_both_ways_lead_back(z: list[float], outside: str) -> None:
    there = Handle(bg.LookupTable("map", X, z, outside=outside), (0,))
    back = turned_table(there)
    assert back is not None
    places = np.linspace(-5, 5, 41) if outside == "extend" else np.linspace(-1, 2.5, 29)
    for x in places.tolist():
        assert back.looked_up(there.looked_up(x)) == pytest.approx(x, abs=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("method", CURVES)
def test_cubics_are_brentqs_with_their_slopes(method: str, way: float) -> None:
    x, z = BENT[0], [way * one for one in BENT[1]]
    curve = CURVES[method](x, z)
    back = turned_table(Handle(bg.LookupTable("map", x, z, method=method), (0,)))
    assert back is not None
    slopes = [Handle(back.table, (order,)) for order in (1, 2, 3)]
    for value in np.linspace(-3, 6, 37)[1:-1] * way:
        place = brentq(lambda at, value=value: curve(at) - value, -1, 4, xtol=1e-15)
        p1, p2, p3 = (float(curve(place, order)) for order in (1, 2, 3))
        assert back.looked_up(value) == pytest.approx(place, abs=1e-13)
        if min(abs(place - knot) for knot in x) > 1e-9:
            found = [one.looked_up(value) for one in slopes]
            wanted = [1 / p1, -p2 / p1**3, (3 * p2**2 - p1 * p3) / p1**5]
            assert found == pytest.approx(wanted, rel=1e-9)
    steep = max(1 / abs(curve(at, 1)) for at in np.linspace(-1, 4, 2001))
    assert steep <= steepest(back.table) <= 1.001 * steep


def test_the_fourth_derivative_follows_from_the_others() -> None:
    """By differences of the third, inside a cell."""
    back = turned_table(Handle(bg.LookupTable("map", *BENT, method="pchip"), (0,)))
    assert back is not None
    value = bg.expression("v", "test")
    fourth = Look(Handle(back.table, (3,)), value).diff(value)
    three, h = Handle(back.table, (3,)).looked_up, 1e-5
    told = (three(0.8 + h) - three(0.8 - h)) / (2 * h)
    assert float(fourth.subs(value, 0.8)) == pytest.approx(told, rel=1e-6)


@pytest.mark.parametrize("way", [1, -1])
def test_beyond_its_ends_a_table_goes_on_where_the_other_does(way: int) -> None:
    """x + x^3 by points of which the cubics are it itself goes on; pchip's that bend back refuse."""
    x = np.array(BENT[0])
    bent = bg.LookupTable("map", x, way * np.array(BENT[1]), method="pchip", outside="extend")
    assert not one_way(bent).beyond
    back = turned_table(Handle(bent, (0,)))
    assert back is not None
    assert back.table.outside == "refuse"
    stiff = bg.LookupTable("map", [0, 1, 2], [0, 1, 3], method="akima", outside="extend")
    told = pieces(stiff)
    assert one_way(stiff).beyond == _goes_on(told)


def _goes_on(told: tuple) -> bool:
    """By numpy: the slopes of the first and the last cubic have no roots beyond."""
    (knots,), _, _, factors = told
    first, last = (np.roots(np.polyder(factors[at : at + 4])) for at in (0, len(factors) - 4))
    real = [
        [r.real for r in roots if abs(r.imag) < 1e-12 and beyond(r.real)]
        for roots, beyond in (
            (first, lambda r: r < 0),
            (last, lambda r: r > knots[-1] - knots[-2]),
        )
    ]
    return real == [[], []]


@pytest.mark.parametrize(
    ("z", "more", "reason"),
    [
        ([0, 1, 1, 2], {}, "is level between 0 and 2"),
        ([0, 1, 0.5, 2], {}, "turns back between 0 and 2"),
        ([0, 1, 1, 2], {"method": "pchip"}, "is level between 0 and 2"),
        ([0.0, 1.0, 12.0, 13.0], {"method": "pchip"}, "is level at -1, where its inverse"),
        ([0.0, 0.9, 1.0, 30.0], {"method": "akima"}, "turns back at 1"),
    ],
)
def test_what_does_not_go_one_way_is_not_turned(z: list, more: dict, reason: str) -> None:
    table = bg.LookupTable("map", X, z, **more)
    assert turned_table(Handle(table, (0,))) is None
    assert reason in one_way(table).reason

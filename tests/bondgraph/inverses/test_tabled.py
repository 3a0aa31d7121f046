"""Tables that are turned round give back what was given, or there are none."""

import numpy as np
import pytest

import bondgraph as bg
from bondgraph.algebra.lookups import Handle
from bondgraph.inverses.tabled import turned_table

X = [-1.0, 0.0, 2.0, 2.5]


@pytest.mark.parametrize("z", [[-3.0, 1.0, 2.0, 9.0], [4.0, 3.0, -1.0, -7.0]])
@pytest.mark.parametrize("outside", ["extend", "refuse"])
def test_both_ways_lead_back(z: list[float], outside: str) -> None:
    there = Handle(bg.LookupTable("map", X, z, outside=outside), (0,))
    back = turned_table(there)
    assert back is not None
    places = np.linspace(-1, 2.5, 29) if outside == "refuse" else np.linspace(-5, 5, 41)
    for x in places.tolist():
        assert back.looked_up(there.looked_up(x)) == pytest.approx(x, abs=1e-12)


@pytest.mark.parametrize(
    ("z", "more"),
    [
        ([0, 1, 1, 2], {"outside": "extend"}),
        ([0, 1, 0.5, 2], {"outside": "extend"}),
        ([0, 1, 2, 3], {"outside": "hold"}),
        ([0, 1, 2, 3], {"outside": "refuse", "method": "pchip"}),
    ],
)
def test_what_does_not_go_one_way_in_straight_lines_is_not_turned(z: list, more: dict) -> None:
    assert turned_table(Handle(bg.LookupTable("map", X, z, **more), (0,))) is None

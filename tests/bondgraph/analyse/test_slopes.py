"""Slopes of laws with branches, roots and friction, and the points at which they have none."""

import pytest
import sympy as sp

import bondgraph as bg
from bondgraph.analyse.slopes import operating_point, slopes
from bondgraph.nodes.laws import law

v, q, c, g = sp.symbols("v q c g")
below = sp.Piecewise((0, v < 0), (v, True))
smooth = sp.Piecewise((0, v < 0), (v**2, True))
jump = sp.Piecewise((0, v < 0), (1, True))


def _slopes(value: object, **at: object) -> dict[sp.Symbol, sp.Expr]:
    return slopes(law(value, "p"), "p", v, {v, q}, operating_point(at, {v, q, c, g}))


@pytest.mark.parametrize(
    ("value", "at", "expected"),
    [
        ("c*v*abs(v)", {"v": 3}, {v: 6 * c}),
        ("c*v*abs(v)", {"v": -2}, {v: 4 * c}),
        # The orifice at rest: its slope is 0 from either side.
        ("c*v*abs(v)", {"v": 0}, {}),
        ("max(0, v)*v", {"v": 0}, {}),
        (smooth, {"v": 0}, {}),
        (below, {"v": 2}, {v: 1}),
        (below, {"v": -2}, {}),
        ("c*sign(v)", {"v": 1}, {}),
        # Which side it lies on may hang on a parameter, whose number does not enter the slope.
        ("c*max(0, v - g/2)", {"v": 1, "g": 1}, {v: c}),
        ("c*max(g*v, q)", {"v": 1, "q": 0, "g": 2}, {v: c * g}),
        ("c*v*abs(v - g)", {"v": 3, "g": 1}, {v: c * (3 - g) + 3 * c}),
    ],
)
def test_slope_beside_and_at_a_change_of_branch(
    value: object, at: dict, expected: dict[sp.Symbol, sp.Expr]
) -> None:
    found = _slopes(value, **at)
    assert found.keys() == expected.keys()
    assert all(sp.expand(found[name] - expected[name]) == 0 for name in expected)


@pytest.mark.parametrize(
    ("value", "at", "message"),
    [
        ("c*abs(v)", {"v": 0}, "has a corner at the operating point, where v = 0"),
        ("c*sign(v)", {"v": 0}, "has a corner"),
        ("atan2(v, 0)", {"v": 0}, "jumps at the operating point, where v = 0"),
        ("atan2(v, 0)", {}, "the value of the law at 'p' depends on v"),
        ("atan2(q, -v)", {"v": 2, "q": 0}, "jumps at the operating point, where q = 0"),
        ("max(0, v)", {"v": 0}, "has a corner"),
        ("max(v, q)", {"v": 1, "q": 1}, "has a corner"),
        (below, {"v": 0}, "has a corner"),
        (jump, {"v": 0}, "has a corner"),
        ("max(0, v)", {"v": "c"}, "lies depends on c: give numbers for them in at"),
        ("sign(v - g)", {"v": 0}, "lies depends on g"),
        ("sqrt(v)", {"v": -1}, "no finite real"),
        ("log(v)*v", {"v": -1}, "no finite real"),
        ("sqrt(v)", {"v": 0}, "no finite real"),
        ("c*v**2", {}, "the slope of the law at 'p' depends on v"),
        (bg.DryFriction("c"), {"v": 0}, "give v a number that is not 0"),
        (bg.DryFriction("c", "1 + exp(-slip)"), {}, "give v a number that is not 0"),
    ],
)
def test_a_point_without_a_slope_is_refused(value: object, at: dict, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        _slopes(value, **at)


def test_steady_friction_has_no_slope_whichever_way_it_slips() -> None:
    assert _slopes(bg.DryFriction("c")) == _slopes(bg.DryFriction("c"), v=-3) == {}


def test_names_that_nothing_has_are_refused_in_a_point() -> None:
    with pytest.raises(bg.SignalError, match="at: no signal, state or parameter is called vv"):
        operating_point({"vv": 1}, {v})
    with pytest.raises(bg.SignalError, match="at must map signals to values"):
        operating_point([("v", 1)], {v})

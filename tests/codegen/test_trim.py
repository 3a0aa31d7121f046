"""Steady states against closed forms, with friction that sticks or slips."""

import numpy as np
import pytest
from oracles.models import block
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator, trim

NODES = [
    bg.Se("engine", "T"), bg.One("a"), bg.I("J_a", "J_a", flow="w_a"), bg.Zero("between"),
    bg.R("clutch", effort="tau", flow="dw"), bg.One("b"), bg.I("J_b", "J_b", flow="w_b"),
    bg.R("air", law="c*f_air*abs(f_air)"), bg.R("oil", "d"),
]  # fmt: skip
GRAPH = bond_graph(NODES, "engine>a>J_a a>oil a>between>clutch between>b>J_b b>air")
NUMBERS = {"J_a": 0.2, "J_b": 1.5, "c": 0.02, "d": 0.1, "T_f": 8.0}
CLUTCH = simulator(bg.derive(GRAPH), NUMBERS, laws={"clutch": bg.DryFriction("T_f")})


def test_a_slipping_clutch_hands_on_its_level() -> None:
    """d w_a = T - T_f and c w_b^2 = T_f."""
    point = trim(CLUTCH, {"T": 20.0}, {"w_a": 100.0, "w_b": 10.0})
    assert point["w_a"] == pytest.approx(120.0)
    assert point["w_b"] == pytest.approx(20.0)
    assert (point["tau"], point["dw"]) == pytest.approx((8.0, 100.0))


def test_a_sticking_clutch_carries_what_it_must() -> None:
    """One speed: c w^2 + d w = T; sticking is preferred where slipping has no solution."""
    point = trim(CLUTCH, {"T": 5.0})
    speed = (-0.1 + np.sqrt(0.01 + 4 * 0.02 * 5.0)) / 0.04
    assert (point["w_a"], point["w_b"]) == pytest.approx((speed, speed))
    assert point["tau"] == pytest.approx(0.02 * speed**2)
    assert point["dw"] == pytest.approx(0.0, abs=1e-9)


def test_at_the_point_all_rates_vanish_and_it_is_where_linearize_works() -> None:
    point = trim(CLUTCH, {"T": 20.0}, {"w_a": 100.0, "w_b": 10.0})
    state = [point[name] for name in CLUTCH.states]
    assert CLUTCH.rhs(0.0, state, [20.0]) == pytest.approx(np.zeros(2), abs=1e-9)
    laws = {"clutch": bg.DryFriction("T_f")}
    model = bg.linearize(bg.derive(GRAPH), at=point, laws=laws).numeric(NUMBERS)
    assert sorted(model.poles().real) == pytest.approx(sorted([-0.1 / 0.2, -2 * 0.02 * 20 / 1.5]))


def test_a_nonlinear_spring_rests_where_its_law_says() -> None:
    nodes = [
        bg.Se("g", "W"),
        bg.One("j"),
        bg.I("m", "m"),
        bg.C("k", law="k*q_k**3"),
        bg.R("b", "b"),
    ]
    ready = simulator(bg.derive(bond_graph(nodes, "g>j>m j>k j>b")), {"m": 1, "k": 2, "b": 1})
    point = trim(ready, {"W": 54.0}, {"q_k": 1.0})
    assert point["q_k"] == pytest.approx(3.0)


def test_what_drifts_without_end_has_no_steady_state() -> None:
    """A block pushed harder than its friction holds; pushed less, it rests where it is."""
    ready = simulator(bg.derive(block()), {"m": 2.0, "F_c": 3.0})
    with pytest.raises(bg.SimulationError, match="no steady state"):
        trim(ready, {"P": 5.0})
    assert trim(ready, {"P": 2.0})["v"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("inputs", "initial", "message"),
    [({}, {}, r"missing input\(s\) T"), ({"T": 1.0}, {"w": 1.0}, "'w' is not a state")],
)
def test_unusable_arguments_are_refused(inputs: dict, initial: dict, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        trim(CLUTCH, inputs, initial)

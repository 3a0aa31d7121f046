"""Jumps that act on a second derivative: swings that gather to rest, what holds there, and leaving."""

import numpy as np
import pytest
import scipy
from oracles.relays import mass, oscillating, two
from oracles.swings import Swings
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Ramp, Sine, simulator

CLOSE = 1e-9
"""Of a range of 1 or more."""

SEEN = 2e-5
"""s: so much before the last of its swings a motion rests, as they leap no higher than is seen."""

TWIST = Swings(2.0, 1.0)
LAW = "2*sign(x) + sign(v_r)"


def orders(equations: bg.StateEquations, numbers=()) -> list[int]:
    program = simulator(equations, dict(numbers)).closed.program
    return [port.order for port in program.friction]


@pytest.mark.parametrize(
    ("equations", "found"),
    [
        (oscillating(LAW), [2, 1]),
        (oscillating("sign(x + v_r)"), [1]),
        # What it hangs on is a sum of states, or moves by a law of some.
        (two("2*y - x", "-sign(3*x)"), [2]),
        (two("y + y**3", "-sign(x)"), [2]),
        # Both move at once, and each the other: neither has a rate of its own.
        (two("y - sign(x)", "-sign(x)"), [1]),
        (two("sign(y)", "-sign(x)"), [1, 1]),
        # Not x, but a power of it; a reference that moves.
        (oscillating("sign(x**3)"), [1]),
        (oscillating("sign(x - w)"), [1]),
    ],
)
def test_orders_are_told_by_what_moves_first(
    equations: bg.StateEquations, found: list[int]
) -> None:
    assert orders(equations) == found


@pytest.mark.parametrize(
    ("backend", "method"), [("numpy", "auto"), ("c", "auto"), ("c", "DOP853"), ("c", "Radau")]
)
def test_swings_gather_to_rest(backend: str, method: str) -> None:
    times = np.concatenate(
        [np.linspace(0.0, TWIST.rests - 1e-3, 40), TWIST.rests + np.linspace(0, 2, 9)]
    )
    result = simulator(oscillating(LAW), {}, backend=backend).run(times, {"x": 1.0}, method=method)
    assert np.abs(result["x"] - TWIST.at(times)).max() < CLOSE
    assert np.abs(result["v"][-9:]).max() < CLOSE
    assert [event.kind for event in result.events] == ["slide", "slide"]
    assert all(0 < TWIST.rests - event.time < SEEN for event in result.events)
    assert abs(result.audit().residual) < 1e-8


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_rests_is_left_where_both_sides_no_longer_push_back(backend: str) -> None:
    """From rest, F = t: all shares follow, until F is 3; then x'' = t - 3."""
    result = simulator(oscillating_pushed(LAW), {}, backend=backend).run(
        [0.0, 1.5, 3.0, 5.0], {}, {"F": Ramp(0.0, 1.0)}
    )
    assert result["x"] == pytest.approx([0.0, 0.0, 0.0, 8 / 6], abs=CLOSE)
    assert result["F_r"] == pytest.approx([0.0, 1.5, 3.0, 3.0], abs=CLOSE)
    assert {event.kind for event in result.events} == {"leave"}
    assert result.events[0].time == pytest.approx(3.0, abs=CLOSE)


@pytest.mark.parametrize("method", ["auto", "exact", "DOP853"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_one_jump_holds_by_exact_steps(backend: str, method: str) -> None:
    """2 sin t is held until it is 3/2; then x'' = 2 sin t - 3/2."""
    leaves = np.arcsin(0.75)
    times = np.array([0.0, 0.5, leaves + 0.3])
    run = simulator(oscillating_pushed("3/2*sign(x)"), {}, backend=backend)
    result = run.run(times, {}, {"F": Sine(2.0, 1 / (2 * np.pi))}, method=method)
    s = 0.3
    moved = 2 * (np.sin(leaves) - np.sin(leaves + s) + s * np.cos(leaves)) - 0.75 * s**2
    assert result["x"] == pytest.approx([0.0, 0.0, moved], abs=CLOSE)
    assert result["F_r"][1] == pytest.approx(2 * np.sin(0.5), abs=CLOSE)
    assert [(e.kind, e.time) for e in result.events] == [
        ("leave", pytest.approx(leaves, abs=CLOSE))
    ]


def oscillating_pushed(law: object) -> bg.StateEquations:
    """The same with F."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.Df("d", integrate="x"),
             bg.R("r", law=law, effort="F_r", flow="v_r")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "F>j>m j>r j>d"))


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_is_left_of_a_leap_is_taken_from_what_the_jump_moves(backend: str) -> None:
    """Of x' = y - x the jump moves y alone: an impulse on x would be a step away from rest."""
    model = two("y - x", "-2*sign(x) - sign(y - x)")
    result = simulator(model, {}, backend=backend).run(np.linspace(0.0, 8.0, 5), {"x": 1.0})
    assert np.abs(result["x"][-2:]).max() < CLOSE
    assert np.abs(result["y"][-2:]).max() < CLOSE
    assert [event.kind for event in result.events] == ["slide", "slide"]


@pytest.mark.parametrize(("backend", "end"), [("numpy", 0.6), ("c", 1.5)])
def test_swings_that_a_damper_shrinks_go_on_until_they_are_not_seen(
    backend: str, end: float
) -> None:
    """x'' = -2 sign(x) - 40 x': each swing by hand, ever more of them, some thousands until the last."""
    run = simulator(two("y - 40*x", "-2*sign(x)"), {}, backend=backend)
    result = run.run([0.0, 0.4, 0.5, end], {"y": 1.0}, method="DOP853")
    top = 0.01
    assert result["x"][1:3] == pytest.approx([_damped(0.4), _damped(0.5)], abs=CLOSE * top)
    if end > 1:
        assert np.abs(result["x"][3]) < CLOSE * top
        assert [event.kind for event in result.events] == ["slide"]


def _damped(t: float) -> float:
    """x at a time, of x'' = -2 sign(x) - 40 x' from x = 0 and x' = 1: swing by swing."""
    c, speed, side = 40.0, 1.0, 1.0

    def along(s: float, v: float) -> float:
        return (v + 2 / c) * -np.expm1(-c * s) / c - 2 * s / c

    while True:
        end = scipy.optimize.brentq(along, 1e-3 * speed, 2 * speed, args=(speed,), xtol=1e-16)
        if t <= end:
            return side * along(t, speed)
        t, speed, side = t - end, -((speed + 2 / c) * np.exp(-c * end) - 2 / c), -side


def test_a_third_derivative_is_crossed_and_swings_grow() -> None:
    """x''' = -sign(x) from x = 1: 1 - t^3/6, then on from there with 1."""
    nodes = [bg.Sf("a", "2*y"), bg.Zero("p"), bg.C("X", 1, effort="x"),
             bg.Sf("b", "2*z"), bg.Zero("q"), bg.C("Y", 1, effort="y"),
             bg.Sf("c", "-sign(x)/4"), bg.Zero("r"), bg.C("Z", 1, effort="z")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "a>p>X b>q>Y c>r>Z"))
    assert orders(equations) == [1]
    at = 6 ** (1 / 3)
    result = simulator(equations, {}).run([0.0, at, at + 1.0], {"x": 1.0})
    after = -(at**2) / 2 - at / 2 + 1 / 6
    assert result["x"] == pytest.approx([1.0, 0.0, after], abs=CLOSE)
    assert result.events == ()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_jumps_and_friction_share_by_what_each_moves(backend: str) -> None:
    """At rest 2 u_1 + F_d is what pushes, up to 4; each bears the same part of its own."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"),
             bg.R("r", law="2*sign(v_r)", effort="F_r", flow="v_r"),
             bg.R("d", law=bg.DryFriction(2), effort="F_d", flow="v_d")]  # fmt: skip
    run = simulator(bg.derive(bond_graph(nodes, "F>j>m j>r j>d")), {}, backend=backend)
    result = run.run([0.0, 1.0, 3.0, 5.0], {}, {"F": Ramp(0.0, 1.0)})
    assert result["F_r"] == pytest.approx([0.0, 0.5, 1.5, 2.0], abs=CLOSE)
    assert result["F_d"] == pytest.approx([0.0, 0.5, 1.5, 2.0], abs=CLOSE)
    assert result["v"][-1] == pytest.approx(0.5, abs=CLOSE)
    assert [e.time for e in result.events] == pytest.approx([4.0, 4.0], abs=CLOSE)


def test_runs_of_a_sweep_rest_each_at_its_time() -> None:
    equations = oscillating("2*sign(x) + b*sign(v_r)")
    brakes = [0.5, 1.0, 1.5]
    found = codegen.sweep(
        codegen.Family(equations, {"b": 1.0}, backend="c"), {"b": brakes}, np.array([0.0, 4.0, 12.0]),
        {"x": codegen.samples("x"), "first": codegen.first_event("r", "slide")}, {"x": 1.0}, workers=0,
        progress=False,
    )  # fmt: skip
    for b, x, first in zip(brakes, found["x"], found["first"], strict=True):
        known = Swings(2.0, b)
        assert x == pytest.approx(known.at(np.array([0.0, 4.0, 12.0])), abs=CLOSE)
        assert 0 < known.rests - first < SEEN


def test_a_steady_state_rests() -> None:
    point = codegen.trim(simulator(oscillating_pushed(LAW), {}), {"F": 0.2}, {"x": 0.3})
    assert point["x"] == pytest.approx(0.0, abs=CLOSE)
    assert point["v"] == pytest.approx(0.0, abs=CLOSE)
    assert point["F_r"] == pytest.approx(0.2, abs=CLOSE)


def test_fixed_steps_of_exports_come_to_rest_and_converge(tmp_path) -> None:
    from oracles.exported import loaded

    module = loaded(codegen.to_python(oscillating(LAW), {}))
    times = np.linspace(0.0, 6.0, 61)
    off = []
    for step in (0.02, 0.005):
        run = module.simulate(times, {"x": 1.0}, {}, step=step)
        off.append(np.abs(run["x"] - TWIST.at(times)).max())
        assert np.abs(run["x"][-10:]).max() < 1e-12
        assert np.abs(run["v"][-10:]).max() < 1e-12
    assert off[0] < 5 * 0.02
    assert off[1] < 0.5 * off[0]


def test_a_mass_that_only_rubs_has_no_such_jump() -> None:
    assert orders(mass("sign(v_r)")) == [1]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_hangs_on_an_input_is_refused_by_name_where_crossings_gather(backend: str) -> None:
    """The same swings about w = 0; before they gather, it runs."""
    run = simulator(oscillating("2*sign(x - w) + sign(v_r)"), {}, backend=backend)
    turns = TWIST.first
    with pytest.raises(
        bg.SimulationError, match=r"at t = 4\.46\d* a jump in the law at 'r' is crossed"
    ):
        run.run([0.0, 6.0], {"x": 1.0}, {"w": 0.0})
    assert run.run([0.0, turns], {"x": 1.0}, {"w": 0.0})["x"][-1] == pytest.approx(
        -1 / 3, abs=CLOSE
    )

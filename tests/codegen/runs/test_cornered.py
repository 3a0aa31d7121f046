"""Corners of laws are where the integration stops: orders are kept, and nothing is listed unasked."""

import numpy as np
import pytest
import sympy as sp
from oracles.branched import random_chain
from references.build import bond_graph
from soak.families import seeds

import bondgraph as bg
import codegen
from codegen import Sine, Step, simulator
from codegen.modes.closed import ClosedModel

q, v, t = sp.symbols("q_s v t")
TIGHT = {"rtol": 1e-12, "atol": 1e-13}
PERIOD = 1.5 * np.pi


def oscillator(spring: object, *more: tuple, damper: object = None) -> bg.StateEquations:
    """A mass of 1 on a spring, and perhaps a damper and what pushes it."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law=spring), *more]
    nodes += [] if damper is None else [bg.R("d", law=damper)]
    bonds = "n>m n>s" + ("" if damper is None else " n>d")
    return bg.derive(bond_graph(nodes, bonds + "".join(f" {one[0]}>n" for one in more)))


SLOPES = [
    sp.Piecewise((4 * q, q > 0), (q, True)),
    q + 3 * sp.Max(0, q),
    (5 * q + 3 * sp.Abs(q)) / 2,
    4 * q - 3 * sp.Min(q, 0),
    q * (5 + 3 * sp.sign(q)) / 2,
]
"""A spring of 4 above zero and of 1 below, in all ways to write it."""


def two_slopes(times: np.ndarray) -> np.ndarray:
    """Its speed, from v = 1: half a period of rate 2, then half a period of rate 1."""
    u = np.mod(times, PERIOD)
    return np.where(u < np.pi / 2, np.cos(2 * u), -np.cos(u - np.pi / 2))


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize(
    ("spring", "method"),
    [*((spring, "DOP853") for spring in SLOPES), (SLOPES[1], "Radau")],
    ids=str,
)
def test_two_slopes_are_two_motions_one_after_the_other(spring: sp.Expr, method: str) -> None:
    times = np.linspace(0, 2 * PERIOD, 41)
    found = simulator(oscillator(spring), {}).run(times, {"v": 1.0}, method=method)
    assert found["v"] == pytest.approx(two_slopes(times), abs=5e-10)
    assert found.events == ()


def test_the_same_in_c_and_corners_are_events_when_asked_for() -> None:
    times, equations = np.linspace(0, 4 * PERIOD, 41), oscillator(SLOPES[0])
    crossed = np.cumsum([np.pi / 2, np.pi] * 4)[:-1]
    for backend in codegen.simulate.BACKENDS:
        ready = simulator(equations, {}, backend=backend)
        assert ready.run(times, {"v": 1.0}).events == ()
        for method in ("DOP853", "Radau"):
            found = ready.run(times, {"v": 1.0}, method=method, corners=True, **TIGHT)
            assert found.backend == backend
            assert found["v"] == pytest.approx(two_slopes(times), abs=1e-11)
            assert {(event.port, event.kind) for event in found.events} == {("s", "corner")}
            assert [event.time for event in found.events][:7] == pytest.approx(crossed, abs=1e-11)


def test_an_error_follows_the_tolerance_and_steps_do_not_crowd_at_corners(
    evaluations: list[int],
) -> None:
    """Beside the same run that steps over corners."""
    times, equations = np.linspace(0, 4 * PERIOD, 5), oscillator(SLOPES[1])
    errors = [
        np.abs(
            simulator(equations, {}).run(times, {"v": 1.0}, rtol=rtol, atol=rtol / 10)["v"]
            - two_slopes(times)
        ).max()
        for rtol in (1e-6, 1e-8, 1e-10, 1e-12)
    ]
    assert (np.array(errors) < np.array([2e-5, 2e-7, 1e-9, 1e-11])).all(), errors
    ready = simulator(equations, {})
    evaluations[0] = 0
    ready.run(times, {"v": 1.0})
    own, evaluations[0] = evaluations[0], 0
    program = codegen.lower(equations, None, [], timed=True)
    over = codegen.simulate.bound(program, equations, {})
    over.run(times, {"v": 1.0})
    assert own < 0.6 * evaluations[0]


def test_what_rests_on_a_corner_or_grazes_it_is_not_stopped() -> None:
    times = np.linspace(0, 2, 5)
    rests = simulator(oscillator(SLOPES[0]), {}).run(times, corners=True)
    assert not rests["v"].any()
    thrown = oscillator(sp.Max(0, 100 * (q - 1)), bg.Se("g", -2))
    grazes = simulator(thrown, {}).run(times, {"v": 2.0}, corners=True)
    assert grazes["v"] == pytest.approx(2 - 2 * times, abs=1e-12)
    assert len(rests.events) == 0
    assert len(grazes.events) in (0, 2)


def test_an_excursion_inside_a_step_is_found() -> None:
    """1e-6 above the corner for 2e-3 s of a motion that steps of 0.1 s would do for."""
    height = 1 - 1e-6
    thrown = oscillator(sp.Max(0, 100 * (q - sp.Rational(height))), bg.Se("g", -2))
    found = simulator(thrown, {}).run([0.0, 2.0], {"v": 2.0}, corners=True, **TIGHT)
    # In contact x" = -2 - 100 x from 0 at a speed of w: back at 0 where tan(5 t) = w/0.2.
    up = 1 - np.sqrt(1 - height)
    back = up + np.arctan((2 - 2 * up) / 0.2) / 5
    assert [event.time for event in found.events] == pytest.approx([up, back], abs=1e-10)


def test_a_motion_that_dies_down_on_a_corner_crosses_it_no_longer_below_its_tolerance() -> None:
    stiff = sp.Piecewise((400 * q, q > 0), (100 * q, True))
    found = simulator(oscillator(stiff, damper=4 * v), {}).run(
        [0.0, 30.0], {"v": 1.0}, corners=True
    )
    # Amplitudes fall by exp(-2 t), down to 1e-11 after some 12 s; two crossings in a swing.
    swing = np.pi / np.sqrt(396) + np.pi / np.sqrt(96)
    assert 2 * 9 / swing < len(found.events) < 2 * 14 / swing
    assert np.abs(found["v"][-1]) < 1e-10


def test_a_branch_that_is_not_taken_has_no_corners() -> None:
    law = sp.Piecewise(
        (q + sp.Max(0, q + sp.Rational(1, 2)), q > 0), (sp.Rational(1, 2) + 2 * q, True)
    )
    found = simulator(oscillator(law), {}).run([0.0, 6.0], {"v": 1.0}, corners=True, **TIGHT)
    # The corner at -1/2 lies on the other side of that at 0: the motion comes by, and no law has one there.
    state = simulator(oscillator(law), {}).run(
        [0.0, *(e.time for e in found.events)], {"v": 1.0}, **TIGHT
    )
    assert state["q_s"][1:] == pytest.approx(0, abs=1e-10)
    assert len(found.events) >= 2


def test_a_jump_with_a_factor_that_moves_is_crossed_and_one_that_pushes_back_is_refused() -> None:
    """q" = -(1 + q^2) sign(q): below and above zero the same arc, turned over."""
    crossed = simulator(oscillator((1 + q**2) * sp.sign(q)), {})
    found = crossed.run(np.linspace(0, 5, 11), {"v": 1.0}, corners=True, **TIGHT)
    energy = found["v"] ** 2 / 2 + np.abs(found["q_s"]) + np.abs(found["q_s"]) ** 3 / 3
    assert energy == pytest.approx(np.full(11, 0.5), abs=1e-11)
    assert len(found.events) == 2
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law=(1 + v**2) * sp.sign(v))]
    with pytest.raises(bg.SimulationError, match="no longer advances"):
        simulator(bg.derive(bond_graph(nodes, "n>m n>r")), {}).run([0.0, 2.0], {"v": 1.0})


def test_a_level_beyond_its_corner_is_not_refused() -> None:
    """|q|/2 + 1/50 falls below zero only on the side where q is not; what is below there, is."""
    mild = oscillator(10 * q, bg.R("mu", law=bg.DryFriction(sp.Abs(q) / 2 + sp.Rational(1, 50))))
    found = simulator(mild, {}).run(np.linspace(0, 6, 25), {"v": 1.0}, corners=True)
    kinds = [event.kind for event in found.events]
    assert kinds.count("corner") >= 4
    assert "stick" not in kinds[:3]
    wrong = oscillator(10 * q, bg.R("mu", law=bg.DryFriction(sp.Abs(q) - sp.Rational(1, 50))))
    with pytest.raises(bg.SimulationError, match="level -"):
        simulator(wrong, {}).run([0.0, 6.0], {"v": 1.0})


def test_a_corner_of_an_input_and_of_a_modulus() -> None:
    nodes = [bg.Se("f", sp.Abs(sp.Symbol("u"))), bg.One("n"), bg.I("m", 1, flow="v")]
    pushed = simulator(bg.derive(bond_graph(nodes, "f>n>m")), {})
    found = pushed.run([0.0, 1.25], inputs={"u": Sine(1.0, 1.0)}, corners=True)
    assert found["v"][-1] == pytest.approx(5 / (2 * np.pi), abs=1e-10)
    assert [event.time for event in found.events] == pytest.approx([0.5, 1.0], abs=1e-12)
    ratio = bg.TF("tf", 1 + sp.Abs(sp.Symbol("w")))
    nodes = [bg.Se("f", 1), bg.One("a"), bg.I("J", 1, flow="w"), ratio, bg.One("b"), bg.R("r", 1)]
    geared = simulator(bg.derive(bond_graph(nodes, "f>a>J a>tf>b>r")), {})
    slow = geared.run([0.0, 2.0], {"w": -1.0}, corners=True, **TIGHT)
    (crossed,) = slow.events
    assert (crossed.port, crossed.kind) == ("tf", "corner")


def test_steps_of_inputs_and_corners_at_one_instant() -> None:
    """The push steps where the mass is on the corner: it goes on to the other side, or back."""
    for push, end in ((1.0, 1.0), (-3.0, -3.0)):
        pushed = oscillator(sp.Max(0, q), bg.Se("f", "u"))
        found = simulator(pushed, {}).run(
            [0.0, 1.0, 1.1], {"q_s": -1.0, "v": 1.0}, {"u": Step(1.0, push)}
        )
        assert np.sign(found["v"][-1] - found["v"][1]) == np.sign(end)
        assert found["v"][1] == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("seed", seeds("corners"))
def test_random_chains_are_what_scipy_finds_branch_by_branch(seed: int) -> None:
    """Every state to 1e-10 of its range, and every crossing, in numpy and, of one in three, in C."""
    chain, times = random_chain(seed), np.linspace(0, 3, 31)
    expected, crossed = chain.by_branches(times)
    shake = {"F": Sine(*chain.shaken)}
    for backend in ("numpy", "c") if seed % 3 == 0 else ("numpy",):
        ready = simulator(chain.equations(), {}, backend=backend)
        found = ready.run(times, chain.initial, shake, "auto", corners=True, **TIGHT)
        assert found.backend == backend
        for name, column in zip(chain.names, expected.T, strict=True):
            assert found[name] == pytest.approx(column, abs=1e-10 * np.ptp(column)), name
        told = sorted(event.time for event in found.events if event.kind == "corner")
        assert told == pytest.approx(sorted(crossed), abs=1e-9)


def test_the_sides_of_a_model_are_one_for_all_its_runs() -> None:
    """What is worked out for one side is no part of the model itself."""
    closed: ClosedModel = simulator(oscillator(SLOPES[1]), {}).closed
    above, below = closed.on_sides((1,)), closed.on_sides((-1,))
    s = np.array([0.5, -0.25])
    rates = [model.at(0.0, s, [], ()).rate.tolist() for model in (closed, above, below)]
    assert rates[0] == rates[2] != rates[1]
    assert closed.on_sides((1,)) is above


@pytest.mark.usefixtures("closely")
def test_a_law_without_a_value_beyond_its_corner_is_crossed_all_the_same() -> None:
    """q" = -4 sign(q) sqrt|q|: v^2/2 + 8/3 |q|^(3/2) stays 1/2."""
    law = 4 * sp.sign(q) * sp.sqrt(sp.Abs(q))
    found = simulator(oscillator(law), {}).run(np.linspace(0, 3, 7), {"v": 1.0}, corners=True)
    energy = found["v"] ** 2 / 2 + 8 / 3 * np.abs(found["q_s"]) ** 1.5
    assert energy == pytest.approx(np.full(7, 0.5), abs=1e-8)
    assert len(found.events) == 2


def test_a_tank_that_has_run_empty_stays_so() -> None:
    """``h' = -sqrt(h)``: sqrt(h) = 1 - t/2, and nothing from t = 2 on, where the slope is infinite."""
    graph = bg.graph(
        [bg.Zero("tank"), bg.C("A", "A", effort="h"),
         bg.R("hole", law="sign(e_hole)*sqrt(abs(e_hole)/d)", gives="flow")],
        "tank > A, tank > hole",
    )  # fmt: skip
    times = np.array([0.0, 0.5, 1.0, 1.9, 2.0, 2.05])
    run = simulator(bg.derive(graph), {"A": 1.0, "d": 1.0}).run(times, {"h": 1.0})
    assert run["h"] == pytest.approx(np.maximum(0.0, 1 - times / 2) ** 2, abs=1e-8)

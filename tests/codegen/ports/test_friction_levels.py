"""Levels that are zero, fall, step, rise, depend on state or time; ports that start at rest."""

import numpy as np
import pytest
from oracles.models import block, oscillator
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Lag, Ramp, Result, Sine, Step, simulator

TIMES = np.linspace(0, 3, 121)


def _run(law: object, push: object, start=None, m: float = 2.0, more=None, **numbers) -> Result:
    run = simulator(bg.derive(block(law)), {"m": m, **numbers})
    return run.run(TIMES, start, {"P": push, **(more or {})})


def _events(result: Result) -> list[tuple[float, str]]:
    return [(event.time, event.kind) for event in result.events]


@pytest.mark.parametrize("push", [0.0, 2.9, -2.9, 3.0, -3.0])
def test_a_port_that_starts_at_rest_is_held(push: float) -> None:
    result = _run(bg.DryFriction(3), push)
    assert result.events == ()
    assert not result["v"].any()
    assert result["f"] == pytest.approx(np.full_like(TIMES, push), abs=1e-12)


@pytest.mark.parametrize("push", [3.1, -4.0, 30.0])
def test_a_port_that_starts_at_rest_is_not_held_beyond_its_level(push: float) -> None:
    result = _run(bg.DryFriction(3), push)
    assert result["v"] == pytest.approx((push - 3 * np.sign(push)) / 2 * TIMES, abs=1e-11)


@pytest.mark.parametrize(("slope", "moves"), [(0.7, True), (-0.7, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_exactly_at_breakaway_the_trend_decides(slope: float, moves: bool, sign: float) -> None:
    """P = 3 + slope t against a level of 3: v = slope t^2/(2 m), or rest."""
    result = _run(bg.DryFriction(3), Ramp(0.0, sign * slope, sign * 3.0))
    expected = sign * slope * TIMES**2 / 4 if moves else 0 * TIMES
    assert result["v"] == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("law", [bg.DryFriction(0), bg.DryFriction(0, 1, 1.5), bg.DryFriction("L")])
def test_a_level_of_zero_is_no_friction(law: bg.DryFriction) -> None:
    numbers = {"L": 0.0} if law.free_symbols else {}
    result = _run(law, Sine(3.0, 0.7), {"v": 0.4}, **numbers)
    w = 2 * np.pi * 0.7
    assert result["v"] == pytest.approx(0.4 + 1.5 / w * (1 - np.cos(w * TIMES)), abs=1e-9)
    assert not result["f"].any()
    assert len(result.events) < 12


def test_a_free_oscillator_with_a_level_of_zero_swings_for_ever() -> None:
    run = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 25.0, "F_c": 0.0})
    result = run.run(np.linspace(0, 6, 101), {"F": 2.0})
    assert result["F"] == pytest.approx(2 * np.cos(5 * result.time), abs=1e-8)
    assert len(result.events) < 30


@pytest.mark.parametrize("ratio", [1.0, 1.25])
def test_a_level_that_ramps_down_lets_go_when_it_meets_the_load(ratio: float) -> None:
    """L = 5 - 2 t, push 3: released at ratio L = 3; then m v' = 3 - L while it falls to 0.2 at 2.4."""
    law = bg.DryFriction("L", 1, ratio)
    result = _run(law, 3.0, more={"L": Ramp(0.0, -2.0, 5.0, end=2.4)})
    release = (5 - 3 / ratio) / 2
    assert _events(result) == [(pytest.approx(release, abs=1e-9), "slip")]

    def moved(t: np.ndarray) -> np.ndarray:
        return (-2 * t + t**2) / 2

    v = moved(np.clip(TIMES, release, 2.4)) - moved(np.array(release))
    v += 2.8 / 2 * np.maximum(TIMES - 2.4, 0.0)
    assert result["v"] == pytest.approx(v, abs=1e-8)


def test_a_level_that_steps_down_lets_go_at_the_step() -> None:
    result = _run(bg.DryFriction("L"), 3.0, more={"L": Step(1.0, 2.0, 5.0)})
    assert _events(result) == [(1.0, "slip")]
    assert result["v"] == pytest.approx(0.5 * np.maximum(TIMES - 1, 0), abs=1e-10)


def test_a_level_that_steps_down_but_still_holds_changes_nothing() -> None:
    result = _run(bg.DryFriction("L"), 3.0, more={"L": Step(1.0, 3.1, 5.0)})
    assert result.events == ()
    assert not result["v"].any()


def test_a_level_that_steps_up_stops_the_mass() -> None:
    """Free until 1.0, 3/2 fast; then decelerated by (L - P)/m = 2.5, at rest 0.6 later."""
    result = _run(bg.DryFriction("L"), 3.0, more={"L": Step(1.0, 8.0)})
    assert _events(result) == [(pytest.approx(1.6, abs=1e-10), "stick")]
    expected = np.interp(TIMES, [0, 1, 1.6], [0, 1.5, 0])
    assert result["v"] == pytest.approx(expected, abs=1e-10)
    assert result["f"][-1] == pytest.approx(3.0, abs=1e-10)


def test_a_level_through_a_lag_catches_and_keeps_the_mass() -> None:
    level = Lag(Step(0.5, 9.0), 0.2)
    result = _run(bg.DryFriction("L"), 3.0, more={"L": level})

    def rest(t: float, y: np.ndarray) -> float:
        return float(y[0])

    rest.terminal, rest.direction = True, -1
    found = solve_ivp(
        lambda t, y: [(3.0 - 9.0 * -np.expm1(-(t - 0.5) / 0.2)) / 2], (0.5, 3), [0.75], "DOP853",
        rtol=1e-13, atol=1e-14, events=rest,
    )  # fmt: skip
    assert _events(result) == [(pytest.approx(found.t[-1], abs=1e-9), "stick")]
    assert np.abs(result["v"][found.t[-1] < TIMES]).max() < 1e-10


def test_a_level_of_time() -> None:
    """L = 4 + 2 sin(3 t) under a push of 3: released where it falls below, caught later, released again."""
    result = _run(bg.DryFriction("4 + 2*sin(3*t)"), 3.0)
    release = (np.pi + np.arcsin(0.5)) / 3
    assert _events(result)[0] == (pytest.approx(release, abs=1e-9), "slip")

    def v(t):
        return (-(t - release) + 2 / 3 * (np.cos(3 * t) - np.cos(3 * release))) / 2

    inside = (release < TIMES) & (TIMES < 2.3)
    assert result["v"][inside] == pytest.approx(v(TIMES[inside]), abs=1e-8)


def test_a_level_of_the_state() -> None:
    """A brake whose level grows with the spring's load: L = mu |F|, with the spring's F' = k v."""
    run = simulator(
        bg.derive(oscillator(law=bg.DryFriction("mu*abs(F)"))), {"m": 1.0, "k": 16.0, "mu": 0.2}
    )
    result = run.run(TIMES, {"F": 4.0})
    # Towards the middle v' = -(1 - mu) k x, away from it -(1 + mu) k x: half-cycles of two frequencies.
    near, far = np.sqrt(16 * 0.8), np.sqrt(16 * 1.2)
    middle, turn = np.pi / 2 / near, np.pi / 2 / near + np.pi / 2 / far
    first = middle > TIMES
    assert result["F"][first] == pytest.approx(4 * np.cos(near * TIMES[first]), abs=1e-8)
    second = (middle < TIMES) & (turn > TIMES)
    reach = 4 * near / far
    assert result["F"][second] == pytest.approx(
        -reach * np.sin(far * (TIMES[second] - middle)), abs=1e-7
    )
    assert _events(result)[0] == (pytest.approx(turn, abs=1e-8), "cross")


@pytest.mark.parametrize(
    "law", [bg.DryFriction("L"), bg.DryFriction("L", "1 + slip"), bg.DryFriction("L - 0*t")]
)
def test_a_level_that_becomes_negative_ends_the_run_with_its_port(law: bg.DryFriction) -> None:
    # Nothing is left of it at 1 s.
    message = r"at t = 1(\.0\d*)? .*'ground' has level -\d\S*, curve \d.*negative"
    with pytest.raises(bg.SimulationError, match=message):
        _run(law, 3.0, more={"L": Ramp(0.0, -2.0, 2.0)})


def test_a_negative_level_is_refused_at_the_start() -> None:
    message = r"at t = 0 .*'ground'.* -2.*negative"
    with pytest.raises(bg.SimulationError, match=message):
        _run(bg.DryFriction("L"), 3.0, L=-2.0)
    run = simulator(bg.derive(block(bg.DryFriction("L"))), {"m": 1.0, "L": -2.0})
    with pytest.raises(bg.SimulationError, match=message):
        run.rhs(0.0, [1.0], [0.0])


@pytest.mark.parametrize("ratio", [0.5, 0.0, -1.0])
def test_a_breakaway_below_the_curve_is_refused_in_numbers_too(ratio: float) -> None:
    """As `DryFriction` refuses it in its own numbers: held there a port could neither stick nor slip."""
    with pytest.raises(bg.BondGraphError, match="breakaway"):
        _run(bg.DryFriction("L", 1, "ratio"), Sine(4.0, 1.0), L=2.0, ratio=ratio)

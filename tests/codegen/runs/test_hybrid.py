"""The loop of legs, events and breakpoints: it goes on, or says why it cannot."""

import numpy as np
import pytest
from oracles.models import block

import bondgraph as bg
from codegen import Constant, Ramp, Sine, Step, simulator
from codegen.modes.choose import Decision
from codegen.runs import hybrid

BLOCK = simulator(bg.derive(block()), {"m": 2.0, "F_c": 3.0})


@pytest.mark.parametrize("push", [-7.0, 7.0])
def test_a_run_that_makes_no_progress_ends(monkeypatch: pytest.MonkeyPatch, push: float) -> None:
    """Told to slip against its push for ever, the port would fall back to zero again and again."""
    told = (-int(np.sign(push)),)
    monkeypatch.setattr(hybrid, "decide", lambda _, here: Decision(told, here.s, ()))
    with pytest.raises(bg.SimulationError, match=r"the run makes no progress"):
        BLOCK.run([0.0, 1.0], inputs={"P": push})


def test_friction_written_as_a_jump_holds_as_friction_does() -> None:
    """m v' = 1 - 3 sign(v) from v = 1: at rest after 1 s."""
    run = simulator(bg.derive(block()), {"m": 2.0}, laws={"ground": "3*sign(slip)"})
    result = run.run([0.0, 0.5, 2.0], {"v": 1.0}, {"P": 1.0})
    assert result["v"] == pytest.approx([1.0, 0.5, 0.0], abs=1e-12)
    assert [(e.kind, e.time) for e in result.events] == [("slide", pytest.approx(1.0, abs=1e-12))]


def test_breakpoints_outside_the_run_are_no_breakpoints() -> None:
    """Signals are what they are at the start, whatever they did before and will do later."""
    inside = Step(-1.0, 5.0) + Step(9.0, 50.0) + Ramp(-2.0, 1.0, end=-1.5)
    result = BLOCK.run(np.linspace(0, 2, 9), inputs={"P": inside})
    assert result["v"] == pytest.approx((5.0 + 0.5 - 3.0) / 2 * result.time, abs=1e-10)


@pytest.mark.parametrize("steps", [2, 30, 300])
def test_many_steps_at_one_instant_are_one(steps: int) -> None:
    total = Constant(0.0)
    for _ in range(steps):
        total = total + Step(0.5, 6.0 / steps)
    result = BLOCK.run(np.linspace(0, 2, 9), inputs={"P": total})
    assert [(event.time, event.kind) for event in result.events] == [(0.5, "slip")]
    assert result["v"] == pytest.approx(1.5 * np.maximum(result.time - 0.5, 0.0), abs=1e-10)


def test_breakpoints_a_spacing_apart_are_passed_one_after_the_other() -> None:
    """The push is on for the least time there is; nothing moves by more than rounding."""
    on, off = 0.5, float(np.nextafter(0.5, 1.0))
    result = BLOCK.run(np.linspace(0, 1, 5), inputs={"P": Step(on, 50.0) + Step(off, -50.0)})
    assert np.abs(result["v"]).max() < 1e-12
    assert len(result.events) <= 2


def test_events_of_a_long_run_stay_bounded_and_regular() -> None:
    """Shaken beyond its friction for 200 periods: it comes to rest in none and turns twice in each."""
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1.0})
    result = run.run([0.0, 200.0], {"v": -10.0 / (2 * np.pi)}, {"P": Sine(10.0, 1.0)})
    assert 395 <= len(result.events) <= 401
    late = np.array([event.time for event in result.events[-100:]])
    # Settled, half a period apart; friction shifts the turns but not their distance.
    assert np.diff(late) == pytest.approx(np.full(99, 0.5), abs=1e-8)

"""Inputs that are taken where a stepper is, before it goes on: shown as samples of a run show them."""

import numpy as np
import pytest

import bondgraph as bg
from bondgraph.errors import SignalError
from codegen import Step, Stepper, ZeroOrderHold, simulator

METHODS = pytest.mark.parametrize(
    ("backend", "method"), [("numpy", "auto"), ("numpy", "DOP853"), ("c", "auto"), ("c", "DOP853")]
)

BLOCK = bg.graph(
    [bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
     bg.R("rub", law=bg.DryFriction("L"), effort="f"), bg.Df("way", integrate="x")],
    "force > j > m", "j > rub", "j > way",
)  # fmt: skip

SAMPLED = bg.graph(
    [bg.Controller("c", every="1/10", reads=["u"], states={"z": 0}, update={"z": "z + u"},
                   gives={"y": "2*u + z"}),
     bg.Function("through", "u + z")],
)  # fmt: skip

FORCES = [0.0, 2.9, 5.0, 5.0, -1.0, -4.0, 0.0, 8.0]


def _block(backend: str, method: str) -> Stepper:
    ready = simulator(bg.derive(BLOCK), {"m": 2, "L": 3}, backend=backend)
    return ready.stepper({"v": 1.0}, {"F": 0.0}, method=method)


@METHODS
def test_what_is_given_shows_what_a_run_shows_there(backend: str, method: str) -> None:
    times = np.arange(len(FORCES)) / 4
    held = ZeroOrderHold(times, FORCES)
    wanted = simulator(bg.derive(BLOCK), {"m": 2, "L": 3}).run(times, {"v": 1.0}, {"F": held})
    one = _block(backend, method)
    for k, force in enumerate(FORCES):
        one.give(F=-force)
        now = one.give(F=force)
        for name in ("v", "x", "f", "F"):
            assert now[name] == pytest.approx(wanted[name][k], abs=1e-9)
        if k + 1 < len(FORCES):
            one.advance_to(float(times[k + 1]))
            assert one.time == times[k + 1]
    assert one.backend == backend


@METHODS
def test_events_of_what_is_given_are_told_there_and_not_again(backend: str, method: str) -> None:
    one = _block(backend, method)
    one.advance_to(1.0)
    assert [(e.kind, round(e.time, 9)) for e in one.events] == [("stick", round(2 / 3, 9))]
    one.give(F=2.9)
    assert len(one.events) == 1
    one.give(F=5.0)
    assert [(e.kind, e.time) for e in one.events[1:]] == [("slip", 1.0)]
    one.give(F=6.0)
    assert len(one.events) == 2
    one.advance_to(2.0)
    assert one.events == ()
    assert one.signals["v"] == pytest.approx(1.5)


@METHODS
def test_what_is_sampled_at_an_instant_sees_what_is_given_there(backend: str, method: str) -> None:
    ready = simulator(bg.derive(SAMPLED), {}, backend=backend)
    one = ready.stepper(inputs={"u": 9.0}, method=method)
    z = 0.0
    for k in range(1, 6):
        one.give(u=100.0)
        now = one.give(u=float(k))
        assert now["y"] == pytest.approx(2 * k + z)
        z += k
        assert now["z"] == pytest.approx(z)
        assert now["through"] == pytest.approx(k + z)
        one.advance_to(k / 10)


def test_a_state_that_was_given_something_goes_on_elsewhere() -> None:
    one, other = _block("numpy", "auto"), _block("c", "auto")
    one.advance_to(1.0)
    one.give(F=5.0)
    other.restore(one.state)
    assert other.advance_to(2.0)["v"] == pytest.approx(one.advance_to(2.0)["v"], abs=1e-12)
    assert one.signals["v"] == pytest.approx(1.0)


def test_times_that_are_not_later_and_inputs_that_there_are_not() -> None:
    one = _block("numpy", "auto")
    one.advance_to(0.5)
    for time in (0.5, 0.4, float("nan"), float("inf"), "1"):
        with pytest.raises(SignalError, match=r"from t = 0\.5 s a step leads to no time"):
            one.advance_to(time)
    with pytest.raises(SignalError, match="unknown input 'G'"):
        one.give(G=1.0)
    with pytest.raises(SignalError):
        one.give(F="x")
    assert one.time == 0.5
    assert one.give(F=Step(0.75, 5.0))["F"] == 0.0

"""Laws that jump: sliding along the jump, leaving it, and jumps that cross, against closed forms."""

import numpy as np
import pytest
from oracles.relays import RELAYS, Relay, mass, oscillating, two

import bondgraph as bg
from codegen import Ramp, Result, simulator

CLOSE = 1e-9
"""Of a range of 1 or more."""


def ran(relay: Relay, backend: str = "numpy", method: str = "auto") -> Result:
    times = np.concatenate([[0.0], relay.slides + np.linspace(0.01, 1.0, 21)])
    run = simulator(relay.equations, {}, backend=backend)
    return run.run(times, relay.start, relay.inputs, method=method)


def check(relay: Relay, result: Result) -> None:
    for name, values in relay.known(result.time[1:]).items():
        assert np.abs(result[name][1:] - values).max() < CLOSE, name
    assert [event.kind for event in result.events] == ["slide"]
    assert result.events[0].time == pytest.approx(relay.slides, abs=CLOSE)
    hidden = ("smooth_", "jump_", "offset_", "hangs_", "along_", "beyond_", "shape_", "moving_")
    assert [name for name in result if name.startswith(hidden)] == []


@pytest.mark.parametrize("method", ["auto", "DOP853", "Radau"])
@pytest.mark.parametrize("name", RELAYS)
def test_relays_slide_as_they_are_known_to(name: str, method: str) -> None:
    relay = RELAYS[name]()
    result = ran(relay, method=method)
    check(relay, result)
    assert abs(result.audit().residual) < 1e-8


@pytest.mark.parametrize("name", ["sides", "moving", "cubic"])
def test_c_slides_as_well(name: str) -> None:
    relay = RELAYS[name]()
    for method in ("auto", "DOP853"):
        result = ran(relay, "c", method)
        assert result.backend == "c"
        check(relay, result)


def test_it_leaves_where_the_share_leaves_its_bounds() -> None:
    """v' = 3 t - 2 sign(v) from v = 1/4: at rest from 1/4 - 2 t + 3 t^2/2 = 0 on, until 3 t is 2."""
    run = simulator(mass("2*sign(v_r)"), {})
    comes, goes = (2 - np.sqrt(4 - 6 * 0.25)) / 3, 2 / 3
    result = run.run([0.0, 0.5, goes, 2.0], {"v": 0.25}, {"F": Ramp(0.0, 3.0)})
    assert [(e.kind, e.time) for e in result.events] == [
        ("slide", pytest.approx(comes, abs=CLOSE)), ("leave", pytest.approx(goes, abs=CLOSE)),
    ]  # fmt: skip
    assert result["v"][1:] == pytest.approx([0, 0, 1.5 * (2.0 - goes) ** 2], abs=CLOSE)
    assert result["F_r"][1:3] == pytest.approx([1.5, 2.0], abs=CLOSE)


def test_jumps_that_are_crossed_are_no_events() -> None:
    """x'' = -sign(x) from x = 1: parabolas, 4 sqrt(2) long."""
    result = simulator(oscillating("sign(x)"), {}).run([0.0, 1.0, 4 * np.sqrt(2.0)], {"x": 1.0})
    assert result["x"] == pytest.approx([1.0, 0.5, 1.0], abs=CLOSE)
    assert result.events == ()


def test_a_jump_may_be_crossed_as_often_as_it_is() -> None:
    """x'' = -1e11 sign(x): two crossings in each 0.57 us, far more than 60 in a moment of slow models."""
    period = 4 * np.sqrt(2e-3 / 1e11)
    result = simulator(oscillating("1e11*sign(x)"), {}).run([0.0, 40 * period], {"x": 1e-3})
    assert result["x"][-1] == pytest.approx(1e-3, rel=CLOSE)


def test_two_relays_slide_one_after_the_other() -> None:
    """First y, with a share of -1/4, so that x' = -43/40; then both."""
    model = two("-sign(x) + 3*sign(y)/10", "-4*sign(y)/5 - sign(x)/5")
    result = simulator(model, {}).run([0.0, 0.4, 1.0, 3.0], {"x": 1.0, "y": 0.5})
    meets = 0.5 + 0.65 / 1.075
    assert [(e.kind, e.port, e.time) for e in result.events] == [
        ("slide", "a", pytest.approx(0.5, abs=CLOSE)), ("slide", "a", pytest.approx(meets, abs=CLOSE)),
    ]  # fmt: skip
    assert result["x"] == pytest.approx([1.0, 0.72, 0.65 - 1.075 * 0.5, 0.0], abs=CLOSE)
    assert result["y"] == pytest.approx([0.5, 0.1, 0.0, 0.0], abs=CLOSE)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_two_relays_spiral_to_where_both_slide(backend: str) -> None:
    """Each quarter turn is a third of the last: x = y = 0 after 1/2 s."""
    model = two("-sign(x) + 2*sign(y)", "-sign(y) - 2*sign(x)")
    run = simulator(model, {}, backend=backend)
    result = run.run([0.0, 1 / 3, 0.6, 2.0], {"x": 0.0, "y": 1.0})
    assert result["x"] == pytest.approx([0.0, 1 / 3, 0.0, 0.0], abs=CLOSE)
    assert result["y"] == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=CLOSE)
    assert {event.kind for event in result.events} == {"slide"}
    assert result.events[-1].time == pytest.approx(0.5, abs=1e-6)


def test_a_trim_may_slide() -> None:
    from codegen import trim

    point = trim(simulator(mass("v_r + 2*sign(v_r - 1/2)"), {}), {"F": 1.2}, {"v": 0.0})
    assert point["v"] == pytest.approx(0.5, abs=CLOSE)
    with pytest.raises(
        bg.StructureError, match="'r' is no switch and has no dry friction; there are none"
    ):
        trim(simulator(mass("sign(v_r)"), {}), {"F": 0.2}, mode={"r": "stick"})

"""Events inside an integration step: found to rounding, in order, and none that are not there."""

import numpy as np
import pytest
from oracles.models import belt, block, clutches
from scipy.optimize import brentq, minimize_scalar

import bondgraph as bg
from codegen import Event, Ramp, Sampled, Signal, Sine, simulator

TIMES = np.linspace(0, 2, 21)


def test_an_event_is_a_time_a_port_and_a_kind() -> None:
    event = Event(0.5, "clutch", "stick")
    assert (event.time, event.port, event.kind) == (0.5, "clutch", "stick")
    assert event == Event(0.5, "clutch", "stick")


def _dipping(depth: float) -> tuple[dict[str, object], list[float]]:
    """A mass pushed back by 4 sin(2 pi t), friction 1e-6: its speed dips to -depth after t = 1/2.

    Returns start and the two instants of zero speed, in closed form while the slip keeps its sign.
    """
    w, L = 2 * np.pi, 1e-6

    def v(t: float, way: float, t_0: float, v_0: float) -> float:
        return v_0 + 4 / w * (np.cos(w * t) - np.cos(w * t_0)) - way * L * (t - t_0)

    lowest = minimize_scalar(lambda t: v(t, 1, 0, 0), bounds=(0.3, 0.7), options={"xatol": 1e-13}).x
    start = -v(lowest, 1, 0, 0) - depth
    first = brentq(lambda t: v(t, 1, 0, start), 0.2, lowest, xtol=1e-15)
    second = brentq(lambda t: v(t, -1, first, 0), (first + lowest) / 2 + 1e-12, 1.0, xtol=1e-15)
    return {"v": start}, [first, second]


@pytest.mark.parametrize("depth", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_both_of_two_close_zeros_are_found(depth: float, method: str, backend: str) -> None:
    start, zeros = _dipping(depth)
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1e-6}, backend=backend)
    result = run.run([0.0, 0.9], start, {"P": Sine(-4.0, 1.0)}, method=method)
    assert [event.kind for event in result.events] == ["cross", "cross"]
    # A zero of a speed of accuracy 1e-10, dipped by depth, is known to about 1e-10/sqrt(depth).
    assert [e.time for e in result.events] == pytest.approx(zeros, abs=1e-9 / np.sqrt(depth))


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6, 1e-8])
def test_a_speed_that_stays_above_zero_makes_no_event(gap: float) -> None:
    start, _ = _dipping(1e-3)
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1e-6})
    result = run.run([0.0, 0.9], {"v": start["v"] + 1e-3 + gap}, {"P": Sine(-4.0, 1.0)})
    assert result.events == ()


@pytest.mark.parametrize("excess", [1e-1, 1e-3, 1e-5, 1e-6])
def test_a_load_that_peaks_just_above_breakaway_lets_go_and_is_caught(excess: float) -> None:
    """P = (3 + excess) sin: released where it passes 3, decelerated after it has come back."""
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 3.0})
    P, w = 3.0 + excess, 2 * np.pi * 0.5
    release = np.arcsin(3.0 / P) / w

    def v(t: float) -> float:
        return P / w * (np.cos(w * release) - np.cos(w * t)) - 3.0 * (t - release)

    caught = brentq(v, 2 * (0.5 - release) * 1.2 + release, 1.0, xtol=1e-15)
    result = run.run([0.0, 0.99], inputs={"P": Sine(P, 0.5)})
    assert [event.kind for event in result.events] == ["slip", "stick"]
    assert [e.time for e in result.events] == pytest.approx(
        [release, caught], abs=1e-8 / np.sqrt(excess)
    )


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_a_load_that_peaks_just_below_breakaway_moves_nothing(gap: float) -> None:
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 3.0})
    result = run.run(TIMES, inputs={"P": Sine(3.0 - gap, 0.5)})
    assert result.events == ()
    assert not result["v"].any()


@pytest.mark.parametrize("frequency", [50.0, 400.0])
def test_events_faster_than_the_samples_are_all_found(frequency: float) -> None:
    """A belt that shakes under a fast mass: as many reversals as the sine has, twice a period."""
    run = simulator(bg.derive(belt()), {"m": 1e6, "F_c": 1.0})
    periods = 20
    end = periods / frequency
    result = run.run([0.0, end], {"v": 0.5}, {"V_b": Sine(1.0, frequency)})
    w = 2 * np.pi * frequency
    zeros = sorted([(np.pi / 6 + 2 * np.pi * n) / w for n in range(periods)]
                   + [(5 * np.pi / 6 + 2 * np.pi * n) / w for n in range(periods)])  # fmt: skip
    assert {event.kind for event in result.events} == {"cross"}
    # The mass changes its speed by 1e-6 per second, nothing beside the belt's.
    assert [e.time for e in result.events] == pytest.approx(zeros, rel=1e-6)


def test_the_first_of_several_ports_comes_first() -> None:
    """Three clutches of their own levels between the same shafts would lock together; brakes do not."""
    run = simulator(bg.derive(clutches(bg.DryFriction("L"))), {"I_1": 0.5, "I_2": 0.25, "L": 2.0})
    result = run.run(TIMES, {"w_1": 6.0}, {"T_1": Ramp(0.8, 30.0), "T_2": 0.0})
    # Slip 6 - 12 t locks at 0.5; then f = T_1/3 reaches 2 at T_1 = 6, t = 1.
    assert [e[:3] for e in result.events] == [
        (pytest.approx(0.5, abs=1e-11), "c0", "stick"), (pytest.approx(1.0, abs=1e-9), "c0", "slip"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "drive",
    [Sampled(np.linspace(0, 2, 401), np.sin(np.linspace(0, 12, 401)) * 4), Sine(4.0, 3 / np.pi)],
)
def test_breakpoints_by_the_hundred_change_nothing(drive: Signal) -> None:
    """Straight lines between samples of a sine, and the sine: the same events, to the lines' error."""
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 3.0})
    result = run.run(TIMES, inputs={"P": drive})
    first = np.arcsin(0.75) / 6
    assert result.events[0].time == pytest.approx(first, abs=2e-4)
    assert [e.kind for e in result.events] == ["slip", "stick"] * 3 + ["slip"] * (
        len(result.events) % 2
    )

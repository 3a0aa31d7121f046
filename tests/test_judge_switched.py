"""The judge of networks that switch: what is known in closed form, of diodes, switches and friction."""

from math import acos, asin, cos, exp, log, pi, sin, sqrt

import numpy as np
import pytest
from references.switched.mechanisms import dog_beside_clutch, jenkins, two_dogs
from references.switched.named import buck, opened_inductor, pulses, six_pulse
from references.switched.network import Branch, Network, Wave, joined
from references.switched.oracle import Course, Event, Oracle


def _run(network: Network, end: float, count: int = 101) -> tuple[np.ndarray, Course]:
    times = np.linspace(0.0, end, count)
    return times, Oracle(network).run(times)


def _near(events: list[Event], *right: Event) -> None:
    assert [e[1:] for e in events] == [e[1:] for e in right]
    assert [e[0] for e in events] == pytest.approx([e[0] for e in right], abs=1e-10)


def test_a_chopped_current_is_periodic_between_its_two_exponentials() -> None:
    """V on L and R for a part D of each period T: i_max = V/R (1 - exp(-D T/tau))/(1 - exp(-T/tau))."""
    V, L, R, T, D = 10.0, 1e-3, 2.0, 1e-4, 0.3
    tau = L / R
    most = V / R * (1 - exp(-D * T / tau)) / (1 - exp(-T / tau))
    least = most * exp(-(1 - D) * T / tau)
    network = joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)),
        Branch("K", "K0", 1, 2, instants=pulses(T, D, 4 * T)),
        Branch("D", "D0", 0, 2), Branch("L", "L0", 2, 3, L, start=least), Branch("R", "R0", 3, 0, R),
    )  # fmt: skip
    course = Oracle(network).run(np.array([0.0, D * T, T, (1 + D) * T, 2 * T, 3.5 * T]))
    low = most * exp(-(0.5 - D) * T / tau)
    assert course.columns["i_L0"] == pytest.approx(
        [least, most, least, most, least, low], rel=1e-11
    )
    assert len(course.events) == 2 * 7
    assert not course.loose


def test_a_buck_loses_no_volt_second() -> None:
    """L (i(n T) - i(0)) = D V n T - the integral of the capacitor's voltage, while current flows."""
    V, L, T, D, n = 10.0, 1e-4, 5e-5, 0.4, 8
    network = buck(V, L, 1e-4, 1.0, pulses(T, D, n * T), 4.0, 4.0)
    times, course = _run(network, n * T, 4001)
    u, i = course.columns["u_C0"], course.columns["i_L0"]
    assert i.min() > 0
    assert L * (i[-1] - i[0]) == pytest.approx(D * V * n * T - np.trapezoid(u, times), abs=1e-9)
    assert [kind for *_, kind in course.events] == ["off", "on", "on", "off"] * (n - 1) + [
        "off",
        "on",
    ]


def test_a_capacitor_rings_once_through_a_diode() -> None:
    """Half a sine, which leaves it charged the other way."""
    network = joined(
        Branch("C", "C0", 1, 0, 2.0, start=3.0),
        Branch("D", "D0", 1, 2),
        Branch("L", "L0", 2, 0, 0.5),
    )
    times, course = _run(network, 5.0)
    _near(course.events, (pi, "D0", "off"))
    flowing = times < pi
    assert course.columns["i_L0"][flowing] == pytest.approx(6.0 * np.sin(times[flowing]), abs=1e-11)
    assert course.columns["u_C0"][~flowing] == pytest.approx(-3.0, abs=1e-11)
    assert course.columns["i_L0"][~flowing] == pytest.approx(0.0, abs=1e-11)


def test_a_block_on_a_spring_loses_twice_the_level_in_each_swing() -> None:
    """m = k = 1, level 0.15: the spring's force at the turns is 1, -0.7, 0.4, -0.1, and there it sticks."""
    network = joined(
        Branch("C", "C0", 1, 0, 1.0), Branch("L", "L0", 1, 0, 1.0, start=1.0),
        Branch("F", "F0", 1, 0, 0.15),
    )  # fmt: skip
    times, course = _run(network, 12.0)
    _near(course.events, (pi, "F0", "cross"), (2 * pi, "F0", "cross"), (3 * pi, "F0", "stick"))
    at = times < pi
    force = 0.15 + 0.85 * np.cos(times[at])
    assert course.columns["i_L0"][at] == pytest.approx(force, abs=1e-11)
    assert course.columns["i_L0"][-1] == pytest.approx(-0.1, abs=1e-11)
    assert course.columns["i_F0"][-1] == pytest.approx(0.1, abs=1e-11)


def test_a_block_is_pulled_by_a_spring_and_breaks_away_at_the_level() -> None:
    """Pulled at 0.5 by k = 2 it waits for level/(k 0.5), and then has the speed 0.5 (1 - cos(omega t))."""
    network = joined(
        Branch("V", "V0", 0, 1, wave=Wave(0.5)), Branch("L", "L0", 1, 2, 0.5),
        Branch("C", "C0", 2, 0, 3.0), Branch("F", "F0", 2, 0, 0.8),
    )  # fmt: skip
    times, course = _run(network, 3.0)
    _near(course.events, (0.8, "F0", "slip"))
    speed = np.where(times < 0.8, 0.0, 0.5 * (1 - np.cos(sqrt(2 / 3) * (times - 0.8))))
    assert course.columns["u_C0"] == pytest.approx(speed, abs=1e-11)


def test_a_dog_closes_beside_a_stuck_clutch_which_then_slips() -> None:
    """The clutch takes no part of the shock: masses 2 and 3 share their momentum, then it drags 1 along."""
    network = dog_beside_clutch((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), 1.0, 0.2, 1.0)
    _, course = _run(network, 3.0, 4)
    both = (2 * (0.2 / 3) + 3) / 5
    together = 1 + (both - 0.2 / 3) / (1.2 + 0.2)
    _near(course.events, (1.0, "F0", "slip"), (1.0, "K0", "on"), (together, "F0", "stick"))
    assert course.columns["u_C1"] == pytest.approx([0, both, 0.6 - 0.2 / 6, 0.6], abs=1e-11)
    assert course.columns["u_C0"] == pytest.approx([0, 0.2 / 3, 0.6 - 0.2 / 6, 0.6], abs=1e-11)


def test_two_dogs_on_one_slip_share_momentum_once() -> None:
    network = two_dogs((1.0, 2.0), (1.0, 0.0), 0.3, (1.0, 2.0), (1.5, 2.5))
    _, course = _run(network, 3.0, 7)
    first = [1.0, 1.15, 1.3 / 3, 1.45 / 3, 1.6 / 3, 1.75 / 3, 1.75 / 3 + 0.15]
    second = [0, 0, 1.3 / 3, 1.45 / 3, 1.6 / 3, 1.75 / 3, 1.75 / 3]
    assert course.columns["u_C0"] == pytest.approx(first, abs=1e-11)
    assert course.columns["u_C1"] == pytest.approx(second, abs=1e-11)
    assert [(p, k) for _, p, k in course.events] == [
        ("K0", "on"), ("K1", "on"), ("K0", "off"), ("K1", "off")
    ]  # fmt: skip


def test_a_spring_and_a_slider_in_series_go_round_their_loop() -> None:
    """Imposed X (1 - cos(omega t)): it slips 2 L/k after each turn; a loop takes 4 L (X - L/k)."""
    X, omega, k, L = 1.5, 2.0, 2.0, 0.8
    network = jenkins([1 / k], [L], Wave(amplitude=X * omega, frequency=omega / (2 * pi)))
    times, course = _run(network, 3 * pi, 12_001)
    first, later = acos(1 - L / (k * X)) / omega, acos(1 - 2 * L / (k * X)) / omega
    turn = pi / omega
    expected = [(first, "F0", "slip")]
    for at in range(1, 6):
        expected += [(at * turn, "F0", "stick"), (at * turn + later, "F0", "slip")]
    _near(course.events[: len(expected)], *expected)
    loop = (times >= 2 * turn) & (times <= 4 * turn + 1e-9)
    power = course.columns["i_L0"] * X * omega * np.sin(omega * times)
    assert np.trapezoid(power[loop], times[loop]) == pytest.approx(4 * L * (X - L / k), abs=1e-5)


def test_an_opened_inductor_hands_its_current_to_the_diode() -> None:
    network = opened_inductor(10.0, 0.5, 1.0, 2.0, 0.3)
    times, course = _run(network, 1.0)
    _near(course.events, (0.3, "K0", "off"), (0.3, "D0", "on"))
    at_once = 10 * (1 - exp(-0.6))
    expected = np.where(
        times < 0.3, 10 * (1 - np.exp(-2 * times)), at_once * np.exp(-6 * (times - 0.3))
    )
    assert course.columns["i_L0"] == pytest.approx(expected, abs=1e-10)


def test_a_coil_that_is_opened_without_a_diode_loses_its_current_at_once() -> None:
    network = opened_inductor(10.0, 0.5, 1.0, 2.0, 0.3)
    alone = Network(3, network.branches[:4])
    times, course = _run(alone, 1.0)
    assert course.columns["i_L0"][times > 0.3] == pytest.approx(0.0, abs=1e-12)


def test_charges_that_a_switch_joins_add_up() -> None:
    """2 at 3 V and 1 at 0 V; and what contradicts itself at the start does so at once."""
    parts = Branch("C", "C0", 1, 0, 2.0, start=3.0), Branch("C", "C1", 2, 0, 1.0)
    later = joined(*parts, Branch("K", "K0", 1, 2, instants=(0.5,)), Branch("R", "R0", 1, 0, 1e9))
    at_once = joined(*parts, Branch("K", "K0", 1, 2, on=True), Branch("R", "R0", 1, 0, 1e9))
    assert _run(later, 1.0, 3)[1].columns["u_C1"] == pytest.approx([0, 2, 2], abs=1e-6)
    assert _run(at_once, 1.0, 3)[1].columns["u_C1"] == pytest.approx([2, 2, 2], abs=1e-6)


def test_of_two_frictions_in_series_the_weaker_one_slips() -> None:
    """A force of sin(t) on one body; the one behind both frictions never moves."""
    network = joined(
        Branch("C", "C0", 1, 0, 1.0), Branch("F", "F0", 1, 2, 0.5), Branch("F", "F1", 2, 0, 0.7),
        Branch("I", "I0", 0, 1, wave=Wave(amplitude=1.0, frequency=1 / (2 * pi))),
    )  # fmt: skip
    times, course = _run(network, 3.0)
    breaks = asin(0.5)
    assert course.events[0] == pytest.approx((breaks, "F0", "slip"))
    slips = (times > breaks) & (times < 2.5)
    speed = cos(breaks) - np.cos(times[slips]) - 0.5 * (times[slips] - breaks)
    assert course.columns["u_C0"][slips] == pytest.approx(speed, abs=1e-11)
    assert course.columns["u_F1"] == pytest.approx(0.0, abs=1e-12)


def test_two_frictions_side_by_side_hold_what_their_levels_add_up_to() -> None:
    network = joined(
        Branch("C", "C0", 1, 0, 1.0), Branch("F", "F0", 1, 0, 0.5), Branch("F", "F1", 1, 0, 0.2),
        Branch("I", "I0", 0, 1, wave=Wave(amplitude=1.0, frequency=1 / (2 * pi))),
    )  # fmt: skip
    _, course = _run(network, 1.2)
    _near(course.events, (asin(0.7), "F0", "slip"), (asin(0.7), "F1", "slip"))


def test_six_pulses_have_the_mean_of_a_line_voltage_about_its_crest() -> None:
    """3 sqrt(3)/pi of a phase's amplitude; each diode takes over where two phases cross."""
    V, f, R = 325.0, 50.0, 10.0
    times, course = _run(six_pulse(V, f, 0.0, 5e-3, R), 0.04, 4001)
    last = times >= 0.02
    mean = np.trapezoid(course.columns["i_L0"][last], times[last]) / 0.02 * R
    assert mean == pytest.approx(3 * sqrt(3) / pi * V, rel=1e-5)
    changes = sorted({round(t, 9) for t, *_ in course.events})
    assert changes == pytest.approx([(1 / 12 + k / 6) / f for k in range(12)], abs=1e-9)


def test_commutation_takes_what_the_source_inductance_needs() -> None:
    """Overlap u behind Ls with a constant current I: 1 - cos(u) = 2 omega Ls I/(sqrt(3) V)."""
    V, f, R, Ls = 325.0, 50.0, 10.0, 1e-3
    times, course = _run(six_pulse(V, f, 0.0, 100.0, R, Ls, 0.0), 0.02, 2001)
    events = [e for e in course.events if e[0] > 0.006]
    on = next(t for t, _, kind in events if kind == "on")
    off = next(t for t, _, kind in events if kind == "off" and t > on)
    current = float(np.interp((on + off) / 2, times, course.columns["i_L0"]))
    omega = 2 * pi * f
    overlap = acos(1 - 2 * omega * Ls * current / (sqrt(3) * V)) / omega
    assert off - on == pytest.approx(overlap, rel=2e-2)


def test_a_diode_conducts_for_less_than_a_step() -> None:
    """Above 0.9999 a sine is for 0.028 of its radians, where a step is 0.3."""
    short = Wave(-0.9999, amplitude=1.0, frequency=1 / (2 * pi))
    network = joined(
        Branch("V", "V0", 0, 1, wave=short), Branch("D", "D0", 1, 2), Branch("R", "R0", 2, 0, 1.0)
    )
    _, course = _run(network, 120.0, 2)
    first = asin(0.9999)
    turns = [k for k in range(20) if 2 * pi * k + pi - first < 120]
    expected = [
        (2 * pi * k + t, "D0", kind)
        for k in turns
        for t, kind in ((first, "on"), (pi - first, "off"))
    ]
    assert [e[1:] for e in course.events] == [e[1:] for e in expected]
    times = [e[0] for e in course.events]
    assert times == pytest.approx([e[0] for e in expected], abs=1e-8)


def test_a_diode_passes_an_impulse_and_blocks_in_the_same_instant() -> None:
    """Into a capacitor from a source that jumps up and then falls: charged at once, and no event."""
    wave = Wave(0.0, ((0.5, 3.0),), 1.0, 1 / (2 * pi), 2.0)
    network = joined(
        Branch("V", "V0", 0, 1, wave=wave), Branch("D", "D0", 1, 2), Branch("C", "C0", 2, 0, 1.0)
    )
    times, course = _run(network, 3.0)
    assert course.events == []
    charged = np.where(times < 0.5, sin(2.0), 3 + sin(2.5))
    assert course.columns["u_C0"] == pytest.approx(charged, abs=1e-11)


def test_friction_beside_a_dog_that_closes_sticks() -> None:
    """It could as well be said to slip for ever, without a slip."""
    network = joined(
        Branch("C", "C0", 1, 0, 1.0, start=1.0), Branch("F", "F0", 1, 0, 0.1),
        Branch("K", "K0", 1, 0, instants=(0.5,)),
    )  # fmt: skip
    _, course = _run(network, 1.0, 3)
    _near(course.events, (0.5, "F0", "stick"), (0.5, "K0", "on"))
    assert course.columns["u_C0"] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


def test_where_commands_contradict_sources_no_mode_is_consistent() -> None:
    network = joined(
        Branch("V", "V0", 0, 1, wave=Wave(1.0)), Branch("V", "V1", 0, 2, wave=Wave(2.0)),
        Branch("K", "K0", 1, 2, instants=(0.5,)), Branch("R", "R0", 1, 2, 1.0),
    )  # fmt: skip
    with pytest.raises(
        RuntimeError, match=r"no mode is consistent: \(1,\) is impossible by \['K0'"
    ):
        _run(network, 1.0)


def test_a_diode_across_a_closed_switch_is_loose() -> None:
    """Which of them carries the current nothing tells."""
    network = joined(
        Branch("S", "S0", 0, 1, more=1.0, wave=Wave(1.0)),
        Branch("K", "K0", 1, 0, on=True), Branch("D", "D0", 1, 0),
    )  # fmt: skip
    assert _run(network, 1.0)[1].loose == {"D0"}


def test_a_wave_is_what_it_says() -> None:
    wave = Wave(0.5, ((1.0, 2.0),), 3.0, 0.25, 0.1)
    network = joined(Branch("V", "V0", 0, 1, wave=wave), Branch("R", "R0", 1, 0, 2.0))
    times, course = _run(network, 2.0, 5)
    expected = [0.5 + 2.0 * (t >= 1) + 3 * sin(pi / 2 * t + 0.1) for t in times]
    assert course.columns["u_R0"] == pytest.approx(expected, abs=1e-12)
    assert course.columns["i_V0"] == pytest.approx(course.columns["i_R0"], abs=1e-12)


def test_a_voltage_turns_a_switch_with_hysteresis() -> None:
    """RC from 4 V with 1 s, 0.5 s while a resistance of 1 is across: on above 2.5, off below 2.2.

    Alone it goes towards 4, with the resistance towards 2.
    """
    switch = Branch("G", "G0", 1, 2, 2.5, watched="C0", off=2.2)
    network = joined(
        Branch("S", "S0", 0, 1, more=1.0, wave=Wave(4.0)), Branch("C", "C0", 1, 0, 1.0),
        switch, Branch("R", "R0", 2, 0, 1.0),
    )  # fmt: skip
    first = log(4.0 / 1.5)
    falls, rises = 0.5 * log(0.5 / 0.2), log(1.8 / 1.5)
    expected = [first, first + falls, first + falls + rises, first + 2 * falls + rises]
    _, course = _run(network, 2.2)
    kinds = ["on", "off", "on", "off"]
    _near(course.events, *((t, "G0", k) for t, k in zip(expected, kinds, strict=True)))
    # The other way round it is on at first, and the source finds it so.
    other = joined(
        *(b for b in network.branches if b.kind != "G"),
        Branch("G", "G0", 1, 2, -2.2, watched="C0", off=-2.5, sense=-1),
    )
    _, course = _run(other, 2.2)
    assert course.events == []
    assert course.columns["u_C0"][-1] == pytest.approx(2 - 2 * exp(-2 * 2.2), abs=1e-10)

"""A free oscillator with Coulomb friction: its amplitude falls by 2 F_c each half-cycle, then it stops."""

import numpy as np
import pytest
from oracles.energy import misfit
from oracles.models import oscillator

import bondgraph as bg
from codegen import Result, simulator

NUMBERS = [{"m": 1.0, "k": 1.0, "F_c": 0.01}, {"m": 2.3, "k": 517.0, "F_c": 4.1},
           {"m": 0.07, "k": 3e4, "F_c": 55.0}]  # fmt: skip


def _forces_at_rest(start: float, breakaway: float = 1.0) -> list[float]:
    """The spring's force over F_c at each standstill, the last being where it stays."""
    forces = [start]
    while abs(forces[-1]) > breakaway:
        forces.append(2 * np.sign(forces[-1]) - forces[-1])
    return forces


def _expected(times: np.ndarray, values, forces: list[float]) -> np.ndarray:
    """F = s F_c + (F_n - s F_c) cos w (t - t_n) in half-cycle n, s the sign of F_n."""
    w = np.sqrt(values["k"] / values["m"])
    half = np.minimum((times * w / np.pi).astype(int), len(forces) - 1)
    at = np.array(forces)[half]
    moving = half < len(forces) - 1
    phase = np.where(moving, w * times - half * np.pi, 0.0)
    return values["F_c"] * (np.sign(at) + (at - np.sign(at)) * np.cos(phase))


def _run(
    values, start: float, law: object = "F_c", half_cycles: float = 26.3, points=401
) -> Result:
    friction = bg.DryFriction("F_c", 1, law) if law != "F_c" else bg.DryFriction("F_c")
    end = half_cycles * np.pi * np.sqrt(values["m"] / values["k"])
    run = simulator(bg.derive(oscillator(law=friction)), values)
    return run.run(np.linspace(0.0, end, points), {"F": start * values["F_c"]})


@pytest.mark.parametrize("values", NUMBERS)
@pytest.mark.parametrize("start", [45.3, -45.3, 44.9, 2.9, 1.1, 0.9, -0.3])
def test_amplitude_falls_by_the_same_each_half_cycle(values, start: float) -> None:
    result = _run(values, start)
    expected = _expected(result.time, values, _forces_at_rest(start))
    assert result["F"] == pytest.approx(expected, abs=1e-7 * abs(start) * values["F_c"])


@pytest.mark.parametrize("values", NUMBERS)
@pytest.mark.parametrize(("start", "breakaway"), [(45.3, 1), (-44.6, 1), (45.3, 1.5), (20.9, 1.2)])
def test_it_stops_in_the_dead_zone_at_the_right_half_cycle(values, start, breakaway) -> None:
    result = _run(values, start, breakaway)
    forces = _forces_at_rest(start, breakaway)
    assert [event.kind for event in result.events] == ["cross"] * (len(forces) - 2) + ["stick"]
    half = np.pi * np.sqrt(values["m"] / values["k"])
    expected = [half * (n + 1) for n in range(len(forces) - 1)]
    assert [event.time for event in result.events] == pytest.approx(expected, rel=1e-8)
    assert {event.port for event in result.events} == {"ground"}
    still = result.time > result.events[-1].time + 1e-9
    assert still.any()
    assert np.abs(result["slip"][still]).max() < 1e-9 * abs(start) * values["F_c"]
    resting = forces[-1] * values["F_c"]
    assert result["F"][still] == pytest.approx(np.full(still.sum(), resting), rel=1e-6)
    assert result["f"][still] == pytest.approx(-result["F"][still], rel=1e-9)


def test_friction_opposes_the_slip_at_every_sample() -> None:
    result = _run(NUMBERS[1], 45.3)
    slips, friction = result["slip"], result["f"]
    moving = np.abs(slips) > 1e-8
    assert friction[moving] == pytest.approx(4.1 * np.sign(slips[moving]), rel=1e-12)
    assert np.abs(friction).max() <= 4.1 * (1 + 1e-9)


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_every_method_finds_the_same_events(method: str) -> None:
    run = simulator(bg.derive(oscillator()), NUMBERS[0])
    result = run.run(np.linspace(0, 20, 41), {"F": 0.0645}, method=method)
    assert [event.kind for event in result.events] == ["cross"] * 2 + ["stick"]
    assert [event.time for event in result.events] == pytest.approx(
        [np.pi, 2 * np.pi, 3 * np.pi], rel=1e-7
    )


def test_energy_is_conserved_less_what_friction_takes() -> None:
    values = NUMBERS[1]
    run = simulator(bg.derive(oscillator()), values)
    w = np.sqrt(values["k"] / values["m"])
    m, k, F = values["m"], values["k"], values["F_c"]

    def stored(result: Result) -> np.ndarray:
        return m * result["v"] ** 2 / 2 + result["F"] ** 2 / k / 2

    departure = misfit(
        lambda times: run.run(times, {"F": 11.3 * F}), [0.0, 7 * np.pi / w], stored,
        lambda result: -result["f"] * result["slip"],
    )  # fmt: skip
    assert departure < 1e-9


@pytest.mark.parametrize("start", [1.0, -1.0])
def test_at_the_very_edge_of_the_dead_zone_it_stays(start: float) -> None:
    """The spring pulls exactly as much as friction holds."""
    result = _run(NUMBERS[1], start, half_cycles=3.0)
    assert result.events == ()
    assert np.abs(result["v"]).max() < 1e-9


def test_many_more_half_cycles_neither_drift_nor_chatter() -> None:
    result = _run(NUMBERS[0], 120.4, half_cycles=62.0, points=63)
    assert [event.kind for event in result.events] == ["cross"] * 59 + ["stick"]
    expected = _expected(result.time[1:-1] - 1e-9, NUMBERS[0], _forces_at_rest(120.4))
    assert result["F"][1:-1] == pytest.approx(expected, abs=1e-6)

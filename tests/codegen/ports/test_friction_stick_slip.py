"""A block on a surface, pulled through a spring at constant speed: the stick-slip limit cycle."""

from functools import cache

import numpy as np
import pytest
from oracles.energy import misfit
from oracles.models import pulled_block
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Result, simulator

CASES = [
    {"m": 1.0, "k": 4.0, "L": 1.0, "V": 0.2, "ratio": 1.5},
    {"m": 0.4, "k": 90.0, "L": 7.0, "V": -0.3, "ratio": 1.2},
    {"m": 3.0, "k": 20.0, "L": 5.0, "V": 0.9, "ratio": 1.9},
]


class Cycle:
    """Closed form: m v' = F - L, F' = k (V - v) from F = ratio L and v = 0.

    F - L = r sin(w t + phi), k (V - v)/w = r cos(w t + phi), tan(phi) = (ratio - 1) L w/(k V); v = 0
    again at w t = 2 pi - 2 phi, where F - L has changed its sign; then F rises at the rate k V.
    """

    def __init__(self, m: float, k: float, L: float, V: float, ratio: float) -> None:
        self.w, self.L, self.sign = np.sqrt(k / m), L, np.sign(V)
        self.excess, self.pull = (ratio - 1) * L, k * abs(V)
        self.radius = np.hypot(self.excess, self.pull / self.w)
        self.phase = np.arctan2(self.excess, self.pull / self.w)
        self.first = ratio * L / self.pull
        self.slip_time = (2 * np.pi - 2 * self.phase) / self.w
        self.period = self.slip_time + 2 * self.excess / self.pull

    def force(self, t: float) -> float:
        """The spring's force, started without load."""
        if t < self.first:
            return self.sign * self.pull * t
        since = (t - self.first) % self.period
        if since < self.slip_time:
            return self.sign * (self.L + self.radius * np.sin(self.w * since + self.phase))
        return self.sign * (self.L - self.excess + self.pull * (since - self.slip_time))


LAW = bg.DryFriction("L", 1, "ratio")


@cache
def _equations() -> bg.StateEquations:
    return bg.derive(pulled_block(LAW))


def _cycle(values: dict[str, float]) -> tuple[Cycle, Result]:
    return _ran(*values.items())


@cache
def _ran(*told: tuple[str, float]) -> tuple[Cycle, Result]:
    values = dict(told)
    cycle = Cycle(**values)
    end = cycle.first + 4.4 * cycle.period
    numbers = {name: value for name, value in values.items() if name != "V"}
    run = simulator(_equations(), numbers)
    return cycle, run.run(np.linspace(0, end, 301), inputs={"V": values["V"]})


@pytest.mark.parametrize("values", CASES)
def test_events_keep_the_period_of_the_closed_form(values) -> None:
    cycle, result = _cycle(values)
    assert [event.kind for event in result.events] == ["slip", "stick"] * 4 + ["slip"] + (
        ["stick"] if 0.4 * cycle.period > cycle.slip_time else []
    )
    for n, event in enumerate(result.events):
        expected = cycle.first + n // 2 * cycle.period + n % 2 * cycle.slip_time
        assert event.time == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("values", CASES)
def test_the_spring_force_follows_the_closed_form(values) -> None:
    cycle, result = _cycle(values)
    expected = [cycle.force(t) for t in result.time.tolist()]
    assert result["F"] == pytest.approx(expected, abs=1e-7 * cycle.L)
    assert np.abs(result["F"]).max() <= cycle.L + cycle.radius + 1e-7
    stuck = np.abs(result["f"]) > cycle.L * (1 + 1e-9)
    assert np.abs(result["slip"][stuck]).max() < 1e-9


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("values", CASES)
def test_power_is_balanced(values) -> None:
    cycle = Cycle(**values)
    numbers = {name: value for name, value in values.items() if name != "V"}
    run = simulator(_equations(), numbers)
    departure = misfit(
        lambda times: run.run(times, inputs={"V": values["V"]}),
        [0.0, cycle.first + 2.3 * cycle.period],
        lambda r: values["m"] * r["v"] ** 2 / 2 + r["F"] ** 2 / values["k"] / 2,
        lambda r: r["F"] * r["V"] - r["f"] * r["slip"],
    )
    assert departure < 1e-9


STRIBECK = {"m": 1.0, "k": 40.0, "L": 3.0, "v_s": 0.05, "a": 0.4, "b": 0.8, "V": 0.11}
CURVE = "1 + a*exp(-slip/v_s) + b*slip"


def _tight_stribeck(start: tuple[float, float], end: float) -> tuple[list[float], list[np.ndarray]]:
    """Event times and dense solutions of the slipping phases, by scipy, sticking phases by hand."""
    p = STRIBECK
    release = 1.7 * p["L"]

    def rate(t: float, y: np.ndarray) -> list[float]:
        f = p["L"] * (1 + p["a"] * np.exp(-y[0] / p["v_s"]) + p["b"] * y[0])
        return [(y[1] - f) / p["m"], p["k"] * (p["V"] - y[0])]

    def stops(t: float, y: np.ndarray) -> float:
        return float(y[0]) if t > 1e-6 else 1.0

    stops.terminal, stops.direction = True, -1
    t, F, events, phases = start[0], start[1], [], []
    while (t := t + (release - F) / (p["k"] * p["V"])) < end:
        found = solve_ivp(rate, (0.0, 9.0), [0.0, release], "DOP853", rtol=1e-12, atol=1e-14,
                          events=stops, dense_output=True)  # fmt: skip
        phases.append((t, found.t[-1], found.sol))
        events += [t, t + found.t[-1]]
        t, F = t + found.t[-1], found.y[1, -1]
    return events, phases


def test_stribeck_curve_with_a_higher_breakaway() -> None:
    """Breakaway 1.7 above the curve's own 1.4 at rest."""
    run = simulator(
        bg.derive(pulled_block(bg.DryFriction("L", CURVE, "17/10"))),
        {name: value for name, value in STRIBECK.items() if name != "V"},
    )
    times = np.linspace(0, 5, 501)
    result = run.run(times, inputs={"V": STRIBECK["V"]})
    events, phases = _tight_stribeck((0.0, 0.0), 5.0)
    expected = [time for time in events if time < 5.0]
    assert len(expected) >= 6
    assert [event.time for event in result.events] == pytest.approx(expected, rel=1e-8)
    for begin, length, solution in phases:
        inside = (times > begin + 1e-6) & (times < min(begin + length, 5.0))
        v, F = solution(times[inside] - begin)
        assert result["v"][inside] == pytest.approx(v, abs=1e-7)
        assert result["F"][inside] == pytest.approx(F, abs=1e-7)


def test_viscous_curve_damps_stick_slip_away() -> None:
    """With enough damping in the curve the block follows steadily: F = L (1 + b V)."""
    law = bg.DryFriction("L", "1 + b*slip", "6/5")
    run = simulator(bg.derive(pulled_block(law)), {"m": 1.0, "k": 40.0, "L": 3.0, "b": 8.0})
    result = run.run(np.linspace(0, 20, 81), inputs={"V": 0.3})
    assert [event.kind for event in result.events] == ["slip"]
    assert result["F"][-1] == pytest.approx(3.0 * (1 + 8.0 * 0.3), rel=1e-8)
    assert result["v"][-1] == pytest.approx(0.3, rel=1e-8)

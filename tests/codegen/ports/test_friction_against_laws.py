"""Ports that hold against what a law of states gives: its slope in time is part of what holds them."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Sine, simulator

T = np.linspace(0.0, 2.0, 41)
M, LEVEL = 0.8, 1.0
ENGINES = [(backend, method) for backend in ("numpy", "c") for method in ("auto", "DOP853")]


def rubbing(law: str) -> bg.StateEquations:
    """A mass that P pushes, on a belt that a law lets move."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("z"),
             bg.R("belt", law=law, gives="flow", flow="belt_v"),
             bg.R("rub", effort="F", law=bg.DryFriction("L"))]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>z z>belt z>rub"))


Belt = Callable[[float, float], float]


def by_hand(belt: Belt, stuck: Belt, push: Callable[[float], float]) -> tuple[np.ndarray, list]:
    """The mass by scipy alone: m v' = P - L sgn(v - w), or v' as it sticks while |P - m v'| <= L.

    ``stuck``: v' over t and v, from v' = d/dt w(v, t) by hand.
    """
    t, v, found, events = 0.0, 0.0, [0.0], []
    load = push(t) - M * stuck(t, v)
    mode = -float(np.sign(belt(t, v))) or (float(np.sign(load)) if abs(load) > LEVEL else 0.0)
    while t < T[-1]:
        way = mode

        def rate(t: float, y: Sequence[float], way: float = way) -> list[float]:
            return [(push(t) - way * LEVEL) / M if way else stuck(t, y[0])]

        def gone(t: float, y: Sequence[float], way: float = way) -> float:
            return y[0] - belt(t, y[0]) if way else LEVEL - abs(push(t) - M * stuck(t, y[0]))

        gone.terminal, gone.direction = True, -way if way else -1
        after = T[t + 1e-12 < T]
        run = solve_ivp(rate, (t, T[-1]), [v], "DOP853", after, events=gone, rtol=1e-12, atol=1e-13,
                        max_step=2e-3)  # fmt: skip
        found += run.y[0].tolist()
        if run.status != 1:
            break
        t, v = float(run.t_events[0][0]), float(run.y_events[0][0][0])
        events.append(t)
        load = push(t) - M * stuck(t, v)
        mode = 0.0 if way and abs(load) <= LEVEL else -way or float(np.sign(load))
    return np.array(found), events


W = 1.2 * np.pi
"""Of the input q that only the law reads [rad/s]."""

BELTS: dict[str, tuple[str, Belt, Belt]] = {
    "state": (
        "sin(v)/2 + sin(3*t)/4", lambda t, v: np.sin(v) / 2 + np.sin(3 * t) / 4,
        lambda t, v: 0.75 * np.cos(3 * t) / (1 - np.cos(v) / 2),
    ),
    "input": (
        "tanh(v)*q/2 + q", lambda t, v: np.sin(W * t) * (np.tanh(v) / 2 + 1),
        lambda t, v: W * np.cos(W * t) * (np.tanh(v) / 2 + 1)
        / (1 - np.sin(W * t) / 2 / np.cosh(v) ** 2),
    ),
    "affine": (
        "q - v/2", lambda t, v: np.sin(W * t) - v / 2,
        lambda t, v: W * np.cos(W * t) / 1.5,
    ),
    "loop": (
        "v**2/8 + q - belt_v/2", lambda t, v: (v**2 / 8 + np.sin(W * t)) / 1.5,
        lambda t, v: W * np.cos(W * t) / 1.5 / (1 - v / 6),
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=BELTS)
def belt(request: pytest.FixtureRequest) -> tuple[bg.StateEquations, dict, np.ndarray, list]:
    law, value, stuck = BELTS[request.param]
    v, events = by_hand(value, stuck, lambda t: 1.2 * np.sin(np.pi * t))
    inputs = {"P": Sine(1.2, 0.5)} | ({"q": Sine(1.0, 0.6)} if "q" in law else {})
    return rubbing(law), inputs, v, events


@pytest.mark.parametrize(("backend", "method"), ENGINES)
def test_it_sticks_to_what_a_law_lets_move(belt: tuple, backend: str, method: str) -> None:
    equations, inputs, v, events = belt
    ready = simulator(equations, {"m": M, "L": LEVEL}, backend=backend)
    run = ready.run(T, {}, inputs, method, 1e-11, 1e-13)
    assert run["v"] == pytest.approx(v, abs=2e-9)
    assert [event.time for event in run.events] == pytest.approx(events, abs=1e-8)
    assert len(events) >= 2


STORED = {
    "affine": ("p_a/2", lambda p: p / 2, lambda p: 0.5),
    "nonlinear": ("p_a/2 + p_a**3/10", lambda p: p / 2 + p**3 / 10, lambda p: 0.5 + 0.3 * p**2),
}
"""Speeds by a momentum, and their slopes."""


def _two_masses(speed: Callable, slope: Callable) -> tuple[np.ndarray, list]:
    """p' = P - F, w' = F: F = v'(p) P/(1 + v'(p)) as they stick, while that is at most 1/2."""

    def push(t: float) -> float:
        return 2 * np.sin(2 * np.pi * t)

    def held(t: float, p: float) -> float:
        return slope(p) * push(t) / (1 + slope(p))

    t, y, way, found, events = 0.0, [0.0, 0.0], 0.0, [0.0], []
    while t < T[-1]:

        def rate(t: float, y: Sequence[float], way: float = way) -> list[float]:
            F = way / 2 or held(t, y[0])
            return [push(t) - F, F]

        def gone(t: float, y: Sequence[float], way: float = way) -> float:
            return speed(y[0]) - y[1] if way else 0.5 - abs(held(t, y[0]))

        gone.terminal, gone.direction = True, -way if way else -1
        run = solve_ivp(rate, (t, T[-1]), y, "DOP853", T[t + 1e-12 < T], events=gone, rtol=1e-12,
                        atol=1e-13, max_step=2e-3)  # fmt: skip
        found += run.y[1].tolist()
        if run.status != 1:
            break
        t, y = float(run.t_events[0][0]), run.y_events[0][0].tolist()
        events.append(t)
        load = held(t, y[0])
        way = 0.0 if way and abs(load) <= 0.5 else float(np.sign(load))
    return np.array(found), events


@pytest.mark.parametrize(("backend", "method"), ENGINES)
@pytest.mark.parametrize("name", STORED)
def test_a_nonlinear_inertia_rubs_on_another_mass(name: str, backend: str, method: str) -> None:
    law, speed, slope = STORED[name]
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("a", flow="v", law=law), bg.Zero("z"),
             bg.R("rub", law=bg.DryFriction("L")), bg.One("other"), bg.I("b", 1, flow="w")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n n>a n>z z>rub z>other>b"))
    run = simulator(equations, {"L": 0.5}, backend=backend).run(
        T, {}, {"P": Sine(2.0, 1.0)}, method, 1e-11, 1e-13
    )
    w, events = _two_masses(speed, slope)
    assert run["w"] == pytest.approx(w, abs=2e-9)
    assert [event.time for event in run.events] == pytest.approx(events, abs=1e-8)
    assert len(events) > 4

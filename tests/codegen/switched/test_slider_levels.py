"""Levels of friction that gives a flow: any law of states, inputs and the time, and down to zero."""

import math
from functools import lru_cache

import numpy as np
import pytest
from oracles.exported import loaded
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp, Signal, Sine, Step, simulator, to_python

T = np.linspace(0.0, 2.0, 81)
K = 10.0
ENGINES = [(backend, method) for backend in ("numpy", "c") for method in ("auto", "DOP853")]


def pulled(level: str, tank: bool = True) -> bg.StateEquations:
    """A spring pulled at v, directly on a slider; beside it a tank that q fills to the pressure p."""
    nodes = [bg.Sf("speed", "v"), bg.One("j"), bg.Zero("z"), bg.C("spring", "1/k", effort="F_k"),
             bg.R("a", effort="F_a", flow="s_a", law=bg.DryFriction(level))]  # fmt: skip
    beside = [bg.Zero("tank"), bg.C("volume", 1, effort="p"), bg.Sf("fill", "q")] if tank else []
    bonds = " fill>tank>volume" if tank else ""
    return bg.derive(bond_graph([*nodes, *beside], f"speed>j j>z z>spring z>a{bonds}"))


def _levels() -> dict[str, tuple[str, dict[str, Signal | float]]]:
    """Levels of p = 1 - t, of the force itself, of inputs that only the level reads, and of the time."""
    return {
        "square": ("1 + p**2", {"v": 1.0}),
        "input": ("1 + w*p**2 + w**2", {"v": Sine(2.0, 0.5), "w": Sine(0.5, 0.3)}),
        "time": ("2 + sin(3*t)*exp(-p)", {"v": Sine(2.0, 0.5)}),
        "own force": ("1 + F_k**2/50 + p/5", {"v": Sine(2.0, 0.5)}),
        "corner": ("1 + Abs(p)", {"v": 1.0}),
        "largest": ("Max(1/2, p)", {"v": 1.0}),
    }


LEVELS = _levels()


@lru_cache
def _by_hand(name: str) -> np.ndarray:
    """The force: F' = k v sticking; slipping it is the level, whose own slope must let it slip."""
    inputs = LEVELS[name][1]

    def level(t: float, F: float) -> float:
        p, w = 1 - t, 0.5 * math.sin(0.6 * math.pi * t)
        return {
            "square": 1 + p**2, "input": 1 + w * p**2 + w**2, "time": 2 + math.sin(3 * t) * math.exp(-p),
            "own force": 1 + F**2 / 50 + p / 5, "corner": 1 + abs(p), "largest": max(0.5, p),
        }[name]  # fmt: skip

    def speed(t: float) -> float:
        return 1.0 if inputs["v"] == 1.0 else 2 * math.sin(math.pi * t)

    # Steps so short that the force is kept within its level as an operator of play: error of order h.
    fine = np.linspace(0.0, 2.0, 80 * 200 + 1)
    h, F, found = fine[1] - fine[0], 0.0, [0.0]
    for at, t in enumerate(fine[1:].tolist(), start=1):
        F += K * h * speed(t - h / 2)
        for _ in range(3):
            most = level(t, F)
            F = min(max(F, -most), most)
        if at % 200 == 0:
            found.append(F)
    return np.array(found)


@pytest.mark.parametrize("name", LEVELS)
@pytest.mark.parametrize(("backend", "method"), ENGINES)
def test_the_force_is_kept_within_a_level_of_any_kind(name: str, backend: str, method: str) -> None:
    level, inputs = LEVELS[name]
    ready = simulator(pulled(level), {"k": K}, backend=backend)
    run = ready.run(T, {"p": 1.0}, {"q": -1.0, **inputs}, method, 1e-10, 1e-12)
    assert run["F_a"] == pytest.approx(_by_hand(name), abs=2e-3)


@pytest.mark.parametrize(("backend", "method"), ENGINES)
def test_a_square_is_followed_to_the_last_digits(backend: str, method: str) -> None:
    """F = 10 t until it is 1 + (1 - t)^2, at t = 6 - sqrt(34); then that, slipping at 1 - F'/k."""
    ready = simulator(pulled("1 + p**2"), {"k": K}, backend=backend)
    run = ready.run(T, {"p": 1.0}, {"q": -1.0, "v": 1.0}, method, 1e-11, 1e-13)
    begins = 6 - np.sqrt(34)
    slips = begins < T
    assert run["F_a"] == pytest.approx(np.where(slips, 1 + (1 - T) ** 2, 10 * T), abs=1e-9)
    assert run["s_a"] == pytest.approx(np.where(slips, 1 + 2 * (1 - T) / K, 0), abs=1e-9)
    (event,) = run.events
    assert (event.port, event.kind) == ("a", "slip")
    assert event.time == pytest.approx(begins, abs=1e-9)
    audit = run.audit()
    assert abs(audit.residual) < 1e-8 * audit.turned_over
    assert set(run) == {"F_k", "p", "v", "q", "e_speed", "e_fill", "F_a", "s_a"}


def test_exported_python_follows_it_in_fixed_steps() -> None:
    equations, numbers, inputs = pulled("1 + p**2"), {"k": K}, {"q": -1.0, "v": 1.0}
    known = np.where(6 - np.sqrt(34) > T, 10 * T, 1 + (1 - T) ** 2)
    run = loaded(to_python(equations, numbers)).simulate(T, {"p": 1.0}, inputs, step=4e-3)
    assert run["F_k"] == pytest.approx(known, abs=8e-2)
    assert run["F_k"][T > 0.3] == pytest.approx(known[T > 0.3], abs=4e-4)


def emptied(level: str = "p") -> bg.StateEquations:
    """The same with a mass that the friction is on: dry friction that gives its effort."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", 1, flow="v"), bg.Zero("tank"),
             bg.R("a", effort="F_a", law=bg.DryFriction(level)), bg.C("volume", 1, effort="p"),
             bg.Sf("fill", "q")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>a fill>tank>volume"))


@pytest.mark.parametrize(("backend", "method"), ENGINES)
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_a_run_may_end_where_a_state_brings_the_level_down_to_zero(
    backend: str, method: str, speed: float
) -> None:
    """p = 2 - t at the end of 2 s: nothing follows in which the level would be below zero."""
    ready = simulator(pulled("p"), {"k": K}, backend=backend)
    run = ready.run(T, {"p": 2.0}, {"q": -1.0, "v": speed}, method)
    assert run["F_a"] == pytest.approx(np.minimum(K * speed * T, 2 - T), abs=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("push", [0.0, Ramp(0.0, -1.0, 2.0)])
def test_so_may_one_on_a_mass(backend: str, push: Signal | float) -> None:
    """Held by as much as pushes it: nothing, or all that the level allows."""
    run = simulator(emptied(), {}, backend=backend).run(T, {"p": 2.0}, {"q": -1.0, "P": push})
    assert run["F_a"] == pytest.approx(0 * T if push == 0.0 else 2 - T, abs=1e-8)
    assert run["v"] == pytest.approx(0 * T, abs=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_run_that_goes_on_below_zero_is_refused(backend: str) -> None:
    ready = simulator(pulled("p"), {"k": K}, backend=backend)
    with pytest.raises(bg.SimulationError, match=r"must not be negative.*by low=0"):
        ready.run(np.linspace(0, 2.01, 5), {"p": 2.0}, {"q": -1.0, "v": 1.0})


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("level", ["Abs(w)", "Max(0, w)", "w**2"])
def test_an_input_may_bring_the_level_to_zero_and_on(backend: str, level: str) -> None:
    """w = 1 - t, pulled at 1 m/s: the force stays at the level once it has come to it."""
    ready = simulator(pulled(level, tank=False), {"k": K}, backend=backend)
    run = ready.run(T, {}, {"v": 1.0, "w": Ramp(0.0, -1.0, 1.0)})
    w = 1 - T
    known = {"Abs(w)": abs(w), "Max(0, w)": np.maximum(w, 0), "w**2": w**2}[level]
    assert run["F_a"] == pytest.approx(np.minimum(K * T, known), abs=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_level_falls_to_zero_and_rises_again(backend: str) -> None:
    """Emptied until 1 s and filled again; Max(0, p - 1/2) is zero between 1/2 and 3/2 s."""
    inputs = {"v": 1.0, "q": Step(1.0, 1.0, -1.0)}
    p = abs(1 - T)
    for level, known in (("p", p), ("Max(0, p - 1/2)", np.maximum(p - 0.5, 0))):
        run = simulator(pulled(level), {"k": K}, backend=backend).run(T, {"p": 1.0}, inputs)
        assert run["F_a"] == pytest.approx(np.minimum(K * T, known), abs=1e-8)

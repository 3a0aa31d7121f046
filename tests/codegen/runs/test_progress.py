"""Runs that slide along a jump of which no port is made are refused after a bounded number of steps, the
same way in numpy and C; what only crosses jumps, however often, is run."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.alone import located
from references.build import bond_graph

import bondgraph as bg
import codegen.runs.progress as counted
from codegen import simulator
from codegen.runs.arguments import settings_of, signals_for
from codegen.tuning import TUNING

REFUSED = (
    r"at t = {}\d* the integrator no longer advances: the rates jump there.*DryFriction, a switch"
)

#: Laws that jump where nothing tells the sides apart, at a mass of 1 that F = 0.2 pushes; where v starts,
#: and the time at which it comes to the jump.
SLIDES = [
    ("atan2(f_r - 1/2, 0)", 1.0, 0.5 / (np.pi / 2 - 0.2)),
    ("(2 + f_r)*sign(f_r - 1/2)", 1.0, float(np.log(2.8 / 2.3))),
]  # fmt: skip


def _mass(law: object) -> bg.StateEquations:
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.R("r", law=law)]
    return bg.derive(bond_graph(nodes, "F>j>m j>r"))


def _near(time: float) -> str:
    """The first digits of a time that is refused a little later."""
    return REFUSED.format(str(f"{time + 1e-9:.9f}")[:7].rstrip("0").replace(".", r"\."))


@pytest.mark.parametrize("method", ["auto", "Radau"])
@pytest.mark.parametrize(("law", "start", "time"), SLIDES)
def test_a_state_that_slides_along_a_jump_is_refused_soon(law, start, time, method) -> None:
    run = simulator(_mass(law), {})
    calls = 0
    rates = run.closed.rates

    def watched(*arguments):
        inner = rates(*arguments)

        def rate(t, s):
            nonlocal calls
            calls += 1
            return inner(t, s)

        return rate

    object.__setattr__(run.closed, "rates", watched)
    with pytest.raises(bg.SimulationError, match=_near(time)):
        run.run([0.0, 1.5], {"v": start}, {"F": 0.2}, method=method)
    # A step with its rejected attempts takes some 30 evaluations; 600 of them, and those before.
    assert calls < 30_000


@pytest.mark.parametrize("method", ["auto", "Radau"])
def test_c_comes_back_and_the_run_is_refused_the_same_way(method: str) -> None:
    law, start, time = SLIDES[0]
    run = simulator(_mass(law), {}, backend="c")
    signals = signals_for({"F": 0.2}, run.inputs)
    times = np.array([0.0, 1.0, 2.0])
    settings = settings_of(method, 1e-10, 1e-11)
    stopped = located(run.located, times, np.array([start]), signals, settings)
    assert "the integrator no longer advances" in stopped.reason
    assert stopped.time == pytest.approx(time, abs=1e-6)
    with pytest.raises(bg.SimulationError, match=_near(time)):
        run.run(times, {"v": start}, {"F": 0.2}, method=method)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_jumps_that_are_crossed_are_no_sliding(backend: str) -> None:
    """``v' = -v - sign(sin(w t))`` from the steady cycle: half a period T apart v is -+tanh(T/2)."""
    half = 0.01
    run = simulator(_mass(f"f_r + sign(sin(pi_*t/{half}))"), {"pi_": float(np.pi)}, backend=backend)
    edge = np.tanh(half / 2)
    times = np.array([0.0, 10 * half, 21 * half, 31 * half])
    result = run.run(times, {"v": edge}, {"F": 0.0})
    assert result.backend == backend
    assert result["v"] == pytest.approx([edge, edge, -edge, -edge], abs=1e-8)


def test_many_steps_at_a_jump_that_is_crossed_are_no_sliding(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Even where every few steps count as none: beyond the jump nothing pushes back."""
    eager = replace(TUNING, short=1e9, shorter=0.0, lot=5)
    monkeypatch.setattr(counted, "TUNING", eager)
    run = simulator(_mass("f_r + sign(sin(t/2) - 1/5)"), {})
    result = run.run([0.0, 1.0, 3.0], {"v": 1.0}, {"F": 0.0})
    # v' = 1 - v until sin(t/2) = 1/5, then v' = -1 - v.
    at = 2 * np.arcsin(0.2)
    assert result["v"] == pytest.approx(
        [1.0, 2 * np.exp(at - 1) - 1, 2 * np.exp(at - 3) - 1], abs=1e-8
    )


def test_rates_that_grow_without_bound_are_refused() -> None:
    """``v' = v**3``: infinite at 1/2 s."""
    with pytest.raises(
        bg.SimulationError, match=r"at t = 0\.5 the integrator no longer advances: .*grow"
    ):
        simulator(_mass("-f_r**3"), {}).run([0.0, 1.0], {"v": 1.0}, {"F": 0.0})

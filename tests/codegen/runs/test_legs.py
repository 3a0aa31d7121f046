"""One smooth stretch: methods, step bounds, samples, failures."""

import numpy as np
import pytest
from oracles.models import block, oscillator
from references.build import bond_graph

import bondgraph as bg
from codegen import Step, simulator


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("points", [2, 3, 1001])
def test_every_point_is_sampled_once_whatever_the_grid(method: str, points: int) -> None:
    run = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1.0, "F_c": 0.01})
    times = np.linspace(0, 4 * np.pi, points)
    result = run.run(times, {"F": 1.0}, method=method)
    n = np.minimum((times / np.pi + 1e-9).astype(int), 4)
    level = np.array([1.0, -0.98, 0.96, -0.94, 0.92])[n]
    expected = 0.01 * np.sign(level) + (level - 0.01 * np.sign(level)) * np.cos(times - n * np.pi)
    assert result["F"] == pytest.approx(expected, abs=1e-8)


def test_stiffness_of_a_nonlinear_law_that_grows_is_noticed_on_the_way() -> None:
    """A spring that hardens with the fifth power: slow at first, thousandfold faster at the turn."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law="q_s**5")]
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>s")), {})
    result = run.run(np.linspace(0, 3, 301), {"v": 50.0})
    energy = result["v"] ** 2 / 2 + result["q_s"] ** 6 / 6
    assert energy == pytest.approx(np.full(301, 1250.0), rel=1e-7)
    assert np.abs(result["q_s"]).max() <= 7500 ** (1 / 6) * (1 + 1e-7)


def test_slow_models_take_few_evaluations_and_stay_exact_over_long_times() -> None:
    """A time constant of 1e5 s over 1e6 s."""
    nodes = [bg.Zero("n"), bg.C("c", 1e5, effort="v"), bg.R("r", 1)]
    run = simulator(bg.derive(bond_graph(nodes, "n>c n>r")), {})
    times = np.linspace(0, 1e6, 11)
    assert run.run(times, {"v": 1.0})["v"] == pytest.approx(np.exp(-times / 1e5), abs=1e-9)


def test_very_short_runs_are_as_good() -> None:
    run = simulator(bg.derive(oscillator()), {"m": 1e-12, "k": 1.0, "F_c": 0.01})
    times = np.linspace(0, 4e-6 * np.pi, 41)
    result = run.run(times, {"F": 1.0})
    assert [e.time for e in result.events[:3]] == pytest.approx(
        1e-6 * np.pi * np.arange(1, 4), rel=1e-8
    )


@pytest.mark.parametrize("at", [0.3, 0.3 + 1e-13, 0.7])
def test_a_breakpoint_next_to_an_event_is_no_trouble(at: float) -> None:
    """The mass comes to rest at 0.3, where the push also steps (or just after)."""
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 2.0})
    result = run.run(np.linspace(0, 1, 11), {"v": 0.6}, {"P": Step(at, 5.0)})
    assert result["v"][-1] == pytest.approx(3.0 * (1 - at), abs=1e-9)
    # At the very instant of the step the mass may just go on without having stuck.
    assert all(0.3 - 1e-9 < event.time < at + 1e-9 for event in result.events)


def test_a_run_may_end_on_an_event_or_a_breakpoint() -> None:
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 2.0})
    on_event = run.run([0.0, 0.1, 0.3], {"v": 0.6}, {"P": 0.0})
    assert on_event["v"] == pytest.approx([0.6, 0.4, 0.0], abs=1e-10)
    on_break = run.run([0.0, 0.5, 1.0], inputs={"P": Step(1.0, 5.0)})
    assert on_break["P"].tolist() == [0.0, 0.0, 5.0]
    assert on_break["f"] == pytest.approx([0.0, 0.0, 2.0])
    assert not on_break["v"].any()


def test_rates_that_are_not_finite_end_the_run_with_time_and_state() -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="1/(v - 1)"), bg.Se("p", "P")]
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>r p>n")), {})
    with pytest.raises(
        bg.SimulationError, match=r"at t = 0 (a law has no value|the rates are not finite)"
    ):
        run.run([0.0, 1.0], {"v": 1.0}, {"P": 0.0})


@pytest.mark.parametrize("method", ["DOP853", "exact"])
def test_samples_inside_a_stretch_of_rounding_are_recorded(method: str) -> None:
    """Half a microsecond between samples, long after the epoch: a few roundings of the time."""
    times = [1.7e9 + k * 5e-7 for k in range(4)]
    ready = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1.0})
    run = ready.run(times, {"v": 0.3}, {"P": 0.0}, method=method)
    assert run["v"] == pytest.approx([0.3 - (t - times[0]) for t in times], abs=2e-6)

"""SUNDIALS beside the exact method: CVODE in the event loop, IDA on the descriptor form without A^-1."""

import sys

import numpy as np
import pytest
from oracles.descriptor import Descriptor
from oracles.models import block, oscillator
from references.build import bond_graph

import bondgraph as bg
from codegen import Lag, Result, Simulator, Sine, Step, simulator
from codegen.runs.sundials import Cvode
from differentials.prepared import Prepared
from differentials.scenarios import prepared

CATALOG = [
    ("alsd", "fig11"),
    ("alsd", "fig12_20_1"),
    ("alsd", "fig12_80_1"),
    ("stationary_tvd", "fig13"),
    ("four_wheel_drive_tvd", "fig14"),
]
Exact = tuple[Prepared, Simulator, Result]


@pytest.fixture(scope="module", params=CATALOG, ids=lambda case: case[1])
def exact(request: pytest.FixtureRequest) -> Exact:
    case = prepared(*request.param)
    run = simulator(case.equations, case.parameters, case.laws)
    return case, run, run.run(case.times, case.initial, case.inputs, method="exact")


@pytest.mark.usefixtures("closely")
def test_cvode_agrees_with_the_exact_method(exact: Exact) -> None:
    case, run, expected = exact
    found = run.run(case.times, case.initial, case.inputs, method="CVODE")
    assert [event[1:] for event in found.events] == [event[1:] for event in expected.events]
    for event, other in zip(found.events, expected.events, strict=True):
        assert event.time == pytest.approx(other.time, abs=1e-9)
    for name in run.states:
        assert found[name] == pytest.approx(expected[name], abs=6e-8 * np.ptp(expected[name]))


def test_the_descriptor_form_agrees_with_the_exact_method(exact: Exact) -> None:
    case, run, expected = exact
    model = Descriptor(case.equations, case.parameters, case.laws, case.inputs)
    found, apart = model.follow(case.times, case.initial, expected.events)
    assert np.abs(apart).max(initial=0.0) < 1e-7
    for name, values in zip(run.states, found.T, strict=True):
        assert values == pytest.approx(expected[name], abs=1e-6 * np.ptp(expected[name]))


def test_the_descriptor_form_of_a_source_that_drives_a_dependent_storage() -> None:
    """(C_1 + C_2) v' = C_2 V' - v/R: the source's rate enters by E."""
    nodes = [bg.Se("source", "V"), bg.One("loop"), bg.Zero("n"), bg.C("c", "C_1", effort="v"),
             bg.C("d", "C_2", priority=-1), bg.R("leak", "R")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "source>loop loop>d loop>n n>c n>leak"))
    assert equations.E.todok()
    values, V = {"C_1": 0.02, "C_2": 0.03, "R": 40.0}, Sine(3.0, 2.0)
    times = np.linspace(0.0, 4.0, 41)
    run = simulator(equations, values).run(times, {"v": 0.5}, {"V": V})
    found, _ = Descriptor(equations, values, {}, {"V": V}).follow(times, {"v": 0.5}, ())
    assert found[:, 0] == pytest.approx(run["v"], abs=1e-7)


def test_events_of_a_rubbing_oscillator_are_located() -> None:
    """Each half swing loses 2 F_c; it comes to rest where the spring no longer moves it."""
    run = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1.0, "F_c": 0.1})
    times = np.linspace(0, 5 * np.pi, 101)
    result = run.run(times, {"F": 0.55}, method="CVODE")
    assert [event.kind for event in result.events] == ["cross", "cross", "stick"]
    assert [event.time for event in result.events] == pytest.approx(
        np.pi * np.arange(1, 4), abs=1e-8
    )
    assert result["F"][-1] == pytest.approx(0.05, abs=1e-9)


def test_a_law_that_turns_stiff_on_the_way() -> None:
    """v' = -tanh(v/eps): sinh(v/eps) = sinh(v_0/eps) exp(-t/eps), a line down to a rate of 1/eps."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="tanh(v/eps)")]
    eps, times = 1e-6, np.linspace(0, 2, 41)
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>r")), {"eps": eps})
    found = run.run(times, {"v": 1.0}, method="CVODE")["v"]
    left = (1 - times) / eps
    expected = eps * np.arcsinh(np.exp(np.minimum(left, 700.0)) / 2)
    expected = np.where(left > 700, 1 - times, expected)
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_stiff_affine_model_takes_few_steps(monkeypatch) -> None:
    """A microsecond's time constant behind a sine of a second: 2e5 steps with Adams's formulas."""
    left, step = iter(range(5000)), Cvode.step
    monkeypatch.setattr(Cvode, "step", lambda solver: (next(left), step(solver))[1])
    nodes = [bg.Se("s", "V"), bg.One("loop"), bg.R("r", 1e-6), bg.C("c", 1, effort="v")]
    run = simulator(bg.derive(bond_graph(nodes, "s>loop>r loop>c")), {})
    times = np.linspace(0, 3, 31)
    result = run.run(times, {"v": 1.0}, {"V": Sine(1.0, 1.0)}, method="CVODE")
    steady = np.exp(2j * np.pi * times) / (1 + 2j * np.pi * 1e-6)
    expected = steady.imag + (1 - steady[0].imag) * np.exp(-times / 1e-6)
    assert result["v"] == pytest.approx(expected, abs=1e-9)


@pytest.mark.usefixtures("closely")
def test_a_law_that_owns_a_state() -> None:
    """A hardening spring keeps its energy; its displacement is the law's."""
    nodes = [bg.One("n"), bg.I("m", "m", flow="v"), bg.C("s", law="k*q_s + c*q_s**3")]
    m, k, c = 1.3, 4.0, 9.0
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>s")), {"m": m, "k": k, "c": c})
    result = run.run(np.linspace(0, 6, 121), {"q_s": 1.1, "v": -0.4}, method="CVODE")
    q, v = result["q_s"], result["v"]
    energy = m * v**2 / 2 + k * q**2 / 2 + c * q**4 / 4
    start = m * 0.4**2 / 2 + k * 1.1**2 / 2 + c * 1.1**4 / 4
    assert energy == pytest.approx(np.full(len(q), start), rel=1e-8)


def test_breakpoints_and_lags_of_inputs() -> None:
    """m v' = P: a step through a lag adds up to P_0 (t - lag (1 - exp(-t/lag)))."""
    run = simulator(bg.derive(block()), {"m": 2.0, "F_c": 0.0})
    times = np.linspace(0, 1, 21)
    result = run.run(times, {"v": 1.0}, {"P": Lag(Step(0.3, 4.0), 0.05)}, method="CVODE")
    after = np.maximum(times - 0.3, 0.0)
    expected = 1.0 + 2.0 * (after - 0.05 * (1 - np.exp(-after / 0.05)))
    assert result["v"] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("formulas", "order"), [("BDF", 5), ("Adams", 5)])
def test_tolerances_are_honoured_step_by_step(formulas: str, order: int) -> None:
    """A hundred times the tolerance: so many more steps, and errors that follow it."""
    steps, errors = [], []
    for rtol in (1e-6, 1e-8):
        solver = Cvode(
            formulas, lambda t, y: np.array([y[1], -y[0]]), 0.0, np.array([1.0, 0.0]), 20.0,
            rtol=rtol, atol=rtol, max_step=1.0,
        )  # fmt: skip
        worst, count = 0.0, 0
        while solver.status == "running":
            assert solver.step() is None
            assert solver.t > solver.t_old
            t = np.linspace(solver.t, solver.t_old, 5)
            inside = solver.dense_output()(t)
            worst = max(worst, np.abs(inside - [np.cos(t), -np.sin(t)]).max())
            assert inside[:, 0] == pytest.approx(solver.y, abs=1e-14)
            count += 1
        assert solver.t == 20.0
        steps.append(count)
        errors.append(worst)
        assert worst < 20 * rtol
    assert errors[1] < errors[0] / 10
    assert steps[1] < 100 ** (1 / order) * steps[0]


def test_no_step_is_longer_than_asked_or_ends_beyond_the_stretch() -> None:
    solver = Cvode(
        "BDF", lambda t, y: 0 * y, 0.0, np.ones(1), 1.0, rtol=1e-6, atol=1e-6, max_step=0.03
    )
    lengths = []
    while solver.status == "running":
        solver.step()
        lengths.append(solver.t - solver.t_old)
    assert max(lengths) <= 0.03 * (1 + 1e-12)
    assert sum(lengths) == pytest.approx(1.0)


def test_failures_name_the_time() -> None:
    """v' = v^2 from 1 reaches infinity at t = 1."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="-v**2")]
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>r")), {})
    with pytest.raises(bg.SimulationError, match=r"at t = (0\.999|1)"):
        run.run([0.0, 2.0], {"v": 1.0}, method="CVODE", rtol=1e-7)


def test_a_step_that_cvode_cannot_take_is_a_failure_with_its_message() -> None:
    solver = Cvode(
        "BDF", lambda t, y: y**2, 0.0, np.ones(1), 2.0, rtol=1e-8, atol=1e-8, max_step=1.0
    )
    messages = []
    while solver.status == "running":
        messages.append(solver.step())
    assert solver.status == "failed"
    assert solver.t == pytest.approx(1.0, abs=1e-4)
    assert "convergence" in str(messages[-1]).lower()


def test_the_missing_package_is_named(monkeypatch) -> None:
    for name in ("sksundae", "sksundae.cvode"):
        monkeypatch.setitem(sys.modules, name, None)
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1.0})
    with pytest.raises(bg.MissingExtraError, match=r"pip install bondgraph-toolkit\[sundae\]"):
        run.run([0.0, 1.0], {"v": 1.0}, {"P": 0.0}, method="CVODE")
